#!/usr/bin/env bash
# Gradescope runs this once, when it builds the image of the assignment: Python 3.11 or newer, lietool from
# the wheel beside this file, and Mesa's software renderer. At the end all exercises are tried.
set -euo pipefail

root=${AUTOGRADER_ROOT:-/autograder}
venv=$root/venv
export DEBIAN_FRONTEND=noninteractive PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_INPUT=1

find_python() { # sets python
    for python in python3.13 python3.12 python3.11 python3; do
        if "$python" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            return 0
        fi
    done
    return 1
}

get() { # PACKAGE...
    command -v apt-get >/dev/null && { [ -n "${updated-}" ] || apt-get update; } && updated=yes &&
        apt-get install -y --no-install-recommends "$@"
}

renders() {
    "$venv/bin/python" -P -c \
        'from lietool.render import context; raise SystemExit(not context.get().canonical)' >/dev/null 2>&1
}

find_python || get python3 python3-venv || true
# That of Ubuntu 22.04 is too old; a newer one lies beside it.
find_python || get python3.12 python3.12-venv || get python3.11 python3.11-venv || true
find_python || {
    echo "setup.sh: there is no Python 3.11 or newer here. Choose a base image with Ubuntu 24.04" >&2
    exit 1
}

"$python" -m venv "$venv"
cd "$root/source"
"$venv/bin/python" -m pip install --quiet -r requirements.txt
renders || get libegl1 libgl1-mesa-dri || true

if [ -d "$root/source/project" ]; then export LIETOOL_PROJECT=$root/source/project; fi
# What does not get full marks here would be unjust to everybody: better no image.
"$venv/bin/python" -P -m lietool.exercise.gradescope "$root" --try
