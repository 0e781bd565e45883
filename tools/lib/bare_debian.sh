# Sourced by tools/try_*.sh, behind common.sh: bare Debians in folders, and commands in them.
# shellcheck shell=bash

# require_debootstrap SCRIPT: ends the script where none can be made
require_debootstrap() {
  if ((EUID != 0)) || ! command -v debootstrap > /dev/null; then
    echo "$1: needs root and debootstrap" >&2
    exit 2
  fi
}

# bare_debian RELEASE FOLDER MIRROR: makes one where it isn't there yet; from then on `inside` is in it
bare_debian() {
  local release=$1 mirror=$3
  root=$2
  if [[ ! -e $root/.bare ]]; then
    headline "a bare Debian: $release"
    rm -rf --one-file-system "$root"
    mkdir -p "$root"
    logged "$root.log" debootstrap --variant=minbase "$release" "$root" "$mirror"
    # a mirror may be one of some weeks ago
    echo 'Acquire::Check-Valid-Until "false";' > "$root/etc/apt/apt.conf.d/90old-mirror"
    touch "$root/.bare"
  fi
  # it has none, and SUMO's Python client looks for localhost
  [[ -s $root/etc/hosts ]] || echo "127.0.0.1 localhost" > "$root/etc/hosts"
  mount_inside proc -t proc proc
}

# mount_inside PLACE MOUNT_ARGUMENT...: until the script ends, or unmount_all
mounted=()
mount_inside() {
  local place=$root/$1
  shift
  mkdir -p "$place"
  mountpoint -q "$place" || mount "$@" "$place"
  mounted+=("$place")
}
unmount_all() {
  local place
  for place in "${mounted[@]}"; do umount "$place"; done
  mounted=()
}
trap unmount_all EXIT

inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
