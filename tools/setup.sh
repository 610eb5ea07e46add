#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Make .venv and see that Blender's module runs in it. Called by every make target, so it is quick when nothing is to do.
set -euo pipefail
cd "$(dirname "$0")/.."

venv=.venv
stamp=$venv/installed.txt
requirements=(requirements.txt requirements-wheels.txt)

# What bpy links to and does not bring, and OpenGL on the processor for machines without a GPU (Debian's names).
libraries=(libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri libice6 libsm6 libuuid1 libx11-6 libxext6 libxfixes3 libxi6
           libxkbcommon0 libxrender1)

say() { echo "setup: $*" >&2; }
die() { say "$@"; exit 1; }

may_install() { [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; }

apt_install() {
    say "installing $*"
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

# True where $1 is a Python 3.13 that can make environments. A name on PATH proves nothing: pyenv puts shims there.
usable() { "$1" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info[:2] != (3, 13))' 2>/dev/null; }

find_python() {
    local candidate
    for candidate in ${PYTHON:-} python3.13 python3 "${PYENV_ROOT:-$HOME/.pyenv}"/versions/3.13*/bin/python3.13 \
                     /usr/local/bin/python3.13; do
        if usable "$candidate"; then command -v "$candidate"; return; fi
    done
    return 1
}

make_venv() {
    local python
    if ! python=$(find_python); then
        if may_install && apt-get update -qq && apt-cache show python3.13-venv >/dev/null 2>&1; then
            apt_install python3.13-venv
        fi
        python=$(find_python) || die "no Python 3.13 found, which Blender 5.2's module needs. Install it with its venv" \
            "module (Debian 13: apt install python3.13-venv; elsewhere: pyenv install 3.13) or name it: make PYTHON=/path/to/python3.13"
    fi
    say "making $venv with $python"
    "$python" -m venv --clear "$venv"
}

install_requirements() {
    say "installing the packages in ${requirements[*]} (bpy is about 400 MB)"
    # Separate calls: with one hash in a run pip demands hashes for all, and for dependencies too.
    "$venv/bin/python" -m pip install -q --disable-pip-version-check -r requirements.txt
    "$venv/bin/python" -m pip install -q --disable-pip-version-check --no-deps -r requirements-wheels.txt
}

missing_libraries() {
    [ "$(uname -s)" = Linux ] || return 0
    ldd "$venv"/lib/python3.13/site-packages/bpy/__init__.so | awk '/not found/ { print $1 }'
    # Loaded by name at run time, so ldd does not see them: EGL, and a driver behind it.
    local known; known=$(PATH=$PATH:/sbin:/usr/sbin ldconfig -p)
    grep -q 'libEGL\.so\.1' <<<"$known" || echo libEGL.so.1
    grep -qE 'libEGL_[a-z]+\.so\.0' <<<"$known" || echo libEGL_mesa.so.0
}

check_libraries() {
    local missing
    missing=$(missing_libraries)
    [ -n "$missing" ] || return 0
    if may_install; then
        apt_install "${libraries[@]}"
        missing=$(missing_libraries)
    fi
    [ -z "$missing" ] || die "Blender's module needs system libraries that are not here:" $missing \
        "- on Debian or Ubuntu: apt install ${libraries[*]}"
}

check_gpu() {
    "$venv/bin/python" -c 'import bpy, gpu; gpu.init(); print("setup: renders on", gpu.platform.renderer_get())' >&2 ||
        die "Blender's module found no OpenGL to render with. A machine without a GPU needs Mesa: apt install ${libraries[*]}"
}

usable "$venv/bin/python" || make_venv
[ -e "$stamp" ] && cat "${requirements[@]}" | cmp -s - "$stamp" && fresh=1 || fresh=
[ -n "$fresh" ] || install_requirements
check_libraries
if [ -z "$fresh" ]; then
    check_gpu
    cat "${requirements[@]}" > "$stamp"
fi
