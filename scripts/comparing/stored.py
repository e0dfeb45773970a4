# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The small form of the comparison: two bodies against displacements of CalculiX that test/compare.json holds."""
import json

import numpy as np

from comparing import calculix, runs, solids, statics

FILE = runs.ROOT / "test" / "compare.json"
NAMES = ("cantilever", "materials")
POINTS = 24  # vertices of each body that are stored, spread over its surface
DIGITS = 5  # of a stored displacement, over the largest
SPACINGS_M = (0.00567, 0.004)
# Largest |mean| and largest error of a vertex, at each spacing: what is reached with nu 0.3, and half as much again.
LIMITS = {"cantilever": [(0.018, 0.0155), (0.0102, 0.0092)], "materials": [(0.0055, 0.0125), (0.0103, 0.0105)]}
FAR_M = 1e-6  # distance of a vertex from the stored point


def spread(positions, count):
    """Returns numbers of positions that are far from each other."""
    chosen = [int(np.argmax(np.linalg.norm(positions - positions.mean(0), axis=1)))]
    apart = np.full(len(positions), np.inf)
    while len(chosen) < count:
        apart = np.minimum(apart, np.linalg.norm(positions - positions[chosen[-1]], axis=1))
        chosen.append(int(np.argmax(apart)))
    return chosen


def renew(place):
    """Writes the file; returns the exit status."""
    out = {"calculix": calculix.version(), "poisson_ratio": statics.RATIOS[0], "bodies": {}}
    for name in NAMES:
        body = statics.BODIES[name]()
        g, moved, _ = statics.gravity_for(name, body, place, statics.RATIOS[0])
        free = np.where(body.free)[0]
        chosen = free[spread(body.skin.at[free], POINTS)]
        largest = float(np.linalg.norm(moved, axis=1).max())
        out["bodies"][name] = {"gravity_m_per_s2": g, "largest_m": largest, "points_m": body.skin.at[chosen].round(9).tolist(),
                               "moved": (moved[chosen] / largest).round(DIGITS).tolist()}
    text = json.dumps(out)
    FILE.write_text(text.replace("], [", "],\n [").replace(', "', ',\n "') + "\n")
    runs.say("wrote", FILE)
    return 0


def check(place):
    """Compares viscera's equilibria with the file; returns the exit status."""
    stored = json.loads(FILE.read_text())
    ratio, wrong = stored["poisson_ratio"], 0
    for name in NAMES:
        truth, body = stored["bodies"][name], statics.BODIES[name]()
        points, moved = np.array(truth["points_m"]), truth["largest_m"] * np.array(truth["moved"])
        for spacing_m, (most_mean, most) in zip(SPACINGS_M, LIMITS[name]):
            scene = statics.scene_of(name, body, place, spacing_m, ratio, truth["gravity_m_per_s2"])
            answer = runs.simulate(place, "settle", scene, points=points)
            error = solids.compare(answer["moved"], moved)
            met = abs(error["mean"]) <= most_mean and error["most"] <= most and answer["far"] < FAR_M
            wrong += not met
            runs.say("%s, %.3g mm: mean %+.2f %% (limit %.2f), most %.2f %% (limit %.2f)%s" %
                     (name, 1e3 * spacing_m, 100 * error["mean"], 100 * most_mean, 100 * error["most"], 100 * most, "" if met else ": MISSED"))
    return 1 if wrong else 0
