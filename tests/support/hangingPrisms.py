#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""hangingPrisms.py FOLDER: a polyMesh of upright prisms, right triangles of a square grid in two layers. Every fourth one is divided into four: its neighbours have hanging
points, which leave no corner that sees all of their faces, and are symmetric: several of their faces are equally near to a point inside."""
import os
import sys

N, LAYERS = 4, 2
points, number = [], {}


def point(i, j, k):
    if (i, j, k) not in number:
        number[i, j, k] = len(points)
        points.append((i / (2 * N), j / (2 * N), 0.4 * k / LAYERS))
    return number[i, j, k]


def middle(p, q):
    return (p[0] + q[0]) // 2, (p[1] + q[1]) // 2


def sides(ring):
    return list(zip(ring, ring[1:] + ring[:1]))


triangles = []
for i in range(0, 2 * N, 2):
    for j in range(0, 2 * N, 2):
        a, b, c, d = (i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2)
        triangles += [[a, b, c], [a, c, d]] if (i + j) % 4 else [[a, b, d], [b, c, d]]
divided = triangles[1::4]
hanging = {frozenset(side) for t in divided for side in sides(t)}
polygons = []
for t in triangles:
    if t in divided:
        m = [middle(*side) for side in sides(t)]
        polygons += [[t[0], m[0], m[2]], [m[0], t[1], m[1]], [m[2], m[1], t[2]], m]
    else:
        polygons.append([x for side in sides(t) for x in ([side[0], middle(*side)] if frozenset(side) in hanging else [side[0]])])

faces, nCells = {}, 0       # points of a face -> (cell, points, outwards) of its one or two cells
for k in range(LAYERS):
    for ring in polygons:
        low, high = ([point(*x, k + top) for x in ring] for top in (0, 1))
        quads = [[low[a], low[a - len(low) + 1], high[a - len(low) + 1], high[a]] for a in range(len(low))]
        for face in [low[::-1], high, *quads]:
            faces.setdefault(frozenset(face), []).append((nCells, face))
        nCells += 1
inner = sorted([(*[cell for cell, _ in both], both[0][1]) for both in faces.values() if len(both) == 2])
outer = [(one[0][0], -1, one[0][1]) for one in faces.values() if len(one) == 1]

folder = os.path.join(sys.argv[1], "constant", "polyMesh")
os.makedirs(folder, exist_ok=True)


def write(name, kind, entries):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(f"FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n{len(entries)}\n(\n" + "\n".join(entries) + "\n)\n")


write("points", "vectorField", [f"({x:.12g} {y:.12g} {z:.12g})" for x, y, z in points])
write("faces", "faceList", [f"{len(face)}({' '.join(map(str, face))})" for _, _, face in inner + outer])
write("owner", "labelList", [str(owner) for owner, _, _ in inner + outer])
write("neighbour", "labelList", [str(neighbour) for _, neighbour, _ in inner])
write("boundary", "polyBoundaryMesh", [f"sides {{ type patch; nFaces {len(outer)}; startFace {len(inner)}; }}"])
