# Sourced by the scripts of tools/: where the project is, how many jobs, headlines, a command with its log.
# shellcheck shell=bash

project=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
jobs=${JOBS:-$(nproc)}

# a compiler cache is used where there is one, and never asked for
if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER-} ]] && command -v ccache > /dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
  # else it leaves out what is compiled with precompiled headers
  export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros,include_file_mtime,include_file_ctime}
fi

headline() { printf '\n== %s (%d:%02d) ==\n' "$*" $((SECONDS / 60)) $((SECONDS % 60)); }

# logged LOG COMMAND...: runs it quietly; where it fails, the end of its log is shown
logged() {
  local log=$1
  shift
  mkdir -p "$(dirname "$log")"
  if ! "$@" > "$log" 2>&1 < /dev/null; then
    grep -E 'error|Error|FAILED|undefined reference' "$log" | head -n 20 >&2 || true
    echo "-- the end of $log:" >&2
    tail -n 30 "$log" >&2
    return 1
  fi
}

# build PRESET [TARGET...] [-- NINJA_OPTION...]: configures the preset and builds it (everything, or the targets)
build() {
  local preset=$1
  shift
  local targets=()
  while (($# > 0)) && [[ $1 != -- ]]; do
    targets+=(--target "$1")
    shift
  done
  logged "$project/build/$preset/configure.log" cmake --preset "$preset" -S "$project" || return 1
  echo "compiling with $jobs jobs: a few minutes the first time (log: build/$preset/build.log)"
  logged "$project/build/$preset/build.log" \
    cmake --build "$project/build/$preset" -j "$jobs" "${targets[@]}" "$@"
}
