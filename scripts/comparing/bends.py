# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A tube that is bent by a quarter turn: its upper end follows an arc of constant curvature."""
import math

import numpy as np

from comparing import calculix, runs, solids, strains

LENGTH_M, OUTER_M, WALL_M = 0.060, 0.012, 0.003
TURNS_DEG = (15, 30, 45, 60, 75, 90)
RATIO, SPACINGS_M = 0.3, (0.004, 0.003)
COUNTS = (16, 8, 2)  # elements of a half along the tube, around it, across its wall
TICKS_PER_DEG, HOLD = 2, 40
REACH_M = strains.FAR_M - 0.001  # from the end's middle to the middle of the sphere that holds it


def shape(turn, counts):
    """Returns hexahedra of a part of the tube, which stands on z = 0. @param turn: angle around it [rad]"""
    def place(grid, _):
        z, f, r = grid
        return np.stack([r * np.cos(f), r * np.sin(f), z], -1)
    axes = [(0, LENGTH_M), (0, turn), (OUTER_M - WALL_M, OUTER_M)]
    return solids.mapped(place, [np.linspace(*ends, n + 1) for ends, n in zip(axes, counts)])


def end_pose(degrees):
    """Returns the middle of the upper end [m] and the rotation of the end, about y."""
    turn = math.radians(degrees)
    radius = LENGTH_M / turn if turn > 0 else math.inf
    middle = np.array([radius * (1 - math.cos(turn)), 0, radius * math.sin(turn)]) if turn > 0 else np.array([0, 0, LENGTH_M])
    return middle, np.array([[math.cos(turn), 0, math.sin(turn)], [0, 1, 0], [-math.sin(turn), 0, math.cos(turn)]])


def stylus_pose(degrees):
    """Returns the pose of the stylus that holds the end."""
    middle, rotation = end_pose(degrees)
    half = math.radians(degrees) / 2
    return [*(middle + rotation @ (0, 0, REACH_M)).tolist(), 0.0, math.sin(half), 0.0, math.cos(half)]


def truth(place):
    """Returns CalculiX's bending moment of the end at each turn [N m], displacements there, mesh and run."""
    solid = shape(math.pi, COUNTS)
    deck = calculix.Deck(solid, "neo_hooke", None, runs.YOUNG_PA, RATIO, runs.DENSITY)
    bottom, top = (solid.where(lambda x, z=z: np.abs(x[:, 2] - z) < 1e-9) for z in (0, LENGTH_M))
    deck.hold("HELD", bottom)
    deck.hold("MIRROR", np.setdiff1d(solid.where(lambda x: np.abs(x[:, 1]) < 1e-9), np.union1d(bottom, top)), 2, 2)
    deck.node_set("TOP", top)
    offset = solid.nodes[top] - (0, 0, LENGTH_M)
    targets = []
    for degrees in TURNS_DEG:
        middle, rotation = end_pose(degrees)
        targets.append(middle + offset @ rotation.T)
        moved = targets[-1] - solid.nodes[top]
        deck.static([(str(node + 1), axis + 1, moved[k, axis]) for k, node in enumerate(top) for axis in range(3)], reactions=["TOP"], first=0.25)
    run = calculix.solve(deck, place.cache)
    moments = []
    for degrees, at, forces in zip(TURNS_DEG, targets, run.displacements(len(solid.nodes), "forces")):
        arm = at - end_pose(degrees)[0]
        moments.append(2 * float(np.cross(arm, forces[top])[:, 1].sum()))
    return moments + [None] * (len(TURNS_DEG) - len(moments)), run.displacements(len(solid.nodes)), solid, run


def bend(place):
    """Returns moments and shapes of the tube."""
    moments, moved, solid, run = truth(place)
    out = [{"program": "CalculiX", "nodes": len(solid.used), "seconds": run.seconds, "moments_nm": moments}]
    runs.say("bend: CalculiX", moments, "%.1f s" % run.seconds)
    half = solids.Skin(solid, 1)
    skin = solids.Skin(shape(2 * math.pi, (2 * COUNTS[0], 4 * COUNTS[1], COUNTS[2])))
    path = place.work / "bend.obj"
    skin.write(path)
    seen = half.outside & (half.at[:, 2] > 1e-6) & (half.at[:, 2] < LENGTH_M - 1e-6)
    for spacing_m in SPACINGS_M:
        before, phases = 0, []
        for degrees in TURNS_DEG:
            way = np.linspace(before, degrees, TICKS_PER_DEG * (degrees - before) + 1)[1:]
            phases.append({"path": [[stylus_pose(d)] for d in way], "hold": HOLD})
            before = degrees
        scene = strains.scene("bend", {"source": "mesh", "mesh_file": str(path), "textures": False},
                              {"idle": "grab", "grab": {"radius_m": strains.FAR_M}}, RATIO, spacing_m, ((0, 0, 0), (0, 0, 1)), walls="rows")
        found = runs.simulate(place, "drive", scene, begin=[stylus_pose(0)], phases=phases, points=half.at[seen])
        mine = []
        for degrees, felt in zip(TURNS_DEG, found["forces"]):
            arm = np.array(stylus_pose(degrees)[:3]) - end_pose(degrees)[0]
            mine.append(-float(felt[0][4] + np.cross(arm, felt[0][:3])[1]))
        shapes = [solids.compare(ours, half.of(true)[seen]) for ours, true in zip(found["moved"], moved)]
        out.append({"program": "viscera", "spacing_m": spacing_m, "nodes": found["nodes"], "moments_nm": mine, "error": strains.against(mine, moments),
                    "most": [error["most"] for error in shapes], "cost": found["cost"], "roll_backs": found["roll_backs"]})
        runs.say("bend, %.3g mm: moment" % (1e3 * spacing_m), " ".join("-" if e is None else "%+.1f %%" % (100 * e) for e in out[-1]["error"]),
                 " shape, largest", " ".join("%.1f %%" % (100 * e) for e in out[-1]["most"]))
    return out
