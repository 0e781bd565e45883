#!/usr/bin/env bash
# Makes the Debian packages and checks them with lintian, where that is installed.
#   tools/package.sh [FOLDER]     FOLDER: where they go; out/packages where none is given
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

if (($# > 1)) || [[ ${1-} == -* ]]; then
  sed -n '2,3s/^# \{0,1\}//p' "$0"
  [[ ${1-} == -h || ${1-} == --help ]]
  exit
fi
folder=$(realpath -m "${1:-$project/out/packages}")
cd "$project"

headline "packages to build with"
tools/setup.sh

headline "build"
build package
rm -rf "$folder"
mkdir -p "$folder"

headline "pack"
logged build/package/cpack.log cpack --config build/package/CPackConfig.cmake -B "$folder"
rm -rf "$folder/_CPack_Packages"
ls -l "$folder"

if command -v lintian > /dev/null; then
  headline "lintian"
  # tags that are errors; what it warns of is shown
  lintian --fail-on error --allow-root "$folder"/*.deb
else
  echo "lintian is not installed: packages are made, but not checked"
fi
