# Sourced by the scripts of tools/ that measure runs: scenarios and runs that are kept, several runs at once.
# Sets $program (environment: PROGRAM, build/release/sumo-gamma) and $jobs (JOBS, 1).
# shellcheck shell=bash

source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
program=${PROGRAM:-$project/build/release/sumo-gamma}
jobs=${JOBS:-1}

# usage_of SCRIPT: the comment at its head
usage_of() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$1" >&2; }

# begin_measuring OUT: the folder, for runs of this program alone
begin_measuring() {
  local mark=$1/program.sha256 sum
  sum=$(sha256sum < "$program")
  mkdir -p "$1/maps"
  if [[ -f $mark && $(< "$mark") != "$sum" ]]; then
    echo "$1 holds runs of another program: name another folder" >&2
    return 2
  fi
  echo "$sum" > "$mark"
}

# import_once MAP SCENARIO AGENTS: unless it is there
import_once() {
  [[ -f $2/scenario.toml ]] && return
  echo "import of $1" >&2
  "$program" import "$1" -o "$2" --agents "$3" --quiet > "$2.txt"
}

# run_once OUT/NAME SCENARIO OPTION...: unless it is there and whole. Says why where it fails, and goes on
run_once() {
  local run=$1 scenario=$2
  shift 2
  grep -q '"ended": "done"' "$run/results.json" 2> /dev/null && return
  echo "${run##*/}" >&2
  "$program" run "$scenario" -o "$run" --force --step 0.05 --quiet --log error "$@" > "$run.txt" 2>&1 < /dev/null ||
    echo "${run##*/}: $(tail -1 "$run.txt")" >&2
}

# in_parallel COMMAND...: as soon as fewer than $jobs are under way; `wait` waits for the last ones
in_parallel() {
  while (($(jobs -rp | wc -l) >= jobs)); do wait -n || true; done
  "$@" &
}
