# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of any cells as polyMesh files: written from a structured mesh's points (hexahedra, prisms, tetrahedra, holes), and read for what judge.py asks of a mesh."""
import itertools
import os
import re

import numpy as np

HEADER = "FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"
# Corners of a hexahedron are 1 a + 2 b + 4 c; normals point outwards
HEX = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
DIAGONALS = [((0, 1, 3), (0, 3, 2)), ((0, 1, 2), (1, 3, 2))]
TETRAHEDRA = [(0, 1 << a, 1 << a | 1 << b, 7) for a, b, _ in itertools.permutations(range(3))]
SIDES = ("x-", "x+", "y-", "y+", "z-", "z+")


# --- writing --------------------------------------------------------------------------------------------------------------

def write(folder, points, patches, kind="hex", holes=None, rng=None):
    """points: nz x ny x nx x 3. patches: {name: (type, "x- y+ ..")}; sides of holes (boolean, nz x ny x nx cells) belong to `blocks`."""
    index = np.arange(points[..., 0].size).reshape(points.shape[:3])
    cells = _cells(index, points.reshape(-1, 3), kind, np.zeros(np.array(index.shape) - 1, bool) if holes is None else holes, rng)
    names = {side: name for name, (_, sides) in patches.items() for side in sides.split()}
    inner, outer = _faces(cells, lambda face: names[side] if (side := _side(face, index.shape)) else "blocks")
    used = np.unique([p for cell in cells for face in cell for p in face])
    number = np.full(index.size, -1)
    number[used] = np.arange(len(used))
    mesh = os.path.join(folder, "constant", "polyMesh")
    rows = [face for *_, face in inner] + [face for name in patches for face, _ in outer.get(name, [])]
    _list(mesh, "points", "vectorField", [f"({x:.12g} {y:.12g} {z:.12g})" for x, y, z in points.reshape(-1, 3)[used]])
    _list(mesh, "faces", "faceList", [f"{len(face)}({' '.join(str(number[p]) for p in face)})" for face in rows])
    _list(mesh, "owner", "labelList", [owner for owner, *_ in inner] + [owner for name in patches for _, owner in outer.get(name, [])])
    _list(mesh, "neighbour", "labelList", [neighbour for _, neighbour, _ in inner])
    start, entries = len(inner), []
    for name, (type_, _) in patches.items():
        n = len(outer.get(name, []))
        entries.append(f"{name} {{ type {type_}; nFaces {n}; startFace {start}; }}")
        start += n
    _list(mesh, "boundary", "polyBoundaryMesh", entries)


def _list(folder, name, kind, rows):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as out:
        out.write(HEADER.format(kind=kind, name=name) + f"{len(rows)}\n(\n" + "\n".join(map(str, rows)) + "\n)\n")


def _cells(index, points, kind, holes, rng):
    """Faces of all cells. Diagonals of prisms are drawn, one for all cells of a column in z."""
    made = []
    turn = rng.randint(2, size=holes.shape[1:]) if kind == "prism" else None
    for k, j, i in np.argwhere(~holes):
        corner = [int(index[k + (c >> 2), j + (c >> 1 & 1), i + (c & 1)]) for c in range(8)]
        if kind == "hex":
            made.append([tuple(corner[c] for c in face) for face in HEX])
        elif kind == "prism":
            made += [_prism([corner[c] for c in t], [corner[c + 4] for c in t]) for t in DIAGONALS[turn[j, i]]]
        else:
            made += [_tetrahedron([corner[c] for c in t], points) for t in TETRAHEDRA]
    return made


def _prism(low, high):
    (a, b, c), (d, e, f) = low, high
    return [(a, c, b), (d, e, f), (a, b, e, d), (b, c, f, e), (c, a, d, f)]


def _tetrahedron(corners, points):
    a, b, c, d = corners
    x = points[corners]
    if np.dot(np.cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]) < 0:
        b, c = c, b
    return [(a, c, b), (a, b, d), (b, c, d), (a, d, c)]


def _side(face, n):
    where = np.array(np.unravel_index(face, n))[::-1]
    for d in range(3):
        for k, at in enumerate((0, n[2 - d] - 1)):
            if (where[d] == at).all():
                return SIDES[2 * d + k]
    return None


def _faces(cells, patchOf):
    """Inner faces (owner, neighbour, points) in OpenFOAM's order; {patch: [(points, owner)]}."""
    seen, inner, outer = {}, [], {}
    for c, cell in enumerate(cells):
        for face in cell:
            key = tuple(sorted(face))
            if key in seen:
                owner, points = seen.pop(key)
                inner.append((owner, c, points))
            else:
                seen[key] = (c, face)
    for owner, face in seen.values():
        outer.setdefault(patchOf(face), []).append((face, owner))
    return sorted(inner, key=lambda f: f[:2]), outer


# --- reading --------------------------------------------------------------------------------------------------------------

class AnyCells:
    """What judge.Cells is for structured meshes: n, centre, volume, faceHeights; read from a folder's polyMesh."""
    SHARES = (0.4, 0.85)        # of the way from a cell's centre to its corners: places of samples

    def __init__(self, folder):
        self.folder = os.path.join(folder, "constant", "polyMesh")
        points = np.array(self._text("points").replace("(", " ").replace(")", " ").split(), float).reshape(-1, 3)
        faces = [np.array(row.split(), int) for row in re.findall(r"\d+\s*\(([^)]*)\)", self._text("faces"))]
        owner, neighbour = (np.array(self._text(name).split(), int) for name in ("owner", "neighbour"))
        self.n = int(max(owner.max(), neighbour.max())) + 1
        self.faceCentre, area = self._areas(points, faces)
        self._measure(owner, neighbour, area)
        self.sampleCell, self.samplePlace = self._samples(points, faces, owner, neighbour)

    def _text(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as file:
            text = file.read()
        text = text[text.index("}") + 1:]
        return text[re.search(r"\n\d+\s*\n?\(", text).end():text.rindex(")")]

    @staticmethod
    def _areas(points, faces):
        centre, area = np.zeros((len(faces), 3)), np.zeros((len(faces), 3))
        sizes = np.array([len(f) for f in faces])
        for n in np.unique(sizes):
            these = np.flatnonzero(sizes == n)
            x = points[np.array([faces[f] for f in these])]
            middle = x.mean(axis=1, keepdims=True)
            parts = 0.5 * np.cross(x - middle, np.roll(x, -1, axis=1) - middle)
            area[these] = parts.sum(axis=1)
            weight = np.linalg.norm(parts, axis=2, keepdims=True)
            centre[these] = (weight * (x + np.roll(x, -1, axis=1) + middle) / 3).sum(axis=1) / weight.sum(axis=1)
        return centre, area

    def _measure(self, owner, neighbour, area):
        """By pyramids from a point within each cell."""
        m = len(neighbour)
        cell, face = np.r_[owner, neighbour], np.r_[np.arange(len(owner)), np.arange(m)]
        outward = np.r_[area, -area[:m]]
        count = np.bincount(cell, minlength=self.n)
        middle = np.stack([np.bincount(cell, self.faceCentre[face, d], self.n) for d in range(3)], axis=1) / count[:, None]
        pyramid = np.einsum("ij,ij->i", outward, self.faceCentre[face] - middle[cell]) / 3
        self.volume = np.bincount(cell, pyramid, self.n)
        self.centre = np.stack([np.bincount(cell, pyramid * (0.75 * self.faceCentre[face, d] + 0.25 * middle[cell, d]), self.n) for d in range(3)], axis=1) / self.volume[:, None]

    def _samples(self, points, faces, owner, neighbour):
        cell = np.concatenate([np.full(len(faces[f]), c) for side in (owner, neighbour) for f, c in enumerate(side)])
        corner = points[np.concatenate([faces[f] for side in (owner, neighbour) for f in range(len(side))])]
        place = np.concatenate([self.centre[cell] + share * (corner - self.centre[cell]) for share in self.SHARES])
        return np.tile(cell, len(self.SHARES)), place

    def mean(self, values):
        """Of the cells, from one value a sample."""
        return np.bincount(self.sampleCell, values, self.n) / np.bincount(self.sampleCell, minlength=self.n)

    def faceHeights(self):
        """y of the faces of the patch `inlet`."""
        entry = re.search(r"\binlet\s*\{([^}]*)\}", self._text("boundary")).group(1)
        n, start = (int(re.search(word + r"\s+(\d+)", entry).group(1)) for word in ("nFaces", "startFace"))
        return self.faceCentre[start:start + n, 1]
