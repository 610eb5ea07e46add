#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Run a command beside a full Blender with a window: one from Debian's unstable suite, in a folder of its own that is made
# once (a few minutes, 1.4 GB) and kept in $AFTERLIGHT_DESKTOP, by default /var/cache/afterlight-desktop.
#
#     tools/desktop.sh COMMAND...     the command finds the folder in $AFTERLIGHT_DESKTOP, fit for chroot
#     tools/desktop.sh                only say whether that can be had here: exit code 1 and the reason where it can't
#
# Everything is mounted in a namespace of its own: no mount outlives this script, and nothing else sees them.
set -euo pipefail
cd "$(dirname "$0")/.."

root=$(realpath -m "${AFTERLIGHT_DESKTOP:-/var/cache/afterlight-desktop}" 2>/dev/null || true)
stamp=$root/afterlight-complete   # written last, so an interrupted folder is made again
packages=(blender xvfb xdotool imagemagick libegl1 libgl1-mesa-dri mesa-vulkan-drivers
          python3-numpy python3-requests python3-cattr python3-zstandard)

say() { echo "desktop: $*" >&2; }

# Why there can be no desktop here, in words; nothing where there can.
obstacle() {
    if [ "$(uname -s)" != Linux ]; then echo "it needs Linux"
    elif [ "$(id -u)" != 0 ]; then echo "it needs root, to make and enter a Debian of its own"
    elif ! command -v debootstrap >/dev/null && ! command -v apt-get >/dev/null; then echo "it needs debootstrap"
    elif ! unshare --mount --pid --fork true 2>/dev/null; then echo "root may not mount folders in this container"
    fi
}

install_debootstrap() {
    say "installing debootstrap"
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends debootstrap >/dev/null
}

make_root() {
    local mirror=
    say "making $root: Debian unstable with Blender, 1.4 GB, a few minutes"
    command -v debootstrap >/dev/null || install_debootstrap
    rm -rf --one-file-system "$root"
    mkdir -p "$root"
    if command -v apt-get >/dev/null; then  # the mirror this machine uses, where it is a Debian
        mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' | sed -n 1p)
    fi
    debootstrap --variant=minbase sid "$root" $mirror >"$root.log" 2>&1 || { tail -n 20 "$root.log" >&2; return 1; }
    if command -v apt-config >/dev/null; then  # and its proxy
        apt-config dump Acquire >"$root/etc/apt/apt.conf.d/80machine"
    fi
    printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"  # no package may start a service
    chmod +x "$root/usr/sbin/policy-rc.d"
    mount_in_root
    inside apt-get update -qq
    inside apt-get install -y -qq --no-install-recommends "${packages[@]}" >>"$root.log" 2>&1 ||
        { tail -n 20 "$root.log" >&2; return 1; }
    inside apt-get clean
    echo "${packages[*]}" >"$stamp"
}

inside() { DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 chroot "$root" "$@"; }

mount_in_root() {
    mountpoint -q "$root/proc" && return
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    mount -t tmpfs tmpfs "$root/tmp"
    mkdir -p "$root$PWD"
    mount --bind "$PWD" "$root$PWD"  # at its own path, so that both sides mean the same by a name
}

reason=$(obstacle)
if [ -n "$reason" ]; then
    say "the desktop test is left out: $reason"
    [ $# = 0 ] && exit 1 || exit 0
fi
[ $# -gt 0 ] || exit 0

if [ -z "${AFTERLIGHT_NAMESPACE:-}" ]; then
    AFTERLIGHT_NAMESPACE=1 exec unshare --mount --pid --fork --kill-child --mount-proc "tools/${0##*/}" "$@"
fi

mkdir -p "$(dirname "$root")"
exec 9>"$root.lock"
flock 9  # another run may be making it
[ "$(cat "$stamp" 2>/dev/null)" = "${packages[*]}" ] || make_root
exec 9>&-
mount_in_root
AFTERLIGHT_DESKTOP=$root exec "$@"
