#!/usr/bin/env bash
# Measures sumo-gamma beside plain SUMO on real maps and prints the table of docs/measurements.md.
#   tools/measure.sh OUT MAP...      OUT: folder for scenarios and runs; MAP: .osm or .osm.pbf files
# Goes on where it was stopped: imports and runs that OUT has are kept. Another program needs another OUT.
# Environment: PROGRAM (build/release/sumo-gamma), AGENTS ("100 300"), SEEDS ("1 2 3 4 5"), DURATION (600 s), THREADS (1),
# OPTIONS: further ones of `run` ("--preset unregulated"), TABLE (--spread: means and deviations), JOBS (1): runs at once.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib/measuring.sh"
if (($# < 2)); then
  usage_of "$0"
  exit 2
fi
out=$1
shift
begin_measuring "$out"
read -ra options <<< "${OPTIONS:-}"
for map in "$@"; do
  name=$(basename "$map")
  name=${name%%.*}
  for agents in ${AGENTS:-100 300}; do
    scenario=$out/maps/$name-$agents
    import_once "$map" "$scenario" "$agents"
    for seed in ${SEEDS:-1 2 3 4 5}; do
      for control in all none; do
        in_parallel run_once "$out/$name-$agents-$seed-$control" "$scenario" --agents "$agents" --duration "${DURATION:-600}" \
          --seed "$seed" --threads "${THREADS:-1}" --control "$control" "${options[@]}"
      done
    done
  done
done
wait
"$project/tools/compare_runs.py" "$out" ${TABLE:+"$TABLE"}
