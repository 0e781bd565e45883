#!/usr/bin/env bash
# Measures runs in which GAMMA drives a part of the traffic and SUMO the rest, and prints their table.
#   tools/measure_parts.sh OUT MAP...      OUT: folder for scenarios and runs; MAP: .osm or .osm.pbf files
# Goes on where it was stopped: imports and runs that OUT has are kept. Another program needs another OUT.
# Environment: PROGRAM (build/release/sumo-gamma), AGENTS (100), SEEDS ("101 102 103 104 105"), DURATION (300 s),
# PARTS ("none all cars light wheels half region circle").
set -euo pipefail
if (($# < 2)); then
  sed -n '2,6s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=${PROGRAM:-$project/build/release/sumo-gamma}
out=$1
agents=${AGENTS:-100}
shift
mkdir -p "$out/maps"
# the middle half of the network, either way
middle() {
  sed -n 's/.*convBoundary="\([^"]*\)".*/\1/p' "$1/net.net.xml" | head -1 |
    awk -F, '{w = ($3 - $1) / 4; h = ($4 - $2) / 4; printf "%.1f,%.1f,%.1f,%.1f", $1 + w, $2 + h, $3 - w, $4 - h}'
}
for map in "$@"; do
  name=$(basename "$map")
  name=${name%%.*}
  scenario=$out/maps/$name
  [[ -f $scenario/scenario.toml ]] || "$program" import "$map" -o "$scenario" --agents "$agents" --quiet > "$scenario.txt"
  for seed in ${SEEDS:-101 102 103 104 105}; do
    for part in ${PARTS:-none all cars light wheels half region circle}; do
      case $part in
        none | all) who=(--control "$part") ;;
        cars) who=(--control car) ;;
        light) who=(--control "bicycle,pedestrian,motorcycle") ;;
        wheels) who=(--control "car,van,bus,truck,motorcycle,bicycle") ;;
        half) who=(--control "50%") ;;
        region) who=("--region=$(middle "$scenario")") ;;
        circle) who=(--take 'around = "bus.1", radius = 60') ;;
        *)
          echo "PARTS: no part is called $part" >&2
          exit 2
          ;;
      esac
      run=$name-$seed-$part
      grep -q '"ended": "done"' "$out/$run/results.json" 2> /dev/null && continue
      echo "$run" >&2
      "$program" run "$scenario" -o "$out/$run" --force --agents "$agents" --duration "${DURATION:-300}" --step 0.05 \
        --seed "$seed" --threads 1 "${who[@]}" --quiet --log error > "$out/$run.txt" 2>&1 ||
        echo "$run: $(tail -1 "$out/$run.txt")" >&2
    done
  done
done
"$project/tools/compare_parts.py" "$out"
