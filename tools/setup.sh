#!/usr/bin/env bash
# Installs what sumo-gamma needs, as Debian packages by name. Running it again costs a moment.
#   tools/setup.sh               what it takes to build and run the program
#   tools/setup.sh --run-tests   that, and what its tests take
#   tools/setup.sh --test        that, and the linters and the second compiler of tools/test.sh
set -euo pipefail
# a plain user's PATH has no sbin on Debian, and dpkg insists on it
export PATH="$PATH:/usr/local/sbin:/usr/sbin:/sbin"

# compiler and build
build_packages=(g++ cmake ninja-build pkg-config)
# SUMO with its headers and libraries (package sumo), netconvert's type maps and SUMO's own tools (sumo-tools)
build_packages+=(sumo sumo-tools)
# OpenStreetMap reading (libosmium, protozero, their zlib, bzip2, expat and lz4), projection
build_packages+=(libosmium2-dev libprotozero-dev zlib1g-dev libbz2-dev libexpat1-dev liblz4-dev libproj-dev
  libpolyclipping-dev)
# linear algebra, command line, configuration, logging, XML
build_packages+=(libeigen3-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libspdlog-dev libfmt-dev
  libpugixml-dev)
# studies: their results as a database, Student's t, compressed tables
build_packages+=(libsqlite3-dev libboost-dev libzstd-dev)
# the page of a run that goes on
build_packages+=(libcpp-httplib-dev)

# the Python module
build_packages+=(pybind11-dev python3-dev python3-numpy)

# test and benchmark libraries, XML schemas
test_packages=(libgtest-dev libgmock-dev libbenchmark-dev git python3 libxml2-utils)
# the replay page is checked by node and opened in a browser that needs a font, SUMO's window in a screen
# that nobody sees; memory checks
test_packages+=(nodejs chromium fonts-dejavu-core ffmpeg xvfb valgrind)
# the second compiler with its linters and sanitizers, script checks
second_packages=(clang-14 clang-tidy-14 clang-format-14 libclang-rt-14-dev llvm-14 shellcheck)

usage() { sed -n '2,5s/^# \{0,1\}//p' "$0"; }
fail() {
  echo "setup: $*" >&2
  exit 1
}

packages=("${build_packages[@]}")
case "${1-}" in
  "") ;;
  --run-tests) packages+=("${test_packages[@]}") ;;
  --test) packages+=("${test_packages[@]}" "${second_packages[@]}") ;;
  -h | --help)
    usage
    exit 0
    ;;
  *)
    usage >&2
    exit 2
    ;;
esac

if ! command -v apt-get > /dev/null || ! command -v dpkg-query > /dev/null; then
  fail "no apt-get here: this script knows Debian 12 and its relatives; install by hand: ${packages[*]}"
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2> /dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  echo "setup: all ${#packages[@]} packages are there"
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  command -v sudo > /dev/null || fail "root or sudo is needed to install: ${missing[*]}"
  as_root=(sudo)
fi

# apt-get, quietly: its messages are shown only where it fails
log=$(mktemp)
trap 'rm -f "$log"' EXIT
apt_get() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300 \
    -o Dpkg::Use-Pty=0 -o Acquire::Retries=3 "$@" > "$log" 2>&1 < /dev/null || {
    tail -n 40 "$log" >&2
    fail "apt-get $1 failed (see above); wanted: ${missing[*]}"
  }
}
echo "setup: installing ${#missing[@]} packages: ${missing[*]}"
apt_get update
apt_get install --no-install-recommends "${missing[@]}"
echo "setup: done"
