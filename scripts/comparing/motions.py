# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Frequencies and decay: CalculiX's modes against how viscera's bodies swing."""
import math

import numpy as np

from comparing import calculix, runs, solids, statics

TICK_HZ, SECONDS = 200, 8
SMALL_G = 0.03  # weight that sets the cantilever swinging [m/s2]
RATIO = 0.3
DAMPING_PER_S = 4.0
PULL_M = 0.0005  # by which free bodies are pulled before they are let go
SEARCH = np.linspace(0.85, 1.18, 67)  # frequencies tried, over CalculiX's


def fitted(signal, guesses, decay):
    """Returns (frequency [Hz], decay [1/s]) of damped cosines in a signal, the first guess first."""
    from scipy.optimize import least_squares
    time = (np.arange(len(signal)) + 1) / TICK_HZ

    def left(values):
        columns = [np.ones_like(time)]
        for frequency, rate in values.reshape(-1, 2):
            columns += [np.exp(-rate * time) * np.cos(2 * math.pi * frequency * time), np.exp(-rate * time) * np.sin(2 * math.pi * frequency * time)]
        matrix = np.stack(columns, 1)
        return (matrix @ np.linalg.lstsq(matrix, signal, rcond=None)[0] - signal) / signal.std()
    values = np.zeros(0)
    for guess in guesses:
        tried = [np.append(values, (guess * factor, decay)) for factor in SEARCH]
        best = min(tried, key=lambda v: float((left(v) ** 2).sum()))
        values = least_squares(left, best, x_scale=np.maximum(np.abs(best), 0.1), max_nfev=60).x
    return [(float(f), float(d)) for f, d in values.reshape(-1, 2)]


def cantilever_modes(place, body):
    """Returns {axis: the two lowest frequencies of bending along it}, and the run."""
    deck = calculix.Deck(body.solid, "linear", None, runs.YOUNG_PA, RATIO, runs.DENSITY)
    deck.hold("HELD", body.held)
    deck.node_set("TIP", body.solid.where(lambda x: x[:, 0] > 0.05 - 1e-9))
    deck.frequencies(8, "TIP")
    run = calculix.solve(deck, place.cache)
    out = {1: [], 2: []}
    for frequency, moved in zip(run.modes(), run.displacements(len(body.solid.nodes))):
        mean = np.abs(np.nanmean(moved, 0))
        if mean.max() > 0.2 * np.nanmax(np.abs(moved)) and int(mean.argmax()) in out:
            out[int(mean.argmax())].append(frequency)
    return {axis: found[:2] for axis, found in out.items()}, run


def cantilever(place):
    """Returns frequencies of a beam without damping, and with DAMPING_PER_S."""
    body = statics.cantilever()
    modes, run = cantilever_modes(place, body)
    out = [{"program": "CalculiX", "body": "cantilever", "nodes": len(body.solid.used), "seconds": run.seconds, "hz": [*modes[2], *modes[1]]}]
    runs.say("swings: CalculiX %s Hz" % out[0]["hz"])
    for damping, spacings in ((0.0, statics.SPACINGS_M), (DAMPING_PER_S, statics.SPACINGS_M[1:2])):
        for spacing_m in spacings:
            scene = statics.scene_of("swings", body, place, spacing_m, RATIO, 0)
            scene["environment"]["gravity_m_per_s2"] = [0, SMALL_G, SMALL_G]
            scene["bodies"][0]["material"].update(mass_damping_per_s=damping, stiffness_damping_ratio=0.0)
            scene["solver"] = {"tick_hz": TICK_HZ}
            tip = [[0.0499, -1, -1], [1, 1, 1]]
            found = runs.simulate(place, "swing", scene, seen=[tip], ticks=TICK_HZ * SECONDS)
            swings = [mode for axis in (2, 1) for mode in fitted(found["moved"][:, 0, axis], modes[axis], damping / 2)]
            out.append(result("cantilever", spacing_m, found, swings, out[0]["hz"], damping))
    return out


def result(body, spacing_m, found, swings, truth, damping=0.0):
    """Returns a run of viscera, with errors of frequencies; damping lowers CalculiX's: omega^2 - (damping/2)^2."""
    slower = [math.sqrt(hz ** 2 - (damping / 4 / math.pi) ** 2) for hz in truth]
    out = {"program": "viscera", "body": body, "spacing_m": spacing_m, "nodes": found["nodes"], "damping_per_s": damping,
           "hz": [f for f, _ in swings], "decay_per_s": [d for _, d in swings], "error": [f / hz - 1 for (f, _), hz in zip(swings, slower)]}
    runs.say("swings: %s, %.3g mm, damping %g:" % (body, 1e3 * spacing_m, damping), " ".join("%+.2f %%" % (100 * e) for e in out["error"]),
             " decay", " ".join("%.3f" % d for d in out["decay_per_s"]))
    return out


# --- Free bodies, pulled at one end and let go: a plate at its middle, a ring outwards at one side.
PLATE_M = np.array([0.08, 0.06, 0.006])
RING_M = (0.027, 0.033, 0.006)  # inner and outer radius, height
FREE_SPACINGS_M = (0.004, 0.003)
RIGID_HZ = 0.05  # modes below this are motions as a rigid body


def free_modes(place, solid, planes, count, shape):
    """Returns frequencies of a part of a free body between planes of symmetry. @param planes: axes of their normals;
    shape: function of displacements that is not zero in the wanted modes"""
    deck = calculix.Deck(solid, "linear", None, runs.YOUNG_PA, RATIO, runs.DENSITY)
    for axis in planes:
        deck.hold("SIDE%d" % axis, solid.where(lambda x, k=axis: np.abs(x[:, k]) < 1e-9), axis + 1, axis + 1)
    deck.frequencies(count, "ALL")
    run = calculix.solve(deck, place.cache)
    out = []
    for hz, moved in zip(run.modes(), run.displacements(len(solid.nodes))):
        if hz > RIGID_HZ and abs(shape(moved)) > 0.2 * np.nanmax(np.abs(moved)):
            out.append(hz)
    return out, run


def plate():
    """Returns (quarter of a plate, planes of symmetry, function of displacements, mesh of the whole, end that is pulled,
    direction, boxes that are seen)."""
    half = PLATE_M / 2
    solid = solids.box((0, 0, -half[2]), half, (10, 8, 2))
    near = lambda at: int(solid.used[np.argmin(np.linalg.norm(solid.nodes[solid.used] - at, axis=1))])
    corner, middle = near((half[0], half[1], 0)), near((0, 0, 0))
    whole = solids.box(-half, half, (20, 15, 2))
    seen = [[[-0.004, -0.004, -1], [0.004, 0.004, 1]], [[half[0] - 0.004, -1, -1], [1, 1, 1]], ]
    return solid, (0, 1), lambda u: u[corner, 2] - u[middle, 2], whole, (0, 0, 0), 2, seen


def ring():
    """Returns the same of a ring, of which a half is meshed."""
    inner, outer, height = RING_M

    def place(grid, _, turn=math.pi):
        f, r, z = grid
        return np.stack([r * np.cos(turn * f), r * np.sin(turn * f), z], -1)
    radii = np.linspace(inner, outer, 3)
    solid = solids.mapped(place, [np.linspace(0, 1, 33), radii, np.linspace(0, height / 2, 2)])
    near = lambda at: int(solid.used[np.argmin(np.linalg.norm(solid.nodes[solid.used] - at, axis=1))])
    right, left = near((outer, 0, 0)), near((-outer, 0, 0))
    whole = solids.mapped(lambda grid, axis: place(grid, axis, 2 * math.pi), [np.linspace(0, 1, 65), radii, np.linspace(-height / 2, height / 2, 3)])
    seen = [[[inner - 0.002, -0.004, -1], [1, 0.004, 1]], [[-1, -0.004, -1], [-inner + 0.002, 0.004, 1]]]
    return solid, (1, 2), lambda u: u[right, 0] - u[left, 0], whole, ((inner + outer) / 2, 0, 0), 0, seen


def free(place, name, made, count):
    """Returns frequencies of a free body."""
    solid, planes, shape, whole, pulled, axis, seen = made
    truth, run = free_modes(place, solid, planes, 12, shape)
    truth = truth[:count]
    out = [{"program": "CalculiX", "body": name, "nodes": len(solid.used), "seconds": run.seconds, "hz": truth}]
    runs.say("swings: %s: CalculiX %s Hz" % (name, truth))
    path = place.work / "free.obj"
    solids.Skin(whole).write(path)
    to = np.array(pulled, float)
    to[axis] += PULL_M
    for spacing_m in FREE_SPACINGS_M:
        body = {"source": "mesh", "mesh_file": str(path), "textures": False, "spacing_m": spacing_m,
                "material": runs.tissue(RATIO, walls="rows", mass_damping_per_s=0.0, stiffness_damping_ratio=0.0)}
        scene = {"name": name, "bodies": [body], "environment": {"gravity_m_per_s2": [0, 0, 0]}, "solver": {"tick_hz": TICK_HZ},
                 "styluses": [{"name": "tip", "idle": "none", "button1": "grab", "grab": {"radius_m": 0.006}}]}
        found = runs.simulate(place, "swing", scene, seen=seen, pull=[list(pulled), to.tolist()], pull_ticks=10, ticks=TICK_HZ * SECONDS)
        signal = found["moved"][:, 0, axis] - found["moved"][:, 1, axis]
        out.append(result(name, spacing_m, found, fitted(signal, truth, 0.0), truth))
    return out


def swings(place):
    """Returns frequencies of all bodies."""
    return cantilever(place) + free(place, "plate", plate(), 2) + free(place, "ring", ring(), 1)
