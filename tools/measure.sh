#!/usr/bin/env bash
# Measures sumo-gamma beside plain SUMO on real maps and prints the tables of docs/measurements.md.
#   tools/measure.sh OUT MAP...      OUT: folder for scenarios and runs; MAP: .osm or .osm.pbf files
# Environment: PROGRAM (build/release/sumo-gamma), AGENTS (100), DURATION (300 s), THREADS (2).
set -euo pipefail
if (($# < 2)); then
  sed -n '2,4s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
project=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=${PROGRAM:-$project/build/release/sumo-gamma}
out=$1
shift
mkdir -p "$out"
gamma=()
plain=()
for map in "$@"; do
  name=$(basename "$map")
  name=${name%%.*}
  "$program" import "$map" -o "$out/$name" --agents "${AGENTS:-100}" --force --quiet > "$out/$name.import.txt"
  for control in all none; do
    "$program" run "$out/$name" -o "$out/$name-$control" --agents "${AGENTS:-100}" --duration "${DURATION:-300}" \
      --step 0.05 --seed 1 --threads "${THREADS:-2}" --control "$control" --quiet > "$out/$name-$control.txt" 2>&1 ||
      echo "$name --control $control: $(tail -1 "$out/$name-$control.txt")" >&2
  done
  gamma+=("$out/$name-all")
  plain+=("$out/$name-none")
done
echo "### GAMMA drives everybody"
echo
"$program" report "${gamma[@]}"
echo
echo "### Plain SUMO (\`--control none\`)"
echo
"$program" report "${plain[@]}"
