#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# installDependencies.sh [--dry-run]
# Installs the Debian/Ubuntu packages that flotsam needs and this machine lacks, and says which. As root, or with sudo.
# OpenFOAM is left alone when the environment of another one is sourced ($WM_PROJECT_DIR with its headers).
set -euo pipefail

build=(g++ make cmake ninja-build pkg-config bzip2 ca-certificates
    petsc-dev libopenmpi-dev openmpi-bin libhdf5-openmpi-dev libeigen3-dev libliggghts-dev doctest-dev)
openfoam=(openfoam libopenfoam)
# validation, plots, pictures (xvfb: Debian's VTK draws on an X server only)
python=(python3-numpy python3-h5py python3-matplotlib python3-vtk9 xvfb libgl1-mesa-dri)

dryRun=
case ${1:-} in
    '') ;;
    -n | --dry-run) dryRun=yes ;;
    *) sed -n '3,5s/^# //p' "$0"; exit 1 ;;
esac

wanted=("${build[@]}" "${python[@]}")
if [ -f "${FOAM_SRC:-${WM_PROJECT_DIR:-/none}/src}/OpenFOAM/lnInclude/argList.H" ]; then
    echo "OpenFOAM: the sourced one, $WM_PROJECT_DIR"
else
    wanted+=("${openfoam[@]}")
fi

if ! command -v apt-get > /dev/null; then
    echo "No apt-get here, nothing is installed. Needed (Debian's names): ${wanted[*]}"
    exit 0
fi

missing=()
for package in "${wanted[@]}"; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null) || status=
    if [ "$status" != installed ]; then
        missing+=("$package")
    fi
done
if [ ${#missing[@]} -eq 0 ]; then
    echo "Packages: all ${#wanted[@]} needed are installed"
    exit 0
fi

if [ -n "$dryRun" ]; then
    echo "Packages that would be installed: ${missing[*]}"
    exit 0
fi

asRoot=(env DEBIAN_FRONTEND=noninteractive)
if [ "$(id -u)" != 0 ]; then
    command -v sudo > /dev/null || {
        echo "Missing packages, and neither root nor sudo to install them. Ask for: apt-get install ${missing[*]}" >&2
        exit 1
    }
    asRoot=(sudo "${asRoot[@]}")
fi

# every missing package has a candidate, or the lists have to be fetched first
if ! apt-get install --simulate --quiet=2 --no-install-recommends "${missing[@]}" > /dev/null 2>&1; then
    echo "Packages: fetching the lists (apt-get update)"
    "${asRoot[@]}" apt-get update --quiet=2
fi
echo "Packages: installing ${missing[*]}"
log=$(mktemp)
if ! "${asRoot[@]}" apt-get install --yes --quiet=2 --no-install-recommends "${missing[@]}" > "$log" 2>&1; then
    # the lists may be older than the archive
    "${asRoot[@]}" apt-get update --quiet=2
    "${asRoot[@]}" apt-get install --yes --quiet=2 --no-install-recommends "${missing[@]}" > "$log" 2>&1 || {
        tail -n 20 "$log" >&2
        echo "installing failed; all of apt's output is in $log" >&2
        exit 1
    }
fi
rm -f "$log"
