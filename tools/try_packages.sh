#!/usr/bin/env bash
# Installs the packages of tools/package.sh in a bare Debian 12 of their own and uses them there as README.md does.
# Needs root and debootstrap; what is downloaded stays in the folder for the next time.
#   tools/try_packages.sh PACKAGES FOLDER [MIRROR]     PACKAGES: folder with .debs; FOLDER: for the chroot, some 2 GB
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$(dirname "${BASH_SOURCE[0]}")/lib/bare_debian.sh"

if (($# < 2 || $# > 3)) || [[ $1 == -* ]]; then
  sed -n '2,4s/^# \{0,1\}//p' "$0"
  [[ ${1-} == -h || ${1-} == --help ]]
  exit
fi
packages=$(realpath "$1")
folder=$(realpath -m "$2")
mirror=${3:-http://deb.debian.org/debian}
compgen -G "$packages/*.deb" > /dev/null || {
  echo "try_packages: $packages: no .deb there, make them with tools/package.sh" >&2
  exit 2
}
require_debootstrap try_packages
bare_debian bookworm "$folder" "$mirror"

headline "install"
mkdir -p "$root/srv/packages" "$root/srv/maps" "$root/srv/example"
cp "$packages"/*.deb "$root/srv/packages/"
cp "$project"/osm_maps/monaco.osm.pbf "$root/srv/maps/"
cp "$project"/examples/own_loop/* "$project"/examples/python/* "$root/srv/example/"
inside apt-get -q update > /dev/null
inside sh -c 'apt-get -q -y --no-install-recommends install /srv/packages/*.deb > /srv/install.log 2>&1 || { tail -n 20 /srv/install.log; exit 1; }'
inside dpkg-query -W 'sumo-gamma' 'libsumo-gamma-dev' 'python3-sumo-gamma'

headline "README's commands"
inside sh -ec '
  cd /srv
  rm -rf city report.html
  sumo-gamma version
  sumo-gamma import maps/monaco.osm.pbf -o city --agents 100 --quiet
  sumo-gamma run city -o city/run --agents 100 --duration 20 --replay --quiet
  sumo-gamma run city -o city/plain --control none --duration 20 --quiet
  sumo-gamma report city/run city/plain -o city/report.html --quiet
  sumo-gamma run city -o city/libsumo --backend libsumo --duration 5 --quiet
  test -s city/run/replay.html
  test -s city/report.html
  test -s /usr/share/man/man1/sumo-gamma.1.gz
  test -s /usr/share/bash-completion/completions/sumo-gamma
'

headline "Python"
inside sh -ec 'cd /srv/example && python3 user_loop.py /srv/city/scenario.sumocfg'

headline "a project of one's own"
inside sh -ec '
  apt-get -q -y --no-install-recommends install g++ cmake make > /srv/compiler.log 2>&1
  cmake -S /srv/example -B /srv/example/build > /dev/null
  cmake --build /srv/example/build > /dev/null
  /srv/example/build/own_loop /srv/city --duration 10 --quiet
'
headline "done"
