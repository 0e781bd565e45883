#!/usr/bin/env bash
# The traffic bench: a hundred agents for ten minutes on twelve maps with twenty seeds, and how two programs differ there.
#   tools/traffic_bench.sh OUT             runs what OUT lacks and prints its sums with 95 % intervals
#   tools/traffic_bench.sh OUT BEFORE      then compares OUT with BEFORE, which another program has filled: exit code 1 where it
#                                          drives worse. An OUT without scenarios gets BEFORE's: both drive the same networks
# Goes on where it was stopped, seed after seed. The seeds aren't looked at one by one: who tunes to them has no bench any more.
# Environment: PROGRAM (build/release/sumo-gamma), JOBS (all cores): runs at once, SEEDS ("101 ... 120"), DURATION (600 s),
# AGENTS (100), MAPS: other .osm or .osm.pbf files (those of ../shared).
set -euo pipefail
export JOBS=${JOBS:-$(nproc)}
source "$(dirname "${BASH_SOURCE[0]}")/lib/measuring.sh"
if (($# < 1 || $# > 2)); then
  usage_of "$0"
  exit 2
fi
out=$1
agents=${AGENTS:-100}
read -ra maps <<< "${MAPS:-}"
if ((${#maps[@]} == 0)); then
  for name in beijing magic meskel_square shi_men_er_lu highway fujisawa; do maps+=("$project/../shared/data/maps/$name.osm"); done
  # of either side of the road and of four continents
  for name in bogota chiangmai dublin hcmc porto volgograd; do maps+=("$project/../shared/data/world/$name.osm.pbf"); done
fi
begin_measuring "$out"
if [[ -n ${2-} && -z $(ls "$out/maps") ]]; then cp -r "$2/maps/." "$out/maps"; fi
for map in "${maps[@]}"; do
  name=$(basename "$map")
  in_parallel import_once "$map" "$out/maps/${name%%.*}" "$agents"
done
wait
for seed in ${SEEDS:-$(seq 101 120)}; do
  for map in "${maps[@]}"; do
    name=$(basename "$map")
    name=${name%%.*}
    in_parallel run_once "$out/$name-$seed" "$out/maps/$name" --agents "$agents" --duration "${DURATION:-600}" --seed "$seed" --threads 1
  done
done
wait
"$project/tools/compare_builds.py" "$@"
