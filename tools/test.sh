#!/usr/bin/env bash
# Builds and tests sumo-gamma; installs what that takes.
#   tools/test.sh          every test and every lint, the golden bits with clang, some seconds of each fuzz target, clang-tidy on what changed
#   tools/test.sh quick    build, unit and property tests
#   tools/test.sh deep     the same under the sanitizers, more of it with clang, a minute of each fuzz target
#   tools/test.sh tidy     clang-tidy on every source (slow)
# The last line adds it all up; the exit code is 0 only where nothing failed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

mode=${1:-full}
case "$mode" in
  full | quick | deep | tidy) ;;
  -h | --help)
    sed -n '2,8s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
  *)
    sed -n '2,8s/^# \{0,1\}//p' "$0" >&2
    exit 2
    ;;
esac
cd "$project"

stages=()
lost=()

# test_stage PRESET LABELS [TARGET...]: builds the preset (or the targets in it) and runs the tests of the labels
test_stage() {
  local preset=$1 labels=$2
  shift 2
  headline "$preset: build"
  rm -f "build/$preset/tests.xml"
  if ! build "$preset" "$@"; then
    lost+=(--failed "$preset")
    return
  fi
  headline "$preset: tests"
  # one more than cores: tests that run SUMO wait for it, and it for them
  "${runner[@]}" ctest --test-dir "build/$preset" -L "$labels" -j $((jobs + 1)) --output-on-failure \
    --no-tests=error --output-junit "$project/build/$preset/tests.xml" < /dev/null |
    sed -uE '/^ +Start +[0-9]+: /d; s/ \.{3,}/ .../' || true
  if [[ -s build/$preset/tests.xml ]]; then
    stages+=("build/$preset/tests.xml")
  else
    lost+=(--failed "$preset")
  fi
}

# tidy_stage changed|all: clang-tidy on the sources that changed, or on all
tidy_stage() {
  headline "clang-tidy"
  rm -f build/tidy/tests.xml
  if logged build/tidy/configure.log cmake --preset tidy; then
    JOBS=$jobs python3 -B tools/lib/tidy.py build/tidy "$1" || true
  fi
  if [[ -s build/tidy/tests.xml ]]; then
    stages+=(build/tidy/tests.xml)
  else
    lost+=(--failed tidy)
  fi
}

headline "packages"
tools/setup.sh --test

# reports end the test; libsumo leaks a little at its exit, through libraries of its own
export ASAN_OPTIONS="detect_stack_use_after_return=1:strict_string_checks=1:${ASAN_OPTIONS-}"
export LSAN_OPTIONS="suppressions=$project/tests/support/leaks.supp:print_suppressions=0:${LSAN_OPTIONS-}"
export UBSAN_OPTIONS="print_stacktrace=1:halt_on_error=1:${UBSAN_OPTIONS-}"
export TSAN_OPTIONS="suppressions=$project/tests/support/races.supp:halt_on_error=1:second_deadlock_stack=1:${TSAN_OPTIONS-}"
runner=()

case "$mode" in
  quick) test_stage dev '^(unit|property)$' ;;
  full)
    test_stage dev '.'
    # the other compiler must give the same bits; fuzz targets are clang's alone
    test_stage clang '^(golden|fuzz)$' tests_golden tests_fuzz
    tidy_stage changed
    ;;
  deep)
    test_stage dev '.'
    test_stage asan '^(unit|property|golden)$' tests_unit tests_property tests_golden
    test_stage clang '^(unit|property|golden)$' tests_unit tests_property tests_golden golden_roads
    test_stage fuzz '^fuzz$' tests_fuzz
    # g++ 12's thread sanitizer cannot place its memory where the kernel randomises addresses a lot
    setarch "$(uname -m)" -R true 2> /dev/null && runner=(setarch "$(uname -m)" -R)
    test_stage tsan '^(unit|property)$' tests_unit tests_property
    tidy_stage changed
    ;;
  tidy) tidy_stage all ;;
esac

headline "summary"
python3 tools/lib/summarise_tests.py "${lost[@]}" "${stages[@]}"
