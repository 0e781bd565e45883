#!/usr/bin/env bash
# Drives the planners of docs/planning.md on the paper's three sites (its Fig. 8) and prints the tables.
#   tools/planner_drives.sh OUT MAPS      MAPS: folder with meskel_square.osm, magic.osm and highway.osm (and shi_men_er_lu.osm)
# Goes on where it was stopped: scenarios and episodes that OUT has are kept. Another program needs another OUT.
# Environment: PROGRAM (build/release/sumo-gamma), SEEDS (200: from 1 on), PLANNERS, SITES, ARM (unregulated: a name for what OPTIONS
# ask; its folder in OUT), OPTIONS ("--preset unregulated"), AGENTS: alive in a drive, instead of each site's own number; JOBS (1): drives
# at once.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib/measuring.sh"
if (($# != 2)); then
  usage_of "$0"
  exit 2
fi
out=$1
maps=$2
begin_measuring "$out"
arm=${ARM:-unregulated}
read -ra options <<< "${OPTIONS:---preset unregulated}"
read -ra planners <<< "${PLANNERS:-gamma pomdp-gamma rollout-gamma pomdp-simple policy oracle}"
read -ra sites <<< "${SITES:-meskel_square magic highway}"

# About 110 agents in each window of 200 x 200 m, as many as in the paper's; squares alone are cut out of their maps for that.
declare -A window=([meskel_square]="-99,-98,99,98" [magic]="-100,-100,100,100" [highway]="-110,-75,90,125" [shi_men_er_lu]="-100,-100,100,100")
declare -A agents=([meskel_square]=180 [magic]=140 [highway]=210 [shi_men_er_lu]=180)
declare -A cut=([meskel_square]="38.761894,9.009283,38.764426,9.011765" [shi_men_er_lu]="121.454080,31.236576,121.456980,31.239066")

# drive_once SITE PLANNER LAST: the episodes up to a seed that aren't there yet
drive_once() {
  local folder=$out/$arm/$1/$2 reference=()
  [[ $2 == gamma ]] || reference=(--reference "$out/$arm/$1/gamma")
  mkdir -p "${folder%/*}"
  "$program" drive "$out/maps/$1" -o "$folder" --seeds "1..$3" --planner "$2" "--window=${window[$1]}" --agents "${AGENTS:-${agents[$1]}}" \
    --threads 1 --quiet "${reference[@]}" "${options[@]}" >> "$folder.txt" 2>&1 < /dev/null ||
    echo "$arm $1 $2: $(tail -1 "$folder.txt")" >&2
}

for site in "${sites[@]}"; do
  [[ -f $out/maps/$site/scenario.toml ]] ||
    "$program" import "$maps/$site.osm" -o "$out/maps/$site" --agents "${agents[$site]}" ${cut[$site]:+--bbox "${cut[$site]}"} --quiet \
      > "$out/maps/$site.txt"
done
last=${SEEDS:-200}
for ((upto = last < 25 ? last : 25; ; upto = 2 * upto < last ? 2 * upto : last)); do
  for planner in "${planners[@]}"; do
    for site in "${sites[@]}"; do
      in_parallel drive_once "$site" "$planner" "$upto"
    done
    [[ $planner != gamma ]] || wait  # the others' scores are held against its ways
  done
  wait
  echo "$arm: $upto seeds done" >&2
  ((upto < last)) || break
done
"$project/tools/compare_planners.py" "$out/$arm"
