# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Throughput: node-seconds of tissue (nodes times simulated seconds) per second of the clock, for sessions side by side,
with the error of their spacing. Needs NumPy, and CalculiX's displacements in test/compare.json, alone."""
import csv
import json
import pathlib
import re
import subprocess
import time

import numpy as np

from comparing import runs, solids, statics, stored

SESSIONS = (1, 8, 64)
SPACINGS_M = (0.00567, 0.004, 0.003)
BODY = "cantilever"  # it swings under its weight, so all of it is stepped
TURNS = 2  # the fastest counts
RUN_S = 1.5  # of the clock, of a measurement of VectorSession
SWEEP_S = 0.4  # of the clock, of a run of `viscera sweep` by itself, in addition to its start
SMALL_SESSIONS, SMALL_S = (1, 3), 0.1
PEERS = [  # published rates: program, what is simulated, nodes, sessions, their steps a second, seconds of a step, machine, source
    ("PhysX, in Isaac Lab", "beam of 300 x 40 x 40 mm", 67, 1024, 18622, 1 / 30, "RTX 5090",
     "[rate](https://github.com/newton-physics/newton/issues/4141), [nodes](https://github.com/isaac-sim/IsaacLab/pull/6674)"),
    ("Newton, vertex block descent", "the same", 67, 4096, 11808, 1 / 30, "RTX 5090",
     "[the same](https://github.com/newton-physics/newton/issues/4141)"),
]
BULLET = (420, 1.8, -0.189)  # nodes, cost and mean error of the cantilever above, linear law
TITLE = "Throughput"


def scene_of(place, spacing_m, truth, ratio):
    """Returns the scene of the body, awake."""
    scene = statics.scene_of(BODY, statics.BODIES[BODY](), place, spacing_m, ratio, truth["gravity_m_per_s2"])
    return dict(scene, solver={"backend": "cpu", "sleep_speed_m_per_s": 0.0})


def error_of(place, scene, truth):
    """Returns the mean error of the scene's equilibrium against CalculiX's displacements, and its number of nodes."""
    points, moved = np.array(truth["points_m"]), truth["largest_m"] * np.array(truth["moved"])
    answer = runs.simulate(place, "settle", scene, points=points)
    return solids.compare(answer["moved"], moved)["mean"], answer["nodes"]


def swept(place, scene, sessions, seconds):
    """Runs sessions by `viscera sweep`; returns its time by the clock [s] and the state hashes of the runs."""
    (place.work / "swept.yaml").write_text(json.dumps(scene))
    plan = {"scene": "swept.yaml", "seconds": seconds, "list": [{"name": "run %d" % k} for k in range(sessions)]}
    (place.work / "plan.yaml").write_text(json.dumps(plan))
    out = place.work / ("sweep_%d" % time.monotonic_ns())
    begun = time.monotonic()
    done = subprocess.run([str(place.build / "viscera"), "sweep", str(place.work / "plan.yaml"), "--out", str(out)],
                          capture_output=True, text=True, check=False)
    seconds_of_clock = time.monotonic() - begun
    if done.returncode:
        raise RuntimeError("viscera sweep: " + done.stderr[-1500:])
    with open(out / "results.csv", newline="") as table:
        lines = list(csv.DictReader(table))[1:]  # without the units
    return seconds_of_clock, [line["state_hash"] for line in lines]


def vector(place, scene, sessions, ticks, clock_s):
    """Returns seconds of the clock of a tick of all sessions of a VectorSession, its length [s] and the hashes after
    `ticks`. @param clock_s: time after which a measurement ends"""
    return runs.simulate(place, "vector", scene, sessions=sessions, ticks=ticks, clock_s=clock_s)


def measure(place, spacings_m=SPACINGS_M):
    """Returns the results of the row: list of runs."""
    truth_of = json.loads(stored.FILE.read_text())
    truth, out = truth_of["bodies"][BODY], []
    for spacing_m in spacings_m:
        scene = scene_of(place, spacing_m, truth, truth_of["poisson_ratio"])
        mean, nodes = error_of(place, scene, truth)
        found = {"program": "viscera", "spacing_m": spacing_m, "nodes": nodes, "mean": mean, "vector": {}, "sweep": {}}
        for turn in range(TURNS):
            for sessions in SESSIONS:
                answer = vector(place, scene, sessions, 3, RUN_S)
                rate = nodes * sessions * answer["tick_s"] / answer["clock_s"]
                found["vector"][sessions] = max(rate, found["vector"].get(sessions, 0))
                runs.say("%.3g mm, VectorSession of %d: %.3g node-seconds a second" % (1e3 * spacing_m, sessions, rate))
        seconds = max(SMALL_S, round(SWEEP_S * found["vector"][1] / nodes, 2))
        for sessions in SESSIONS:
            clock_s, _ = swept(place, scene, sessions, seconds)
            found["sweep"][sessions] = nodes * sessions * seconds / clock_s
            runs.say("%.3g mm, sweep of %d: %.3g node-seconds a second" % (1e3 * spacing_m, sessions, found["sweep"][sessions]))
        out.append(found)
    return out


def check(place):
    """Compares the ways of running many sessions: all end in the same state, with the error that its spacing has. Returns
    the exit status."""
    truth_of = json.loads(stored.FILE.read_text())
    truth, wrong = truth_of["bodies"][BODY], 0
    scene = scene_of(place, SPACINGS_M[0], truth, truth_of["poisson_ratio"])
    mean, nodes = error_of(place, scene, truth)
    most = stored.LIMITS[BODY][0][0]
    ticks = round(SMALL_S / runs.TICK_S)
    hashes = set()
    for sessions in SMALL_SESSIONS:
        answer = vector(place, scene, sessions, ticks, 0)
        hashes.update(answer["hashes"])
        wrong += len(answer["hashes"]) != sessions or not answer["clock_s"] > 0
    _, of_sweep = swept(place, scene, SMALL_SESSIONS[-1], ticks * answer["tick_s"])
    hashes.update(of_sweep)
    wrong += len(of_sweep) != SMALL_SESSIONS[-1] or len(hashes) != 1 or abs(mean) > most
    runs.say("throughput: %d nodes, mean %+.2f %% (limit %.2f), state %s%s" %
             (nodes, 100 * mean, 100 * most, " and ".join(sorted(hashes)), ": MISSED" if wrong else ""))
    return 1 if wrong else 0


def rates(found):
    """Returns rates by number of sessions, in thousands. Keys are text where they come from a file."""
    return ", ".join("%.3g" % (found[k] / 1e3) for k in sorted(found, key=int))


def section(results):
    """Returns the lines of the page's section, without its title. @param results: {"machine", "runs"}"""
    bullet_nodes, bullet_cost, bullet_mean = BULLET
    out = ["Thousands of node-seconds of tissue (nodes times simulated seconds) per second of the clock, for %s sessions" %
           ", ".join(map(str, SESSIONS)),
           "at once on all processors: the cantilever above in motion. `viscera sweep` includes the start of each session.", "",
           "| spacing | nodes | error | `VectorSession` | `viscera sweep` |", "|---|---|---|---|---|"]
    for run in results["runs"]:
        out.append("| %g mm | %d | %+.1f %% | %s | %s |" %
                   (1e3 * run["spacing_m"], run["nodes"], 100 * run["mean"], rates(run["vector"]), rates(run["sweep"])))
    out += ["", "Others in the same unit: steps a second times their length times nodes. The published rates are of steps of 1/30 s that",
            "include a robot arm; the number of nodes is from another report, and no error is given.", "", "| program | body | nodes | sessions | rate | error | machine | source |", "|---|---|---|---|---|---|---|---|",
            "| Bullet, linear | the cantilever | %d | 1 | %.2g | %+.1f %% | one thread here | above |" %
            (bullet_nodes, bullet_nodes / bullet_cost / 1e3, 100 * bullet_mean)]
    for name, body, nodes, sessions, steps, step_s, machine, source in PEERS:
        out.append("| %s | %s | %d | %d | %.2g | unknown | %s | %s |" % (name, body, nodes, sessions, steps * step_s * nodes / 1e3, machine, source))
    return out + ["", "%(processor)s, %(threads)d threads, %(date)s, commit %(commit)s (`scripts/compare --only throughput`)." % results["machine"]]


def renew(path, results):
    """Replaces the section in the page, or adds it before the method."""
    path = pathlib.Path(path)
    text = path.read_text()
    made = "## %s\n\n%s\n\n" % (TITLE, "\n".join(section(results)))
    old = re.search(r"^## %s\n.*?(?=^## )" % TITLE, text, re.M | re.S)
    method = text.index("## How it was measured")
    path.write_text(text[:old.start()] + made + text[old.end():] if old else text[:method] + made + text[method:])
