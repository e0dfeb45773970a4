#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Computes what the organs of `viscera bench walls` are held to: linear elastic equilibria by CalculiX.

Needs Debian's packages calculix-ccx and python3-numpy. To print the table of bench/suites/walls/walls_references.cpp:

    bench/references/walls.py --work FOLDER [--levels 1 2] [NAME ...]

Each organ is a map of the unit cube: s along the organ from its closed or free end to its fixed end, f around it, t across
its wall. bench/suites/walls/walls_shapes.cpp has the same maps. Elements have twenty nodes (fifteen at a pole), all of them
on the map; if organ and load are symmetric, half of the organ is meshed. A level is half the number of elements across the
wall; those along it are 6 mm divided by the level, and shorter towards the fixed end. The mean displacement along the load
is weighted by mass: the work of the load over the load, twice the elastic energy over it. Elements with full and with
reduced integration have different errors; the reference is the common limit of both, from the two finest levels.
"""
import argparse
import math
import pathlib
import re
import sys
import types

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from comparing import calculix  # pylint: disable=wrong-import-position

YOUNG_PA, DENSITY, GRAVITY = 20e3, 1060.0, 9.81
RATIOS = (0.3, 0.45, 0.49)
KINDS = ("C3D20", "C3D20R")  # full and reduced integration; the former is always too stiff
ELEMENT_M = 0.006  # size along the wall, divided by the level
CROWDED = 1.7  # exponent by which elements become shorter towards the fixed end


def ellipsoid(axes, wall, cut):
    """Returns the map of an ellipsoid with its pole at -z, cut off at z = `cut`; the axes of its inside are shorter by
    the wall."""
    def place(s, f, t):
        a, b, c = (axis - wall * (1 - t) for axis in axes)
        angle = s * np.arccos(-cut / c)
        return np.stack([a * np.sin(angle) * np.cos(f), b * np.sin(angle) * np.sin(f), -c * np.cos(angle)], -1)
    return place


def bowl(s, f, t):
    """Maps half a sphere of radius 40 mm, wall 3 mm, with an opening, with its pole at -y, cut off at y = 25 mm."""
    r = 0.037 + 0.003 * t
    angle = s * np.arccos(-0.025 / r)
    return np.stack([r * np.sin(angle) * np.cos(f), -r * np.cos(angle), r * np.sin(angle) * np.sin(f)], -1)


def tube(s, f, t):
    """Maps a tube of radius 12 mm, wall 3 mm: 20 mm along x, a quarter turn of radius 35 mm, 20 mm up to z = 0."""
    r = 0.009 + 0.003 * t
    turn, leg = 0.035 * math.pi / 2, 0.020
    way = (1 - s) * (2 * leg + turn)  # from the fixed end
    bent = np.clip(way - leg, 0, turn) / 0.035
    x = 0.035 * (1 - np.cos(bent)) + np.maximum(way - leg - turn, 0)
    z = -np.minimum(way, leg) - 0.035 * np.sin(bent)
    return np.stack([x + r * np.cos(f) * np.cos(bent), r * np.sin(f), z + r * np.cos(f) * np.sin(bent)], -1)


def torus(s, f, t):
    """Maps half of a torus of radii 30 and 12 mm, wall 3 mm; both ends are fixed at y = 0."""
    r = 0.009 + 0.003 * t
    around = math.pi / 2 * (1 - s)
    out = 0.030 + r * np.cos(f)
    return np.stack([out * np.cos(around), out * np.sin(around), r * np.sin(f)], -1)


def stomach(s, f, t):
    """Maps an ellipsoid of 28 x 28 x 60 mm, wall 4 mm, cut off at 45 mm, bent with a radius of 60 mm, fixed at z = 0."""
    place = ellipsoid((0.028, 0.028, 0.060), 0.004, 0.045)(s, f, t)
    bent, out = (0.045 - place[..., 2]) / 0.060, 0.060 - place[..., 0]
    return np.stack([0.060 - out * np.cos(bent), place[..., 1], -out * np.sin(bent)], -1)


class Organ:
    """The meshed part of an organ, and its parameters.

    place: map; lengths: [m] along s, and around at its widest for the range of f; around: that range; wall: [m];
    load: direction of gravity; mirror: axis along which the displacement is zero in the plane of symmetry.
    """

    def __init__(self, place, lengths, around, load, mirror, pole=True):
        self.place, self.lengths, self.around, self.load, self.mirror, self.pole = place, lengths, around, load, mirror, pole


HALF = (0.0, math.pi)
ORGANS = {
    "bowl": Organ(bowl, (0.088, 0.063), (-math.pi / 2, 0.0), (0, 0, -1), 0),
    "bladder": Organ(ellipsoid((0.036, 0.032, 0.028), 0.003, 0.020), (0.080, 0.107), HALF, (-1, 0, 0), 1),
    "tube": Organ(tube, (0.095, 0.038), HALF, (0, 0, -1), 1, pole=False),
    "ellipsoid": Organ(ellipsoid((0.022, 0.022, 0.045), 0.003, 0.030), (0.090, 0.069), HALF, (-1, 0, 0), 1),
    "torus": Organ(torus, (0.047, 0.075), (-math.pi, math.pi), (0, 0, -1), 0, pole=False),
    "stomach": Organ(stomach, (0.120, 0.088), HALF, (-1, 0, 0), 1),
}

# Corners and edge midpoints of an element, as half steps along s, f, t, in CalculiX's order.
HEXAHEDRON = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2),
              (1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2),
              (0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
WEDGE = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2),
         (1, 0, 0), (2, 1, 0), (1, 2, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 0, 1), (2, 0, 1), (2, 2, 1)]
MIRRORED = {20: [4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11, 16, 17, 18, 19],
            15: [3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8, 12, 13, 14]}


def with_middles(steps):
    """Returns the ends of elements along an axis and the midpoints between them, in order."""
    out = np.empty(2 * len(steps) - 1)
    out[::2], out[1::2] = steps, (steps[1:] + steps[:-1]) / 2
    return out


class Mesh:
    """Nodes [m] and elements of an organ, with the fixed nodes and those in the plane of symmetry."""

    def __init__(self, organ, level):
        counts = [max(2, round(length / ELEMENT_M * level)) for length in organ.lengths] + [2 * level]
        steps = [np.linspace(0, 1, n + 1) for n in counts]
        steps[0] = 1 - (1 - steps[0]) ** CROWDED
        steps[2] = (1 - np.cos(math.pi * steps[2])) / 2
        steps = [with_middles(step) for step in steps]
        low, high = organ.around
        s, f, t = np.meshgrid(steps[0], low + (high - low) * steps[1], steps[2], indexing="ij")
        places = organ.place(s, f, t).reshape(-1, 3)
        _, first, same = np.unique(np.round(places / 1e-8).astype(np.int64), axis=0, return_index=True, return_inverse=True)
        self.nodes = places[first]
        self.at = same.reshape(s.shape)  # node of each half step
        self.held = np.unique(self.at[-1])
        self.mirrored = np.array([], int)
        if organ.mirror is not None:
            self.mirrored = np.where(np.abs(self.nodes[:, organ.mirror]) < 1e-8)[0]
        self.elements = {20: self.stack(HEXAHEDRON, range(1 if organ.pole else 0, counts[0]), counts),
                         15: self.stack(WEDGE, range(1) if organ.pole else (), counts)}
        used = np.unique(np.concatenate([e.ravel() for e in self.elements.values()]))
        self.held, self.mirrored = np.intersect1d(self.held, used), np.intersect1d(self.mirrored, used)
        self.used = used

    def stack(self, pattern, along, counts):
        """Returns the nodes of elements of one kind, ordered such that their volume is positive."""
        out = [[self.at[2 * i + a, 2 * j + b, 2 * k + c] for a, b, c in pattern]
               for i in along for j in range(counts[1]) for k in range(counts[2])]
        out = np.array(out, int).reshape(-1, len(pattern))
        if len(out) == 0:
            return out
        up = 4 if len(pattern) == 20 else 3
        x = self.nodes[out]
        volume = np.einsum("ij,ij->i", np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), x[:, up] - x[:, 0])
        assert (volume > 0).all() or (volume < 0).all()
        return out if volume[0] > 0 else out[:, MIRRORED[len(pattern)]]


class Block:
    """Half of the block of two materials: 60 x 40 x 30 mm, soft up to x = 4.3 mm and stiff beyond, held at x = 30 mm."""

    BORDER = 0.0043

    def __init__(self, level):
        size = ELEMENT_M / level
        soft, stiff = round((self.BORDER + 0.030) / size), round((0.030 - self.BORDER) / size)
        half = lambda a, b, n: np.linspace(a, b, 2 * n + 1)
        x = np.concatenate([half(-0.030, self.BORDER, soft), half(self.BORDER, 0.030, stiff)[1:]])
        grid = np.meshgrid(x, half(0, 0.020, round(0.020 / size)), half(-0.015, 0.015, round(0.030 / size)), indexing="ij")
        self.nodes = np.stack(grid, -1).reshape(-1, 3)
        self.at = np.arange(len(self.nodes)).reshape(grid[0].shape)
        counts = [(n - 1) // 2 for n in self.at.shape]
        self.elements = {20: Mesh.stack(self, HEXAHEDRON, range(counts[0]), counts), 15: np.zeros((0, 15), int)}
        self.used = np.unique(self.elements[20])
        self.held = np.intersect1d(self.at[-1], self.used)
        self.mirrored = np.intersect1d(self.at[:, 0], self.used)
        self.soft = np.where(self.nodes[self.elements[20]].mean(1)[:, 0] < self.BORDER)[0]


def run(folder, mesh, kind, ratio, load, mirror):
    """Returns the mean displacement along the load [m], the largest displacement [m] and the volume [m3] of a mesh that
    hangs under its weight, linear."""
    solid = types.SimpleNamespace(nodes=mesh.nodes, used=mesh.used, elements={kind: mesh.elements[20], "C3D15": mesh.elements[15]})
    soft = np.array(getattr(mesh, "soft", ()), int)
    stiff = np.setdiff1d(np.arange(sum(map(len, solid.elements.values()))), soft)
    parts = [(ids, young, ratio) for ids, young in ((soft, YOUNG_PA / 10), (stiff, YOUNG_PA)) if len(ids)]
    deck = calculix.Deck(solid, "linear", parts, density=DENSITY)
    deck.hold("HELD", mesh.held)
    deck.hold("MIRROR", np.setdiff1d(mesh.mirrored, mesh.held), (mirror or 0) + 1, (mirror or 0) + 1)
    deck.static(gravity=GRAVITY * np.array(load), totals="ELSE, EVOL")
    done = calculix.solve(deck, folder)
    if not done.ended:
        raise RuntimeError("CalculiX found no equilibrium")
    energy, volume = (float(re.search(r"total %s[^\n]*\n\s*\n?\s*([-+0-9.E]+)" % what, done.text).group(1)) for what in ("internal energy", "volume"))
    moved = np.linalg.norm(done.displacements(len(mesh.nodes))[-1], axis=1)
    return 2 * energy / (DENSITY * GRAVITY * volume), np.nanmax(moved), volume


def limit(coarse, fine):
    """Returns the common limit of both kinds of element, from two levels of both, if their errors shrink by the same
    factor."""
    gained = [new - old for old, new in zip(coarse, fine)]
    apart = gained[0] - gained[1]
    further = (fine[1] - fine[0]) / apart if abs(apart) > 1e-4 * fine[0] else 0
    return (fine[0] + further * gained[0] + fine[1] + further * gained[1]) / 2


def main():
    """Prints a line for every organ, level and Poisson's ratio, then the rows of the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--work", required=True, help="folder of CalculiX's files")
    parser.add_argument("--levels", type=int, nargs="+", default=[1, 2], help="half of the elements across the wall")
    parser.add_argument("names", nargs="*", default=[*ORGANS, "block"])
    asked = parser.parse_args()
    rows = []
    for name in asked.names:
        organ = ORGANS.get(name)
        load, mirror = (organ.load, organ.mirror) if organ else ((0, 0, -1), 1)
        found = {}
        for level in asked.levels:
            mesh = Mesh(organ, level) if organ else Block(level)
            for ratio in RATIOS:
                both = [run(asked.work, mesh, kind, ratio, load, mirror) for kind in KINDS]
                found[ratio, level] = [1e3 * mean for mean, _, _ in both]
                print("%-10s nu %.2f level %d nodes %6d mean %.5f mm by C3D20, %.5f mm by C3D20R, largest %.4f mm, meshed %.4f cm3" %
                      (name, ratio, level, len(mesh.used), *found[ratio, level], 1e3 * both[0][1], 1e6 * both[0][2]), flush=True)
        for ratio in RATIOS if len(asked.levels) > 1 else ():
            coarse, fine = (found[ratio, level] for level in asked.levels[-2:])
            mean = limit(coarse, fine)
            rows.append('    {"%s", %g, %.4ge-3, %.1g, %.1g, %d},' %
                        (name, ratio, mean, mean / fine[0] - 1, mean / fine[1] - 1, len(mesh.used)))
    print("\n".join(rows))


if __name__ == "__main__":
    sys.exit(main())
