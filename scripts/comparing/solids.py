# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of the compared bodies: hexahedra of twenty nodes for CalculiX, the skin of the same mesh for viscera,
tetrahedra of the same shape for Bullet. Lengths are in metres.

Organs are the maps of bench/references/walls.py, with its meshes.
"""
import math
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench" / "references"))
import walls  # pylint: disable=wrong-import-position

# Corners of the faces of elements, counted such that the face's normal points outwards.
FACES = {20: [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)],
         15: [(0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]}
MIDDLES = {20: [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
           15: [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]}
SAME_M = 1e-8  # nodes that are closer are one


class Solid:
    """A mesh of CalculiX. elements: {kind: (n, nodes)}; used: nodes that belong to elements."""

    def __init__(self, nodes, elements):
        self.nodes, self.elements = nodes, elements
        self.used = np.unique(np.concatenate([e.ravel() for e in elements.values() if len(e)]))

    def where(self, chosen):
        """Returns the nodes, of those in use, at which the function of positions is true."""
        return self.used[chosen(self.nodes[self.used])]

    def centres(self):
        """Returns the mean of each element's nodes."""
        return np.concatenate([self.nodes[e].mean(1) for e in self.elements.values() if len(e)])


def box(low, high, counts, kind="C3D20R", steps=None):
    """Returns a block of equal hexahedra. @param steps: positions of corners along an axis, in place of equal ones"""
    axes = [(steps or {}).get(k, np.linspace(low[k], high[k], counts[k] + 1)) for k in range(3)]
    return mapped(np.stack, axes, kind)


def mapped(place, axes, kind="C3D20R"):
    """Returns hexahedra of twenty nodes on a map. @param place: function of a list of three arrays and an axis, as
    numpy.stack is   @param axes: corners along each parameter"""
    axes = [walls.with_middles(np.asarray(axis, float)) for axis in axes]
    grid = np.meshgrid(*axes, indexing="ij")
    places = np.asarray(place(grid, -1)).reshape(-1, 3)
    _, first, same = np.unique(np.round(places / SAME_M).astype(np.int64), axis=0, return_index=True, return_inverse=True)
    made = walls.Mesh.__new__(walls.Mesh)
    made.nodes, made.at = places[first], same.reshape(grid[0].shape)
    counts = [(n - 1) // 2 for n in made.at.shape]
    return Solid(made.nodes, {kind: made.stack(walls.HEXAHEDRON, range(counts[0]), counts)})


def organ(name, level):
    """Returns (solid, held nodes, nodes in the plane of symmetry, axis of its normal) of half an organ, or of the block
    of two materials, and the numbers of its soft elements or None."""
    shape = walls.ORGANS.get(name)
    mesh = walls.Mesh(shape, level) if shape else walls.Block(level)
    solid = Solid(mesh.nodes, {"C3D20R": mesh.elements[20], "C3D15": mesh.elements[15]})
    return solid, mesh.held, mesh.mirrored, shape.mirror if shape else 1, getattr(mesh, "soft", None)


class Skin:
    """A closed surface through the nodes of a solid. at: positions; source: their nodes; sign: what multiplies a node's
    displacement, -1 along the mirror's normal in the reflected half; outside: whether a vertex is on the outside of the
    body, not on a border of parts or halves; parts: {name: triangles}."""

    def __init__(self, solid, mirror=None, part_of=None):
        """@param mirror: axis of the plane of symmetry, through the origin   @param part_of: function from the centre
        of an element to the name of its part"""
        faces = outer_faces(solid, part_of)
        nodes = np.unique(np.concatenate([np.ravel(t) for part in faces.values() for t in part]))
        self.source, self.at = nodes, solid.nodes[nodes]
        self.sign = np.ones_like(self.at)
        around = np.array(outer_faces(solid, None)["tissue"] if part_of else faces["tissue"])
        if mirror is not None:
            around = around[(np.abs(solid.nodes[around][:, :, mirror]) > SAME_M).any(1)]
        self.outside = np.isin(nodes, around)
        index = np.full(len(solid.nodes), -1)
        index[nodes] = np.arange(len(nodes))
        self.parts = {name: index[np.array(part)] for name, part in faces.items()}
        if mirror is not None:
            self._reflect(mirror)

    def _reflect(self, axis):
        """Adds the other half; triangles in the plane of symmetry are inside and go."""
        flat = np.abs(self.at[:, axis]) < SAME_M
        twin = np.where(flat, np.arange(len(self.at)), len(self.at) + np.cumsum(~flat) - 1)
        other, sign = self.at[~flat].copy(), self.sign[~flat].copy()
        other[:, axis] *= -1
        sign[:, axis] *= -1
        for name, part in self.parts.items():
            part = part[~flat[part].all(1)]
            self.parts[name] = np.vstack([part, twin[part][:, ::-1]])
        self.source = np.concatenate([self.source, self.source[~flat]])
        self.outside = np.concatenate([self.outside, self.outside[~flat]])
        self.at, self.sign = np.vstack([self.at, other]), np.vstack([self.sign, sign])

    @classmethod
    def of_vertices(cls, at, triangles, source):
        """Returns a skin of given vertices. @param source: node of the solid at each vertex"""
        out = cls.__new__(cls)
        out.at, out.source, out.sign, out.parts = at, source, np.ones_like(at), {"tissue": triangles}
        out.outside = np.ones(len(at), bool)
        return out

    def of(self, values):
        """Returns vectors at nodes of the solid as vectors at the skin's vertices."""
        return values[self.source] * self.sign

    def write(self, path):
        """Writes an OBJ file."""
        with open(path, "w") as out:
            out.writelines("v %.9g %.9g %.9g\n" % tuple(at) for at in self.at)
            for name, part in self.parts.items():
                out.write("o %s\n" % name)
                out.writelines("f %d %d %d\n" % tuple(t) for t in part + 1)


def outer_faces(solid, part_of):
    """Returns {part: triangles}: the faces that one element of a part has alone, cut at the middles of their edges."""
    found = {}
    for elements in solid.elements.values():
        if not len(elements):
            continue
        size = elements.shape[1]
        middles = {pair: (6 if size == 15 else 8) + k for k, pair in enumerate(map(frozenset, MIDDLES[size]))}
        for element in elements:
            name = part_of(solid.nodes[element].mean(0)) if part_of else "tissue"
            for face in FACES[size]:
                corners = [element[k] for k in face]
                between = [element[middles[frozenset((face[k - 1], face[k]))]] for k in range(len(face))]
                key = (name, frozenset(corners))
                found[key] = None if key in found else (corners, between)
    out = {}
    for (name, _), face in found.items():
        if face:
            out.setdefault(name, []).extend(triangles_of(*face))
    return {name: [t for t in part if len(set(t)) == 3] for name, part in out.items()}


def triangles_of(corners, between):
    """Returns triangles of a face. @param between: middle of the edge that ends at the corner of the same number"""
    count = len(corners)
    out = [(between[k], corners[k], between[(k + 1) % count]) for k in range(count)]
    out += [(between[0], between[k], between[k + 1]) for k in range(1, count - 1)]
    return out


# The five tetrahedra of a box, by the numbers of its corners: 1 along the first parameter, 2 and 4 along the others. Boxes
# with an odd sum of indices have the second kind, so that diagonals of neighbours agree.
FIVE = np.array([[(0, 1, 3, 5), (0, 3, 2, 6), (0, 5, 6, 4), (3, 5, 6, 7), (0, 3, 6, 5)],
                 [(1, 0, 4, 2), (1, 2, 7, 3), (1, 4, 5, 7), (2, 4, 7, 6), (1, 2, 4, 7)]])


def tetrahedra(place, counts):
    """Returns (nodes, tetrahedra, nodes at the end of the first parameter) of a map of the unit cube, with five
    tetrahedra in each of counts[0] x counts[1] x counts[2] boxes."""
    grid = np.meshgrid(*[np.linspace(0, 1, n + 1) for n in counts], indexing="ij")
    places = place(*grid).reshape(-1, 3)
    _, first, same = np.unique(np.round(places / SAME_M).astype(np.int64), axis=0, return_index=True, return_inverse=True)
    at, nodes = same.reshape(grid[0].shape), places[first]
    low = np.stack(np.meshgrid(*[np.arange(n) for n in counts], indexing="ij"), -1).reshape(-1, 3)
    corners = np.stack([at[tuple((low + (c & 1, c >> 1 & 1, c >> 2 & 1)).T)] for c in range(8)], 1)
    odd = low.sum(1) % 2
    cells = np.concatenate([corners[odd == k][:, FIVE[k].ravel()].reshape(-1, 4) for k in (0, 1)])
    x = nodes[cells]
    volume = np.einsum("ij,ij->i", x[:, 1] - x[:, 0], np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 0])) / 6
    solid = np.abs(volume) > 1e-6 * np.abs(volume).max()  # at a pole boxes are wedges
    cells, volume = cells[solid], volume[solid]
    cells[volume < 0] = cells[volume < 0][:, [0, 2, 1, 3]]
    used, cells = np.unique(cells, return_inverse=True)
    return nodes[used], cells.reshape(-1, 4), np.where(np.isin(used, at[-1]))[0]


def organ_tetrahedra(name, size_m, across):
    """Returns (nodes, tetrahedra, held nodes) of a whole organ. @param across: boxes across its wall"""
    shape = walls.ORGANS[name]
    low, high = shape.around
    if shape.mirror is not None:  # the half that is meshed, and the other one
        low, high = low, low + 2 * (high - low)
    around = shape.lengths[1] * (1 if shape.mirror is None else 2)
    counts = [2 * max(1, round(length / size_m / 2)) for length in (shape.lengths[0], around)] + [across]

    def place(s, f, t):
        return shape.place(s, low + (high - low) * f, t)
    return tetrahedra(place, counts)


def compare(moved, reference):
    """Returns how displacements differ from the reference: mean, the least-squares ratio less 1 (below 0: too stiff);
    rms and most, over the reference's largest."""
    largest = np.linalg.norm(reference, axis=1).max()
    error = np.linalg.norm(moved - reference, axis=1)
    return {"mean": float((moved * reference).sum() / (reference ** 2).sum() - 1),
            "rms": float(math.sqrt((error ** 2).mean()) / largest), "most": float(error.max() / largest)}
