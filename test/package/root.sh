# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
# Sourced by in_*_root: a fresh Debian in $work/root, made by debootstrap: of the release $release, by default 12. $work keeps base.tar
# and downloaded packages for the next run.
release=${release:-bookworm}
mirror=${VISCERA_DEBIAN_MIRROR:-http://deb.debian.org/debian}

fail() { echo "FAILED: $*" >&2; exit 1; }
step() { printf '\n== %s\n' "$*"; }

# Runs a command in the root; mounts end with it. $1: "" or --net, which leaves it without a network
in_root() {
  # shellcheck disable=SC2016,SC2086
  unshare --mount --pid --fork $1 bash -c '
    ip link set lo up 2>/dev/null || true
    mount --bind /dev "$0/dev" && mount -t proc proc "$0/proc" && mount -t tmpfs tmpfs "$0/dev/shm" || exit 1
    mkdir -p "$0/var/cache/apt/archives" && mount --bind "$1" "$0/var/cache/apt/archives" || exit 1
    shift; exec chroot "$0" "$@"' "$top" "$work/archives" "${@:2}"
}
as_root() { in_root "" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive sh -ec "$1"; }
as_user() { in_root --net su - trainee -c "$1"; }  # as a login from a terminal has it, without a network

# Makes the root. Exit 77 where that cannot be.
fresh_root() {
  [ "$(id -u)" = 0 ] || { echo "not root, which debootstrap needs: skipped"; exit 77; }
  "$root/scripts/install_packages" root || { echo "debootstrap cannot be installed: skipped"; exit 77; }
  mkdir -p "$work/archives"
  work=$(cd "$work" && pwd) top=$work/root
  step "a fresh Debian ($release)"
  rm -rf "$top"
  mkdir -p "$top"
  if [ ! -s "$work/base.tar" ]; then
    debootstrap --variant=minbase "$release" "$top" "$mirror" >"$work/debootstrap.log" 2>&1 ||
      { tail -3 "$work/debootstrap.log"; echo "Debian's archive is not in reach: skipped"; exit 77; }
    tar -C "$top" -cf "$work/base.tar.new" . && mv "$work/base.tar.new" "$work/base.tar"
  else
    tar -C "$top" -xf "$work/base.tar"
  fi
  cp -L /etc/resolv.conf "$top/etc/resolv.conf"
  echo "127.0.0.1 localhost $(hostname)" >"$top/etc/hosts"
  echo 'APT::Keep-Downloaded-Packages "true";' >"$top/etc/apt/apt.conf.d/99keep"
}
