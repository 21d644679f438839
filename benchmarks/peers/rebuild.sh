#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# rebuild.sh [FOLDER]
# Builds interFoam, interIsoFoam and overInterDyMFoam of the installed OpenFOAM from the distribution's own source package into
# FOLDER (default ${XDG_CACHE_HOME:-~/.cache}/flotsam/peers-<version>), with -O2 and without loop vectorisation. The last line
# printed is FOLDER. Needed because the binaries of Debian 12 are wrong on non-orthogonal meshes: see benchmarks/README.md.
#
# OPENFOAM_ORIG_DIR     folder of an earlier `apt-get source --download-only openfoam`: nothing is downloaded
set -euo pipefail

fail() { echo "rebuild.sh: $*" >&2; exit 1; }

version=$(dpkg-query -W -f '${source:Version}' libopenfoam 2> /dev/null) || fail "libopenfoam is not installed (scripts/installDependencies.sh)"
package=$(dpkg-query -W -f '${source:Package}' libopenfoam)
folder=${1:-${XDG_CACHE_HOME:-$HOME/.cache}/flotsam/peers-$version}
solvers=(interFoam interIsoFoam interFoam/overInterDyMFoam)     # folders

# libraries whose headers the solvers include
libraries=(OpenFOAM OSspecific/POSIX fileFormats surfMesh meshTools finiteVolume sampling dynamicMesh dynamicFvMesh overset
    transportModels/incompressible transportModels/interfaceProperties transportModels/twoPhaseMixture
    transportModels/immiscibleIncompressibleTwoPhaseMixture transportModels/twoPhaseProperties
    TurbulenceModels/turbulenceModels TurbulenceModels/incompressible)

isComplete() {
    local solver
    [ "$(cat "$folder/.stamp" 2> /dev/null)" = "$package $version" ] || return
    for solver in "${solvers[@]}"; do [ -x "$folder/${solver##*/}" ] || return; done
}

if isComplete; then
    echo "$folder"
    exit 0
fi

mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
work=$(mktemp -d "$folder/.work.XXXXXX")
trap 'rm -rf "$work"' EXIT

# a private apt state: no setting of the system is touched, apt checks signatures as always
download() {
    local apt=(apt-get -qq -o Dir::Etc::SourceList="$work/sources.list" -o Dir::Etc::SourceParts=- -o Dir::State::Lists="$work/lists"
        -o Dir::Cache="$work/cache" -o APT::Sandbox::User="$(id -un)" -o Acquire::Languages=none -o Acquire::Retries=3)
    mkdir -p "$work/lists/partial" "$work/cache/archives/partial" "$1"
    apt-cache policy libopenfoam |
        awk '/\*\*\*/ {installed = 1; next} installed && $2 ~ /^https?:/ {split($3, a, "/"); print "deb-src", $2, a[1], a[2]; exit}' > "$work/sources.list"
    [ -s "$work/sources.list" ] || fail "apt does not know where libopenfoam $version came from (apt-get update)"
    "${apt[@]}" update
    (cd "$1" && "${apt[@]}" source --download-only --only-source "$package=$version")
}

source=${OPENFOAM_ORIG_DIR:-}
if [ -z "$source" ]; then
    source=$work/download
    download "$source"
fi
archive=$(find "$source" -name "${package}_*.orig.tar.*" ! -name '*.asc' -print -quit)
[ -n "$archive" ] || fail "no ${package}_*.orig.tar.* in $source"
mkdir "$work/tree"
tar -xf "$archive" -C "$work/tree" --strip-components=1 --wildcards --no-anchored META-INFO/api-info 'src/*' \
    'applications/solvers/multiphase/*' 'applications/solvers/incompressible/pimpleFoam/*'
api=$(sed -n 's/^api=//p' "$work/tree/META-INFO/api-info")

include=()
for library in "${libraries[@]}"; do
    from=$work/tree/src/$library
    [ -d "$from" ] || fail "no src/$library in the source of $version"
    mkdir -p "$work/include/$library"
    # .C files belong to it: OpenFOAM's headers include the bodies of their templates
    find "$from" \( -name lnInclude -o -name Make -o -name noLink \) -prune -o -type f -name '*.[CHh]*' -print0 | xargs -0 -r cp -n -t "$work/include/$library"
    include+=("-I$work/include/$library")
done

applications=$work/tree/applications/solvers
multiphase=$applications/multiphase
for solver in "${solvers[@]}"; do
    name=${solver##*/}
    own=()
    if [ "$name" = overInterDyMFoam ]; then
        own=(-I"$multiphase/interFoam" -I"$applications/incompressible/pimpleFoam/overPimpleDyMFoam" -ldynamicMesh -ltopoChangerFvMesh -loverset)
    fi
    g++ -std=c++14 -O2 -fno-tree-loop-vectorize -w -ftemplate-depth=256 -fPIC -DOPENFOAM="$api" -DWM_DP -DWM_LABEL_SIZE=32 -DNoRepository \
        -I"$multiphase/$solver" -I"$multiphase/VoF" "${include[@]}" -I"$work/tree/src/transportModels" "$multiphase/$solver/$name.C" \
        -o "$folder/$name" -Wl,--no-as-needed "${own[@]}" -lfiniteVolume -lfvOptions -lmeshTools -lsampling -ldynamicFvMesh \
        -lincompressibleTransportModels -linterfaceProperties -limmiscibleIncompressibleTwoPhaseMixture -ltwoPhaseMixture \
        -lturbulenceModels -lincompressibleTurbulenceModels -lwaveModels -lOpenFOAM -lPstream
    echo "built $folder/$name"
done
echo "$package $version" > "$folder/.stamp"
echo "$folder"
