#!/usr/bin/env bash
# Builds sumo-gamma and runs its integration tests beside several SUMOs: each as a release of Debian has it, in a bare
# one of its own. Goes on where it was stopped; a release is done again once its table is removed.
#   tools/try_versions.sh FOLDER [RELEASE...]    FOLDER: for the chroots, some 6 GB each; RELEASE: bookworm trixie sid
# Needs root, debootstrap and git. MIRROR=URL asks another mirror, LABELS=REGEX for other tests.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"
source "$(dirname "${BASH_SOURCE[0]}")/lib/bare_debian.sh"

if (($# < 1)) || [[ $1 == -* ]]; then
  sed -n '2,5s/^# \{0,1\}//p' "$0"
  [[ ${1-} == -h || ${1-} == --help ]]
  exit
fi
folder=$(realpath -m "$1")
shift
releases=("$@")
((${#releases[@]} > 0)) || releases=(bookworm trixie sid)
mirror=${MIRROR:-http://deb.debian.org/debian}
labels=${LABELS:-^integration$}
require_debootstrap try_versions
mkdir -p "$folder"

# try_release RELEASE: a table of one line in FOLDER/RELEASE.txt
try_release() {
  local release=$1 table=$folder/$1.txt shared=$project/../shared
  if [[ -s $table ]]; then
    return
  fi
  bare_debian "$release" "$folder/$release" "$mirror"
  mount_inside dev --bind /dev
  if [[ -d $shared ]]; then
    mount_inside srv/shared --bind -o ro "$shared"
  fi
  mkdir -p "$root/srv/main"
  git -C "$project" archive HEAD | tar -x -C "$root/srv/main"

  headline "$release: packages"
  logged "$root.setup.log" inside /srv/main/tools/setup.sh --run-tests
  headline "$release: build"
  logged "$root.configure.log" inside sh -c 'cd /srv/main && cmake --preset dev -DSUMOGAMMA_WARNINGS_AS_ERRORS=OFF'
  logged "$root.build.log" inside ninja -C /srv/main/build/dev -j "$jobs" -k 0
  headline "$release: tests"
  inside ctest --test-dir /srv/main/build/dev -L "$labels" -j $((jobs + 1)) --output-on-failure \
    --output-junit /srv/tests.xml < /dev/null > "$root.tests.log" 2>&1 || true
  {
    printf '| %s | %s | %s | ' "$release" "$(inside sumo --version | sed -n '1s/.*Version //p')" \
      "$(inside g++ -dumpfullversion)"
    python3 - "$root/srv/tests.xml" << 'END'
import sys, xml.etree.ElementTree as tree
suite = tree.parse(sys.argv[1]).getroot()
print(" | ".join(suite.get(key) for key in ("tests", "failures", "skipped")), "|")
END
  } > "$table.part"
  mv "$table.part" "$table"
  unmount_all
}

for release in "${releases[@]}"; do
  try_release "$release"
done

headline "SUMO's versions"
echo "| Debian | SUMO | g++ | tests | failed | skipped |"
echo "|---|---|---|---:|---:|---:|"
for release in "${releases[@]}"; do cat "$folder/$release.txt"; done
