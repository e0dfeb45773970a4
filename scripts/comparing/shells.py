# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A bowl with a thin wall that is pushed in until it snaps through."""
import math

import numpy as np

from comparing import calculix, runs, solids, strains

# --- Half a sphere, its rim held; a disc at its pole is pushed in.
BOWL_M, WALL_M, DISC_M = 0.040, 0.003, 0.012  # outer radius, wall, radius of the disc: the chord of the middle of the wall
BOWL_SHARES = (0.05, 0.1, 0.2, 0.3, 0.5, 0.8)  # of the radius
BOWL_RATIO, BOWL_SPACINGS_M = 0.3, (0.004, 0.003)
BOWL_ELEMENTS = (44, 2)  # along the meridian, across the wall
FIRST_RAD = 2 * math.asin(DISC_M / (2 * BOWL_M - WALL_M))  # angle from the axis to the edge of the disc
EDGE = 0.25  # what a grab reaches beyond the disc, in spacings: 0 gives a disc that is too small, 1/2 one that is too large
SECTORS = 180  # CalculiX sums the reactions of axisymmetric elements over a sector of two degrees
SHOWN = 4  # the share that the picture shows
CAMERA = {"name": "side", "position_m": [0.075, -0.09, -0.115], "target_m": [0, 0, -0.018], "width_px": 480, "height_px": 400}


def bowl_section():
    """Returns the axisymmetric mesh of the bowl (x: distance from the axis, y: towards the pole), nodes of the rim, of the
    disc's edge and of the outside. It begins at the disc, within which tissue does not deform."""
    along, across = (np.linspace(0, 1, 2 * n + 1) for n in BOWL_ELEMENTS)
    s, t = np.meshgrid(along, across, indexing="ij")
    angle, radius = FIRST_RAD + (math.pi / 2 - FIRST_RAD) * s, BOWL_M - WALL_M * (1 - t)
    nodes = np.stack([radius * np.sin(angle), radius * np.cos(angle), 0 * s], -1).reshape(-1, 3)
    at = np.arange(len(nodes)).reshape(s.shape)
    corner = [(0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0)]
    cells = np.array([[at[2 * i + a, 2 * j + b] for a, b in corner] for i in range(BOWL_ELEMENTS[0]) for j in range(BOWL_ELEMENTS[1])])
    x = nodes[cells[:, :4]]
    if np.cross(x[0, 1] - x[0, 0], x[0, 3] - x[0, 0])[2] < 0:
        cells = cells[:, [0, 3, 2, 1, 7, 6, 5, 4]]
    solid = solids.Solid(nodes, {"CAX8R": cells})
    return solid, *(np.intersect1d(solid.used, part) for part in (at[-1], at[0], at[:, -1]))


def bowl_truth(place):
    """Returns CalculiX's force at each share [N], None after it stopped; displacements there; mesh, outside and run."""
    solid, rim, disc, outside = bowl_section()
    deck = calculix.Deck(solid, "neo_hooke", None, runs.YOUNG_PA, BOWL_RATIO, runs.DENSITY)
    deck.hold("RIM", rim, 1, 2)
    deck.node_set("DISC", disc)
    deck.node_set("OUTSIDE", outside)
    for share in BOWL_SHARES:
        deck.static([("DISC", 1, 0), ("DISC", 2, -share * BOWL_M)], shown="OUTSIDE", forces=["DISC"], first=0.1)
    run = calculix.solve(deck, place.cache)
    forces = [-SECTORS * force[1] for _, force in run.forces("DISC")]
    return forces + [None] * (len(BOWL_SHARES) - len(forces)), run.displacements(len(solid.nodes)), solid, outside, run


def bowl_mesh(path):
    """Writes the whole bowl, its pole at -z, and returns its skin."""
    half = solids.walls.Organ(solids.walls.ellipsoid((BOWL_M,) * 3, WALL_M, 0.0), (0.063, 0.126), solids.walls.HALF, (0, 0, -1), 1)
    mesh = solids.walls.Mesh(half, 2)
    skin = solids.Skin(solids.Solid(mesh.nodes, {"C3D20R": mesh.elements[20], "C3D15": mesh.elements[15]}), 1)
    skin.write(path)
    return skin


def bowl(place):
    """Returns forces and shapes of the bowl; draws the last one."""
    truth, moved, solid, outside, run = bowl_truth(place)
    out = [{"program": "CalculiX", "nodes": len(solid.used), "seconds": run.seconds, "forces_n": truth}]
    path = place.work / "snap.obj"
    skin = bowl_mesh(path)
    angle = np.arctan2(np.hypot(skin.at[:, 0], skin.at[:, 1]), -skin.at[:, 2])
    outer = np.linalg.norm(skin.at, axis=1) > BOWL_M - 1e-6
    points = skin.at[outer & (angle > FIRST_RAD) & (angle < math.pi / 2 - 1e-6)]
    for spacing_m in BOWL_SPACINGS_M:
        pole = np.array([0, 0, -BOWL_M + WALL_M / 2])
        phases = [{"to": [(pole + (0, 0, share * BOWL_M)).tolist()], "ticks": 40, "hold": 60} for share in BOWL_SHARES]
        body = {"source": "mesh", "mesh_file": str(path), "textures": False}
        scene = strains.scene("snap", body, {"idle": "grab", "grab": {"radius_m": DISC_M + EDGE * spacing_m}},
                              BOWL_RATIO, spacing_m, ((0, 0, 0), (0, 0, -1)), walls="rows")
        scene["cameras"] = [CAMERA]
        found = runs.simulate(place, "drive", scene, begin=[pole.tolist()], phases=phases, points=points,
                              picture=str(place.folder / "snap.npy"), shown=SHOWN)
        forces = [-force[0][2] for force in found["forces"]]
        shapes = [solids.compare(mine, bowl_moved(solid, outside, true, points)) for mine, true in zip(found["moved"], moved)]
        out.append({"program": "viscera", "spacing_m": spacing_m, "nodes": found["nodes"], "forces_n": forces, "error": strains.against(forces, truth),
                    "mean": [shape["mean"] for shape in shapes], "most": [shape["most"] for shape in shapes], "cost": found["cost"],
                    "roll_backs": found["roll_backs"], "inverted": found["inverted"]})
        side = np.abs(points[:, 1]) < 1e-6
        np.savez(place.folder / "snap.npz", rest=points[side], moved=found["moved"][:, side], section=solid.nodes[outside],
                 true=np.array(moved)[:, outside], spacing_m=spacing_m)
        runs.say("snap, %.3g mm: force" % (1e3 * spacing_m), " ".join("-" if e is None else "%+.1f %%" % (100 * e) for e in out[-1]["error"]),
                 " shape, largest", " ".join("%.1f %%" % (100 * e) for e in out[-1]["most"]), "roll-backs", found["roll_backs"])
    return out


def bowl_moved(solid, outside, moved, points):
    """Returns CalculiX's displacements at points of the outside."""
    at = solid.nodes[outside]
    angles = np.arctan2(at[:, 0], at[:, 1])
    order = np.argsort(angles)
    sideways = np.hypot(points[:, 0], points[:, 1])
    angle = np.arctan2(sideways, -points[:, 2])
    out, up = (np.interp(angle, angles[order], moved[outside][order, k]) for k in (0, 1))
    return np.stack([out * points[:, 0] / sideways, out * points[:, 1] / sideways, -up], 1)
