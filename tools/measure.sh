#!/usr/bin/env bash
# Measures sumo-gamma beside plain SUMO on real maps and prints the table of docs/measurements.md.
#   tools/measure.sh OUT MAP...      OUT: folder for scenarios and runs; MAP: .osm or .osm.pbf files
# Goes on where it was stopped: imports and runs that OUT has are kept. Another program needs another OUT.
# Environment: PROGRAM (build/release/sumo-gamma), AGENTS ("100 300"), SEEDS ("1 2 3 4 5"), DURATION (600 s), THREADS (1).
set -euo pipefail
if (($# < 2)); then
  sed -n '2,5s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=${PROGRAM:-$project/build/release/sumo-gamma}
out=$1
shift
mkdir -p "$out/maps"
for map in "$@"; do
  name=$(basename "$map")
  name=${name%%.*}
  for agents in ${AGENTS:-100 300}; do
    scenario=$out/maps/$name-$agents
    [[ -f $scenario/scenario.toml ]] || "$program" import "$map" -o "$scenario" --agents "$agents" --quiet > "$scenario.txt"
    for seed in ${SEEDS:-1 2 3 4 5}; do
      for control in all none; do
        run=$name-$agents-$seed-$control
        grep -q '"ended": "done"' "$out/$run/results.json" 2> /dev/null && continue
        echo "$run" >&2
        "$program" run "$scenario" -o "$out/$run" --force --agents "$agents" --duration "${DURATION:-600}" --step 0.05 \
          --seed "$seed" --threads "${THREADS:-1}" --control "$control" --quiet --log error > "$out/$run.txt" 2>&1 ||
          echo "$run: $(tail -1 "$out/$run.txt")" >&2
      done
    done
  done
done
"$project/tools/compare_runs.py" "$out"
