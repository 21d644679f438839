# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# Sourced (bash) by Allrun and Alltest: their options, and the way from a fresh machine to a built flotsam.
. "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

nProcs=2
dryRun=
resolution=quick

# prints the comment at the head of the script
usage() { awk 'NR > 2 { if (!/^#/) exit; sub(/^# ?/, ""); print }' "$0"; }

readOptions() {
    while [ $# -gt 0 ]; do
        case $1 in
            -n)
                nProcs=${2:-}
                [[ $nProcs =~ ^[1-9][0-9]*$ ]] || { echo "$0: -n needs the number of processes, found '$nProcs'" >&2; exit 1; }
                shift ;;
            -r)
                resolution=${2:-}
                [[ $resolution =~ ^(quick|standard|paper)$ ]] || { echo "$0: -r is quick, standard or paper, found '$resolution'" >&2; exit 1; }
                shift ;;
            --dry-run) dryRun=yes ;;
            -h | --help) usage; exit 0 ;;
            *) echo "$0: unknown option '$1'" >&2; usage >&2; exit 1 ;;
        esac
        shift
    done
}

# run COMMAND...: says it, and does it unless this is a dry run
run() {
    if [ -n "$dryRun" ]; then
        echo "would run: $*"
    else
        echo "--- $*"
        "$@"
    fi
}

setUp() {
    "$flotsamRoot/scripts/installDependencies.sh" ${dryRun:+--dry-run} || return
    . "$flotsamRoot/scripts/environment.sh"     # OpenFOAM and python may be new
    local options=()
    if [ ! -f "$flotsamBuild/CMakeCache.txt" ]; then
        options+=(-G Ninja)
        if command -v ccache > /dev/null; then
            options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
        fi
    fi
    run cmake -S "$flotsamRoot" -B "$flotsamBuild" "${options[@]}" || return
    run cmake --build "$flotsamBuild" --parallel "$nProcs"
}
