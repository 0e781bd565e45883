#!/usr/bin/env bash
# The main job, from a map to a table and a film: installs, builds, imports a real OpenStreetMap extract and drives
# about 100 mixed agents in it for two minutes at 20 Hz.
#   tools/demo.sh [MAP]     MAP: an .osm, .osm.gz, .osm.bz2 or .osm.pbf file; Monaco where none is given
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

if (($# > 1)) || [[ ${1-} == -* ]]; then
  sed -n '2,4s/^# \{0,1\}//p' "$0"
  [[ ${1-} == -h || ${1-} == --help ]]
  exit
fi
map=$(realpath "${1:-$project/osm_maps/monaco.osm.pbf}")
cd "$project"
out=out/demo
program=build/release/sumo-gamma

headline "packages"
tools/setup.sh

headline "build"
build release sumo-gamma

headline "import $map"
rm -rf "$out"
mkdir -p "$out"
"$program" import "$map" -o "$out/scenario" --agents 100

headline "run: 100 agents, 120 s at 20 Hz"
"$program" run "$out/scenario" --agents 100 --duration 120 --step 0.05 --seed 1 --threads 2 \
  -o "$out/run" --replay

headline "done"
echo "results:  $project/$out/run/results.json"
echo "replay:   $project/$out/run/replay.html (open it in a browser)"
