# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Bodies at large strain, neo-Hookean in both programs: a clamped block, a block with a sphere in it, a bowl that is pushed
in until it snaps through."""
import math

import numpy as np

from comparing import calculix, runs, solids

FAR_M = 0.9  # radius of the sphere of a grab that holds a flat end: over 12 mm it is flat within 0.1 mm
FIRM = {"max_force_n": 1000, "max_force_rate_n_per_s": 1e6, "max_torque_nm": 100, "max_torque_rate_nm_per_s": 1e5, "workspace_m": 100}
TICK_HZ = 100
CALM_PER_S = 60  # damping by which bodies are at rest at the end of a phase


def scene(name, body, stylus, ratio, spacing_m, plane, **keys):
    """Returns a scene without weight, with one stylus. @param body: its source"""
    body = {**body, "spacing_m": spacing_m, "material": tissue(ratio, **keys),
            "fixed": [{"shape": "plane", "point_m": list(plane[0]), "normal": list(plane[1])}]}
    return {"name": name, "bodies": [body], "styluses": [{"name": "tip", **stylus, **FIRM}],
            "environment": {"gravity_m_per_s2": [0, 0, 0]}, "solver": {"tick_hz": TICK_HZ}}


def tissue(ratio, **keys):
    """Returns a damped material."""
    return runs.tissue(ratio, mass_damping_per_s=CALM_PER_S, **keys)


def against(forces, truth):
    """Returns forces relative to CalculiX's, less 1; None where CalculiX had stopped."""
    return [mine / true - 1 if true is not None else None for mine, true in zip(forces, truth)]


# --- A block of 24 x 24 x 36 mm; both ends are clamped and one is moved.
BLOCK_M = np.array([0.024, 0.024, 0.036])
SHARES = (0.1, 0.2, 0.35, 0.5)  # of the height
WAYS = {"pulled": (2, 1), "squeezed": (2, -1), "sheared": (0, 1)}  # axis, direction
BLOCK_RATIOS = (0.3,)
PRESS_RATIOS = (0.3,)
BLOCK_ELEMENTS = (6, 6, 9)
BLOCK_SPACINGS_M = (0.004, 0.003)


def block_truth(place, way, ratio):
    """Returns CalculiX's force at each share [N], None after it stopped, and its run."""
    axis, sign = WAYS[way]
    solid = solids.box(-BLOCK_M / 2, BLOCK_M / 2, BLOCK_ELEMENTS)
    deck = calculix.Deck(solid, "neo_hooke", None, runs.YOUNG_PA, ratio, runs.DENSITY)
    deck.hold("HELD", solid.where(lambda x: x[:, 2] < -BLOCK_M[2] / 2 + 1e-9))
    deck.node_set("TOP", solid.where(lambda x: x[:, 2] > BLOCK_M[2] / 2 - 1e-9))
    for share in SHARES:
        deck.static([("TOP", k + 1, sign * share * BLOCK_M[2] if k == axis else 0) for k in range(3)], shown=None, forces=["TOP"])
    run = calculix.solve(deck, place.cache)
    found = [sign * force[axis] for _, force in run.forces("TOP")]
    return found + [None] * (len(SHARES) - len(found)), run, len(solid.used)


def block(place):
    """Returns forces of the block."""
    out = []
    for ratio in BLOCK_RATIOS:
        for way, (axis, sign) in WAYS.items():
            truth, run, nodes = block_truth(place, way, ratio)
            out.append({"program": "CalculiX", "way": way, "ratio": ratio, "nodes": nodes, "seconds": run.seconds, "forces_n": truth})
            for spacing_m in BLOCK_SPACINGS_M:
                begin = np.array([0, 0, BLOCK_M[2] / 2 + FAR_M - 0.001])
                phases = []
                for share in SHARES:
                    to = begin.copy()
                    to[axis] += sign * share * BLOCK_M[2]
                    phases.append({"to": [to.tolist()], "ticks": 30, "hold": 40})
                body = {"source": "box", "box_size_m": BLOCK_M.tolist()}
                made = scene("block", body, {"idle": "grab", "grab": {"radius_m": FAR_M}}, ratio, spacing_m,
                             ((0, 0, -BLOCK_M[2] / 2), (0, 0, 1)))
                found = runs.simulate(place, "drive", made, begin=[begin.tolist()], phases=phases)
                forces = [-sign * force[0][axis] for force in found["forces"]]
                out.append({"program": "viscera", "way": way, "ratio": ratio, "spacing_m": spacing_m, "nodes": found["nodes"], "forces_n": forces,
                            "error": against(forces, truth), "cost": found["cost"], "roll_backs": found["roll_backs"], "inverted": found["inverted"]})
                runs.say("block", way, "nu %g, %.3g mm:" % (ratio, 1e3 * spacing_m),
                         " ".join("-" if e is None else "%+.1f %%" % (100 * e) for e in out[-1]["error"]))
    return out


# --- A sphere of 15 mm, without friction, pressed into a block of 60 x 60 x 30 mm on a plate.
PRESSED_M, BALL_M = np.array([0.06, 0.06, 0.03]), 0.015
DEPTHS_M = (0.001, 0.002, 0.004, 0.006)
PRESS_SPACINGS_M = (0.006, 0.005, 0.003)  # whole cells over 30 mm: the top is a plane of nodes
FINE_M, CONTACT_M = 0.003, 0.009  # edges of elements below the ball, and how far they go
CAP_STEPS, CAP_DEG, CAP_STIFF = 12, 62.0, 100  # steps of the ball's surface, its half angle, E over the block's
PENALTY = 50  # stiffness of the contact: E over the edge, times this


def graded(length_m):
    """Returns positions from 0 to a length, with equal steps to CONTACT_M and growing ones beyond."""
    out, step = [0.0], FINE_M
    while out[-1] < length_m - 1e-9:
        step = step if out[-1] < CONTACT_M - 1e-9 else 1.4 * step
        out.append(out[-1] + step)
    scale = (length_m - CONTACT_M) / (out[-1] - CONTACT_M)
    return [at if at <= CONTACT_M + 1e-9 else CONTACT_M + (at - CONTACT_M) * scale for at in out]


def ball_cap():
    """Returns nodes and elements (C3D8) of a quarter of the ball's lower side; faces S1 are its surface."""
    count = CAP_STEPS + 1
    angles, turns = np.radians(np.linspace(0.05, CAP_DEG, count)), np.radians(np.linspace(-4, 94, count))
    centre = np.array([0, 0, PRESSED_M[2] / 2 + BALL_M])
    nodes = np.array([centre + r * np.array([math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), -math.cos(a)])
                      for r in (BALL_M, 0.8 * BALL_M) for a in angles for b in turns])
    at = np.arange(len(nodes)).reshape(2, count, count)
    cells = np.array([[at[k][i, j] for k in (0, 1) for i, j in ((a, b), (a, b + 1), (a + 1, b + 1), (a + 1, b))]
                      for a in range(CAP_STEPS) for b in range(CAP_STEPS)])
    x = nodes[cells]
    wrong = np.einsum("ij,ij->i", np.cross(x[:, 1] - x[:, 0], x[:, 3] - x[:, 0]), x[:, 4] - x[:, 0]) < 0
    cells[wrong] = cells[wrong][:, [0, 3, 2, 1, 4, 7, 6, 5]]
    return nodes, cells


def press_deck(ratio):
    """Returns the deck of a quarter of the block, and its number of nodes."""
    half = PRESSED_M / 2
    down = [half[2] - at for at in reversed(graded(PRESSED_M[2]))]
    solid = solids.box(np.zeros(3), half, (1, 1, 1), steps={0: graded(half[0]), 1: graded(half[1]), 2: down})
    deck = calculix.Deck(solid, "neo_hooke", None, runs.YOUNG_PA, ratio, runs.DENSITY)
    bottom = solid.where(lambda x: x[:, 2] < -half[2] + 1e-9)
    deck.hold("HELD", bottom)
    for axis in (0, 1):
        deck.hold("SIDE%d" % axis, np.setdiff1d(solid.where(lambda x, k=axis: x[:, k] < 1e-9), bottom), axis + 1, axis + 1)
    elements = solid.elements["C3D20R"]
    corners = solid.nodes[elements[:, :8]]
    top = (corners[:, :, 2] > half[2] - 1e-9) & (np.hypot(corners[:, :, 0], corners[:, :, 1]).min(1) < 0.012)[:, None]
    slave = [(k + 1, 1 if top[k][:4].all() else 2) for k in np.where(top.sum(1) == 4)[0]]
    nodes, cells = ball_cap()
    first, count = len(solid.nodes), len(elements)
    text = "*NODE, NSET=BALL\n" + "".join("%d, %.12g, %.12g, %.12g\n" % (first + k + 1, *at) for k, at in enumerate(nodes))
    text += "*ELEMENT, TYPE=C3D8, ELSET=BALL\n"
    text += "".join("%d, %s\n" % (count + k + 1, ", ".join(str(first + n + 1) for n in cell)) for k, cell in enumerate(cells))
    text += "*MATERIAL, NAME=BALL\n*ELASTIC\n%g, 0.3\n*DENSITY\n1000\n*SOLID SECTION, ELSET=BALL, MATERIAL=BALL\n" % (CAP_STIFF * runs.YOUNG_PA)
    text += "*SURFACE, NAME=SLAVE\n" + "".join("%d, S%d\n" % face for face in slave)
    text += "*SURFACE, NAME=MASTER\n" + "".join("%d, S1\n" % (count + k + 1) for k in range(len(cells)))
    text += "*SURFACE INTERACTION, NAME=CONTACT\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n%g\n" % (PENALTY * runs.YOUNG_PA / FINE_M)
    text += "*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE\nSLAVE, MASTER\n*BOUNDARY\nBALL, 1, 2\n"
    deck.raw(text)
    for depth_m in DEPTHS_M:
        deck.static([("BALL", 3, -depth_m)], shown=None, forces=["HELD"], first=0.5)
    return deck, len(solid.used)


def press(place):
    """Returns forces on the ball."""
    out = []
    for ratio in PRESS_RATIOS:
        deck, nodes = press_deck(ratio)
        run = calculix.solve(deck, place.cache)
        truth = [4 * abs(force[2]) for _, force in run.forces("HELD")]
        truth += [None] * (len(DEPTHS_M) - len(truth))
        out.append({"program": "CalculiX", "ratio": ratio, "nodes": nodes, "seconds": run.seconds, "forces_n": truth})
        for spacing_m in PRESS_SPACINGS_M:
            top = np.array([0, 0, PRESSED_M[2] / 2 + BALL_M])
            phases = [{"to": [(top - (0, 0, depth_m)).tolist()], "ticks": 20, "hold": 50} for depth_m in DEPTHS_M]
            made = scene("press", {"source": "box", "box_size_m": PRESSED_M.tolist()}, {"idle": "probe", "probe": {"radius_m": BALL_M}}, ratio, spacing_m,
                         ((0, 0, -PRESSED_M[2] / 2), (0, 0, 1)))
            found = runs.simulate(place, "drive", made, begin=[(top + (0, 0, 0.0005)).tolist()], phases=phases)
            forces = [abs(force[0][2]) for force in found["forces"]]
            out.append({"program": "viscera", "ratio": ratio, "spacing_m": spacing_m, "nodes": found["nodes"], "forces_n": forces,
                        "error": against(forces, truth), "cost": found["cost"]})
            runs.say("press nu %g, %.3g mm:" % (ratio, 1e3 * spacing_m), " ".join("-" if e is None else "%+.1f %%" % (100 * e) for e in out[-1]["error"]))
    return out
