# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Sourced (bash) by every script: where things are, and what OpenFOAM and Open MPI need to run.
flotsamRoot=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
flotsamBuild=${FLOTSAM_BUILD:-$flotsamRoot/build}
[ -d "$flotsamBuild" ] || [ ! -x "$flotsamRoot/../../bin/flotsamFoam" ] || flotsamBuild=$(cd "$flotsamRoot/../.." && pwd)    # installed
export PATH="$flotsamBuild/bin:$flotsamRoot/scripts:$PATH"

# Debian's OpenFOAM programs find their etc/ folder by this alone
if [ -z "${WM_PROJECT_DIR:-}" ] && [ -f /usr/share/openfoam/etc/controlDict ]; then
    export WM_PROJECT_DIR=/usr/share/openfoam
fi

# Open MPI: as root (containers), more ranks than cores, and no busy waiting where cores are shared
if [ "$(id -u)" = 0 ]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1
export OMPI_MCA_btl_vader_single_copy_mechanism=none    # containers forbid it, with a message for every rank
export OMPI_MCA_odls_base_sigkill_timeout=${OMPI_MCA_odls_base_sigkill_timeout:-3}   # after Ctrl-C: time to end a step and to write it
export OMP_NUM_THREADS=1

# The python that has the packages: another one may stand first in PATH. Looked for each time this is sourced (they may have
# been installed meanwhile); a FLOTSAM_PYTHON of the user's comes first.
flotsamPythonPackages="numpy, h5py, matplotlib, vtkmodules.vtkCommonCore"
flotsamPythonIsComplete=no
for python in ${FLOTSAM_PYTHON:+"$FLOTSAM_PYTHON"} python3 /usr/bin/python3; do
    if "$python" -c "import $flotsamPythonPackages" > /dev/null 2>&1; then
        FLOTSAM_PYTHON=$python
        flotsamPythonIsComplete=yes
        break
    fi
done
export FLOTSAM_PYTHON="${FLOTSAM_PYTHON:-python3}"
