#!/usr/bin/env bash
# Measures runs in which GAMMA drives a part of the traffic and SUMO the rest, and prints their table.
#   tools/measure_parts.sh OUT MAP...      OUT: folder for scenarios and runs; MAP: .osm or .osm.pbf files
# Goes on where it was stopped: imports and runs that OUT has are kept. Another program needs another OUT.
# Environment: PROGRAM (build/release/sumo-gamma), AGENTS (100), SEEDS ("101 102 103 104 105"), DURATION (300 s),
# PARTS ("none all cars light wheels half region circle"), JOBS (1): runs at once.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib/measuring.sh"
if (($# < 2)); then
  usage_of "$0"
  exit 2
fi
out=$1
agents=${AGENTS:-100}
shift
begin_measuring "$out"
# the middle half of the network, either way
middle() {
  sed -n 's/.*convBoundary="\([^"]*\)".*/\1/p' "$1/net.net.xml" | head -1 |
    awk -F, '{w = ($3 - $1) / 4; h = ($4 - $2) / 4; printf "%.1f,%.1f,%.1f,%.1f", $1 + w, $2 + h, $3 - w, $4 - h}'
}
for map in "$@"; do
  name=$(basename "$map")
  name=${name%%.*}
  scenario=$out/maps/$name
  import_once "$map" "$scenario" "$agents"
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
      in_parallel run_once "$out/$name-$seed-$part" "$scenario" --agents "$agents" --duration "${DURATION:-300}" \
        --seed "$seed" --threads 1 "${who[@]}"
    done
  done
done
wait
"$project/tools/compare_parts.py" "$out"
