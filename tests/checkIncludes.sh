#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# checkIncludes.sh [ROOT]
# The structural rules of the sources, the first two checked on their #include lines:
#   1. extensions: .C and .H may include OpenFOAM, .cpp and .hpp may not (nor any .H, which would let it in);
#      LIGGGHTS, PETSc and HDF5 are each included in one folder.
#   2. arrows: a folder includes only the folders that its row below names; fluidSolver never includes demCoupling.
#   3. tolerances: doctest::Approx in tests/support/near.hpp alone; its epsilon is absolute for values below 1.
# Prints file:line of every breach; fails when there is one.
set -u
cd "${1:-$(dirname "$0")/..}" || exit 2

# folder, then the folders of this project it may include besides itself; * = all
arrows='
fluidSolver             *
fluidSolver/core
fluidSolver/algebra     fluidSolver/core
fluidSolver/geometry    fluidSolver/core fluidSolver/algebra
fluidSolver/equations   fluidSolver/core fluidSolver/algebra fluidSolver/geometry
fluidSolver/io          fluidSolver/core fluidSolver/geometry
fluidSolver/foam        fluidSolver/core fluidSolver/algebra fluidSolver/geometry fluidSolver/equations fluidSolver/io
demCoupling/core        fluidSolver/core fluidSolver/geometry
demCoupling/liggghts    demCoupling/core fluidSolver/core fluidSolver/geometry
demCoupling/coupling    demCoupling/core demCoupling/liggghts fluidSolver/core fluidSolver/algebra fluidSolver/geometry fluidSolver/equations fluidSolver/io
demCoupling/foam        demCoupling/core demCoupling/coupling demCoupling/liggghts fluidSolver/core fluidSolver/algebra fluidSolver/geometry fluidSolver/io fluidSolver/foam
tests                   *
benchmarks              *
'

# package, the one folder that includes it (tests and benchmarks may as well), its headers
packages='
PETSc       fluidSolver/algebra     ^petsc.*\.h$
HDF5        fluidSolver/io          ^(hdf5|H5).*\.h$
MPI         !fluidSolver/core       ^mpi\.h$
LIGGGHTS    demCoupling/liggghts    \.h$
'
# headers of the C++ and C libraries and of header-only tools that everything may include
free='^([a-z_0-9]+|Eigen/.*|doctest/.*|(fcntl|fenv|signal|unistd)\.h|sys/.*\.h)$'

breaches=0
breach() {
    echo "$1"
    breaches=$((breaches + 1))
}

# Functions below answer in `answer`, without a process of their own: there are thousands of lines.
declare -A allowedOf rowOfFolder
while read -r folder allowed; do
    if [ -n "$folder" ]; then allowedOf[$folder]=$allowed; fi
done <<< "$arrows"

# the row of `arrows` a file belongs to: its folder or the nearest one above
rowOf() {
    local own=${1%/*} folder
    if [ -z "${rowOfFolder[$own]-}" ]; then
        folder=$own
        while [ "$folder" != . ] && [ -z "${allowedOf[$folder]+has}" ]; do
            case $folder in */*) folder=${folder%/*} ;; *) folder=. ;; esac
        done
        rowOfFolder[$own]=$folder
    fi
    answer=${rowOfFolder[$own]}
}

# path of an included file of this project, empty for others
ownFile() {
    local folder
    answer=
    for folder in "${1%/*}/" '' fluidSolver/ tests/; do
        if [ -f "$folder$2" ]; then
            answer=$folder$2
            case $answer in ../* | */../* | */./*) answer=$(realpath --relative-to=. "$answer") ;; esac
            return
        fi
    done
}

checkOwn() {    # file line row included
    rowOf "$4"
    local target=$answer
    case $1:$4 in
        *.[ch]pp:*.H) breach "$1:$2: $4 is an OpenFOAM-side header; .cpp and .hpp may not include .H" ;;
    esac
    [ "$target" = "$3" ] && return
    if [ "$3" = . ]; then
        breach "$1:$2: this folder has no row in the table of arrows"
        return
    fi
    local allowed=${allowedOf[$3]}
    case " $allowed " in
        *' * '* | *" $target "*) ;;
        *) breach "$1:$2: $3 may not include $target ($4); allowed: ${allowed:-nothing else of this project}" ;;
    esac
}

checkForeign() {    # file line row included
    if [[ $4 =~ $free ]]; then return; fi
    case $1:$4 in
        *.[CH]:*.[CH]) return ;;
        *:*.[CH]) breach "$1:$2: $4 is OpenFOAM's; only .C and .H files may include it"; return ;;
    esac
    local package folder pattern
    while read -r package folder pattern; do
        if [[ -n $package && $4 =~ $pattern ]]; then
            case $3:$folder in
                tests:* | benchmarks:* | "$folder:$folder") ;;
                *:!*) if [ "!$3" = "$folder" ]; then breach "$1:$2: $package ($4) is not used in $3"; fi ;;
                *) breach "$1:$2: $package ($4) is included in $folder alone" ;;
            esac
            return
        fi
    done <<< "$packages"
    breach "$1:$2: $4 is neither a file of this project nor in the table of packages"
}

files=$(find fluidSolver demCoupling tests benchmarks -name '*.[CH]' -o -name '*.[ch]pp' 2> /dev/null)
includes=0
while IFS=: read -r file line text; do
    [ -n "$file" ] || continue
    includes=$((includes + 1))
    [[ $text =~ [\<\"]([^\>\"]*)[\>\"] ]] || continue
    included=${BASH_REMATCH[1]}
    rowOf "$file"
    row=$answer
    ownFile "$file" "$included"
    own=$answer
    if [ -n "$own" ]; then
        checkOwn "$file" "$line" "$row" "$own"
    else
        checkForeign "$file" "$line" "$row" "$included"
    fi
done < <(grep -nE '^[[:space:]]*#[[:space:]]*include' $files /dev/null)

while IFS=: read -r file line text; do
    case $file in
        '' | tests/support/near.hpp) ;;
        *) breach "$file:$line: doctest's Approx; use near or within of support/near.hpp" ;;
    esac
done < <(grep -nw 'Approx' $(grep '^tests/' <<< "$files") /dev/null)

echo "checkIncludes: $includes includes in $(wc -w <<< "$files") files, $breaches breaches"
[ "$breaches" -eq 0 ]
