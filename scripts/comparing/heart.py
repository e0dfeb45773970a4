# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The built-in heart for CalculiX: viscera's surface mesh, with better triangles by gmsh, filled by tetgen, cut off at the
plane above which it is held.

Needs Debian's packages python3-gmsh, tetgen and python3-scipy.
"""
import math
import subprocess

import numpy as np

from comparing import runs, solids, statics

HELD_Z_M = 0.03
SKIN_M, EDGE_M = 0.003, 0.0042  # spacing of viscera's surface mesh, edges of gmsh's
SNAP = 0.08  # nodes closer to the plane than this share of an edge are moved to it
SIZE_M = 0.148
TETGEN = "-pq2.0/5AzQ"  # faces given; radius over edge, dihedral angle; regions; counted from 0
EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]  # middles of C3D10, in CalculiX's order


def compact(nodes, cells):
    """Returns only the nodes that cells have, with cells renumbered."""
    used, inverse = np.unique(cells, return_inverse=True)
    return nodes[used], inverse.reshape(cells.shape)


def volumes(nodes, cells):
    """Returns signed volumes of tetrahedra [m3]."""
    x = nodes[cells]
    return np.einsum("ij,ij->i", x[:, 1] - x[:, 0], np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 0])) / 6


def positive(nodes, cells):
    """Returns tetrahedra with positive volumes."""
    cells, wrong = cells.copy(), volumes(nodes, cells) < 0
    cells[wrong] = cells[wrong][:, [1, 0, 2, 3]]
    return cells


def enclosed(vertices, triangles):
    """Returns the signed volume within triangles [m3]."""
    x = vertices[triangles]
    return np.einsum("ij,ij->i", x[:, 0], np.cross(x[:, 1], x[:, 2])).sum() / 6


def weld(vertices, triangles):
    """Returns vertices at the same position as one."""
    _, first, same = np.unique(np.round(vertices / 1e-7).astype(np.int64), axis=0, return_index=True, return_inverse=True)
    triangles = same.reshape(-1)[triangles]
    proper = (triangles[:, 0] != triangles[:, 1]) & (triangles[:, 1] != triangles[:, 2]) & (triangles[:, 0] != triangles[:, 2])
    return vertices[first], triangles[proper]


def remeshed(vertices, triangles, edge_m):
    """Returns each closed component with triangles of a given size."""
    import gmsh
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    pairs = np.vstack([triangles[:, :2], triangles[:, 1:]])
    graph = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(vertices),) * 2)
    count, label = connected_components(graph, directed=False)
    all_vertices, all_triangles, before = [], [], 0
    for k in range(count):
        chosen = triangles[label[triangles[:, 0]] == k]
        if not len(chosen):
            continue
        part, faces = compact(vertices, chosen)
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        surface = gmsh.model.addDiscreteEntity(2)
        gmsh.model.mesh.addNodes(2, surface, np.arange(1, len(part) + 1), part.ravel())
        gmsh.model.mesh.addElementsByType(surface, 2, [], (faces + 1).ravel())
        gmsh.model.mesh.classifySurfaces(math.pi, True, True, math.pi)
        gmsh.model.mesh.createGeometry()
        for end in ("Min", "Max"):
            gmsh.option.setNumber("Mesh.MeshSize" + end, edge_m)
        gmsh.model.mesh.generate(2)
        tags, at, _ = gmsh.model.mesh.getNodes()
        index = np.zeros(int(tags.max()) + 1, int)
        index[tags.astype(int)] = np.arange(len(tags))
        new, fresh = compact(at.reshape(-1, 3), index[gmsh.model.mesh.getElementsByType(2)[1].astype(int)].reshape(-1, 3))
        gmsh.finalize()
        if enclosed(part, faces) * enclosed(new, fresh) < 0:
            fresh = fresh[:, ::-1]
        all_vertices.append(new)
        all_triangles.append(fresh + before)
        before += len(new)
    return np.vstack(all_vertices), np.vstack(all_triangles)


def winding(vertices, triangles, point):
    """Returns how often triangles enclose a point."""
    a, b, c = (vertices[triangles[:, k]] - point for k in range(3))
    la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
    triple = np.einsum("ij,ij->i", a, np.cross(b, c))
    dot = lambda x, y: np.einsum("ij,ij->i", x, y)
    return np.arctan2(triple, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb).sum() / (2 * math.pi)


def filled(vertices, triangles, folder):
    """Returns tetrahedra inside closed triangles; the first nodes are the vertices."""
    path = folder / "heart.smesh"
    with open(path, "w") as out:
        out.write("%d 3 0 0\n" % len(vertices))
        out.writelines("%d %.9g %.9g %.9g\n" % (k, *(1e3 * at)) for k, at in enumerate(vertices))
        out.write("%d 0\n" % len(triangles))
        out.writelines("3 %d %d %d\n" % tuple(t) for t in triangles)
        out.write("0\n0\n")
    subprocess.run(["tetgen", TETGEN, str(path)], check=True, capture_output=True)
    nodes = np.loadtxt(folder / "heart.1.node", skiprows=1, comments="#")[:, 1:4] * 1e-3
    rows = np.loadtxt(folder / "heart.1.ele", skiprows=1, comments="#").astype(int)
    cells, region = positive(nodes, rows[:, 1:5]), rows[:, 5]
    inside = np.zeros(len(cells), bool)
    for k in np.unique(region):
        chosen = np.where(region == k)[0]
        largest = chosen[np.argmax(volumes(nodes, cells[chosen]))]
        inside[chosen] = abs(winding(vertices, triangles, nodes[cells[largest]].mean(0))) > 0.5
    return compact(nodes, cells[inside])


class Cut:
    """Tetrahedra on one side of a plane, conforming: edges are cut where they cross it."""

    def __init__(self, nodes, cells, above):
        """@param above: signed height of nodes; what is below zero is cut off"""
        self.nodes, self.above, self.made = list(nodes), above, {}
        sign = np.sign(above)[cells]
        out = []
        for cell in cells[(sign > 0).any(1) & (sign < 0).any(1)]:
            out += self._parts([k for k in cell if above[k] > 0], [k for k in cell if above[k] < 0], [k for k in cell if above[k] == 0])
        whole = cells[(sign >= 0).all(1) & (sign > 0).any(1)]
        self.cells = np.vstack([whole, np.array(out, int).reshape(-1, 4)])

    def _on(self, a, b):
        key = (min(a, b), max(a, b))
        if key not in self.made:
            t = self.above[a] / (self.above[a] - self.above[b])
            self.made[key] = len(self.nodes)
            self.nodes.append(self.nodes[a] + t * (self.nodes[b] - self.nodes[a]))
        return self.made[key]

    def _parts(self, kept, gone, flat):
        on = self._on
        if len(kept) == 1:
            return [(kept[0], *[on(kept[0], j) for j in gone], *flat)]
        if len(kept) == 2 and len(gone) == 1:
            a, b = kept
            x, y = on(a, gone[0]), on(b, gone[0])
            if min(a, y) < min(b, x):  # the diagonal of a quadrilateral begins at its lowest node, in either tetrahedron
                return [(a, b, y, flat[0]), (a, y, x, flat[0])]
            return [(a, b, x, flat[0]), (b, y, x, flat[0])]
        if len(kept) == 2:
            a, b = kept
            return prism([a, on(a, gone[0]), on(a, gone[1]), b, on(b, gone[0]), on(b, gone[1])])
        return prism([*kept, *[on(k, gone[0]) for k in kept]])


def prism(p):
    """Returns three tetrahedra of a prism with bottom p[:3] and top p[3:]; diagonals begin at lowest nodes."""
    turns = [(0, 1, 2, 3, 4, 5), (1, 2, 0, 4, 5, 3), (2, 0, 1, 5, 3, 4), (3, 5, 4, 0, 2, 1), (4, 3, 5, 1, 0, 2), (5, 4, 3, 2, 1, 0)]
    q = [p[k] for k in turns[int(np.argmin(p))]]
    if min(q[1], q[5]) < min(q[2], q[4]):
        return [(q[0], q[1], q[2], q[5]), (q[0], q[1], q[5], q[4]), (q[0], q[4], q[5], q[3])]
    return [(q[0], q[1], q[2], q[4]), (q[0], q[4], q[2], q[5]), (q[0], q[4], q[5], q[3])]


def clipped(nodes, cells, height_m):
    """Returns what is below a height."""
    above = height_m - nodes[:, 2]
    edge = np.cbrt(8.5 * np.median(volumes(nodes, cells)))
    near = np.abs(above) < SNAP * edge
    nodes = nodes.copy()
    nodes[near, 2] = height_m
    above[near] = 0
    cut = Cut(nodes, cells, above)
    nodes = np.array(cut.nodes)
    cells = positive(nodes, cut.cells)
    size = volumes(nodes, cells)
    return compact(nodes, cells[size > 1e-6 * np.median(size)])


def quadratic(nodes, cells):
    """Returns tetrahedra of ten nodes as a Solid."""
    pairs = np.sort(np.stack([cells[:, list(edge)] for edge in EDGES], 1), axis=2)
    edges, inverse = np.unique(pairs.reshape(-1, 2), axis=0, return_inverse=True)
    middles = len(nodes) + inverse.reshape(-1, 6)
    return solids.Solid(np.vstack([nodes, nodes[edges].mean(1)]), {"C3D10": np.hstack([cells, middles])})


def body(place):
    """Returns the heart as a body that hangs; the mesh is kept in the folder of the comparison."""
    kept = place.folder / "heart.npz"
    if not kept.exists():
        scene = {"name": "heart", "bodies": [{"source": "phantom", "spacing_m": 0.004, "skin_spacing_m": SKIN_M}]}
        skin = runs.simulate(place, "skin", scene)
        vertices, triangles = remeshed(*weld(np.array(skin["at"]), np.array(skin["triangles"])), EDGE_M)
        nodes, cells = clipped(*filled(vertices, triangles, place.work), HELD_Z_M)
        np.savez(kept, vertices=vertices, triangles=triangles, nodes=nodes, cells=cells)
    mesh = np.load(kept)
    from scipy.spatial import cKDTree
    solid = quadratic(mesh["nodes"], mesh["cells"])
    apart, source = cKDTree(mesh["nodes"]).query(mesh["vertices"])
    skin = solids.Skin.of_vertices(mesh["vertices"], mesh["triangles"], source)
    held = solid.where(lambda x: x[:, 2] > HELD_Z_M - 1e-9)
    out = statics.Body(solid, held, statics.plane_at(2, HELD_Z_M), (0, 0, -1), SIZE_M, skin=skin, walls="rows")
    out.free &= apart < 1e-7
    return out
