# SPDX-License-Identifier: GPL-3.0-or-later
"""Local refinement with OpenFOAM's topoSet and refineMesh: cells with their centres in boxes are halved, one box after the other."""

_FILE = "system/refinement{}/{}"
_HEADER = "// SPDX-License-Identifier: GPL-3.0-or-later\nFoamFile {{ version 2.0; format ascii; class dictionary; object {}; }}\n"


def dictionaries(boxes, directions="tan1 tan2"):
    """{path: text} of their dictionaries. boxes: ((x, y, z), (x, y, z)) [m] each; directions: tan1, tan2, normal are x, y, z."""
    files = {}
    for level, corners in enumerate(boxes):
        box = " ".join("(" + " ".join(f"{c:.9g}" for c in corner) + ")" for corner in corners)
        files[_FILE.format(level, "topoSetDict")] = _HEADER.format("topoSetDict") + (
            f"actions ({{ name fine; type cellSet; action new; source boxToCell; sourceInfo {{ box {box}; }} }});\n")
        files[_FILE.format(level, "refineMeshDict")] = _HEADER.format("refineMeshDict") + f"""set fine;
coordinateSystem global;
globalCoeffs {{ tan1 (1 0 0); tan2 (0 1 0); }}
directions ({directions});
useHexTopology no;
geometricCut no;
writeMesh no;
"""
    return files


def refine(levels, do):
    """After blockMesh; do: as prepare() gets it."""
    for level in range(levels):
        do("topoSet", "-dict", _FILE.format(level, "topoSetDict"))
        do("refineMesh", "-dict", _FILE.format(level, "refineMeshDict"), "-overwrite")
