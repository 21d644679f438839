#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# get-openfoam-headers.sh [FOLDER]
# Debian and Ubuntu package OpenFOAM's libraries without development headers. This makes FOLDER/src/<library>/lnInclude
# from the distribution's own source package of exactly the installed version. apt checks its signature and SHA256; no apt
# setting of the system is touched, and root is not needed. The last line printed is FOLDER.
#
# FOLDER                default $OPENFOAM_HEADERS_DIR, then ${XDG_CACHE_HOME:-~/.cache}/flotsam/openfoam-<version>
# OPENFOAM_ORIG_DIR     folder of an earlier `apt-get source --download-only openfoam`: nothing is downloaded
# OPENFOAM_DEB_MIRROR   another mirror than the one the package came from
set -euo pipefail

fail() { echo "get-openfoam-headers.sh: $*" >&2; exit 1; }

# folders below src/ that are needed, with what their headers include
libraries=(OpenFOAM OSspecific/POSIX fileFormats surfMesh meshTools finiteVolume lagrangian/basic mesh/extrudeModel
    dynamicMesh sampling functionObjects/field functionObjects/forces)

version=$(dpkg-query -W -f '${source:Version}' libopenfoam 2>/dev/null) || fail "libopenfoam is not installed (scripts/installDependencies.sh)"
package=$(dpkg-query -W -f '${source:Package}' libopenfoam)
folder=${1:-${OPENFOAM_HEADERS_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/flotsam/openfoam-$version}}
stamp="$package $version: ${libraries[*]}"

if [ "$(cat "$folder/.stamp" 2>/dev/null)" = "$stamp" ]; then
    echo "headers of $package $version are up to date"
    echo "$folder"
    exit 0
fi

mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
work=$(mktemp -d "$folder/.work.XXXXXX")
trap 'rm -rf "$work"' EXIT

# prints URI, suite and component that the installed package came from
origin() {
    apt-cache policy libopenfoam |
        awk '/\*\*\*/ {installed = 1; next} installed && $2 ~ /^(https?|file|cdrom):/ {split($3, a, "/"); print $2, a[1], a[2]; exit}'
}

download() {
    local uri suite component key='' k
    read -r uri suite component < <(origin) || true
    uri=${OPENFOAM_DEB_MIRROR:-${uri:-http://deb.debian.org/debian}}
    suite=${suite:-$(. /etc/os-release && echo "$VERSION_CODENAME")}
    for k in /usr/share/keyrings/{ubuntu,debian}-archive-keyring.gpg; do
        if [ -f "$k" ]; then key="[signed-by=$k]"; fi
    done
    mkdir -p "$work/lists/partial" "$work/cache/archives/partial" "$1"
    echo "deb-src $key $uri $suite ${component:-main}" > "$work/sources.list"
    local apt=(apt-get -qq -o Dir::Etc::SourceList="$work/sources.list" -o Dir::Etc::SourceParts=- -o Dir::State::Lists="$work/lists"
        -o Dir::Cache="$work/cache" -o APT::Sandbox::User="$(id -un)" -o Acquire::Languages=none -o Acquire::Retries=3)
    "${apt[@]}" update
    (cd "$1" && "${apt[@]}" source --download-only --only-source "$package=$version")
}

source=${OPENFOAM_ORIG_DIR:-}
if [ -z "$source" ]; then
    source=$work/download
    download "$source"
fi

# checked by apt already; once more, for a folder that somebody else filled
description=$source/${package}_${version#*:}.dsc
[ -f "$description" ] || fail "no $description"
awk '/^Checksums-Sha256:/ {list = 1; next} /^[^ ]/ {list = 0} list {print $1 "  " $3}' "$description" > "$work/sums"
(cd "$source" && sha256sum --quiet -c "$work/sums") || fail "wrong checksum in $source"

# .C files belong to it: OpenFOAM's headers include the bodies of their templates
mkdir "$work/tree"
patterns=(META-INFO/api-info)
for library in "${libraries[@]}"; do
    patterns+=("src/$library/*.[CHh]" "src/$library/*.[ch]xx")
done
tar -xf "$(find "$source" -name "${package}_*.orig.tar.*" ! -name '*.asc' -print -quit)" -C "$work/tree" --strip-components=1 \
    --wildcards --no-anchored "${patterns[@]}" 2> "$work/tar.log" ||
    grep -q 'Not found in archive' "$work/tar.log" || fail "$(cat "$work/tar.log")"

api=$(sed -n 's/^api=//p' "$work/tree/META-INFO/api-info")
[ "$api" = "${version%%.*}" ] || fail "the source is v$api, the installed package is $version"

for library in "${libraries[@]}"; do
    from=$work/tree/src/$library
    [ -d "$from" ] || continue      # not in every version
    mkdir -p "$work/src/$library/lnInclude"
    # excluded folders as in wmakeLnInclude
    find "$from" \( -name lnInclude -o -name Make -o -name config -o -name noLink \) -prune -o -type f -print0 |
        xargs -0 -r cp -n -t "$work/src/$library/lnInclude"
done

rm -rf "$folder/src" "$folder/META-INFO"
mv "$work/src" "$work/tree/META-INFO" "$folder"
echo "$stamp" > "$folder/.stamp"
echo "headers of $package $version: $(find "$folder/src" -type f | wc -l) files"
echo "$folder"
