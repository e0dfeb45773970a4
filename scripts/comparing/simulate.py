#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs one session of viscera for scripts/compare: reads a job as JSON from standard input, writes its answer as JSON.

Processor times are those of Session.step() alone. Needs viscera's Python package.
"""
import json
import sys
import time

import numpy as np
import viscera


def opened(scene, **solver):
    """Returns a session of a scene, with further keys of `solver`; it draws if the scene has cameras."""
    scene = dict(scene, solver={"threads": 1, "sleep_speed_m_per_s": 0.0, **scene.get("solver", {}), **solver})
    return viscera.Session(viscera.Scene(scene), pictures=bool(scene.get("cameras")))


def vertices(session):
    """Returns the positions of the surface mesh [m], as a copy in float64."""
    return session.skin().positions_m.astype(float)


def nearest(positions, points):
    """Returns the number of the closest position to each point, and the largest distance [m]."""
    out = np.empty(len(points), int)
    largest = 0.0
    for first in range(0, len(points), 256):
        apart = ((points[first:first + 256, None, :] - positions[None, :, :]) ** 2).sum(-1)
        out[first:first + 256] = apart.argmin(1)
        largest = max(largest, float(np.sqrt(apart.min(1).max())))
    return out, largest


def skin(job):
    """Returns the surface mesh at rest."""
    with opened(job["scene"]) as session:
        mesh = session.skin()
        return {"at": mesh.positions_m.astype(float).tolist(), "triangles": mesh.triangles.astype(int).tolist()}


def settle(job):
    """Returns the displacement of points of the surface in equilibrium with weight [m], and what finding it took [s]."""
    with opened(job["scene"]) as session:
        rest = vertices(session)
    begun = time.process_time()
    with opened(job["scene"], start="equilibrium") as session:
        seconds = time.process_time() - begun
        chosen, far = nearest(rest, np.load(job["points"]))
        moved = (vertices(session) - rest)[chosen]
        np.save(job["moved"], moved)
        return {"nodes": session.diagnostics["nodes"], "seconds": seconds, "far": far}


def cost(job):
    """Returns the processor time of a simulated second under weight, which begins to act at the start [s/s]."""
    with opened(job["scene"]) as session:
        session.step(n=job.get("before", 3))
        ticks, begun = job["ticks"], time.process_time()
        session.step(n=ticks)
        seconds = time.process_time() - begun
        return {"nodes": session.diagnostics["nodes"], "cost": seconds / (ticks * session.tick_s),
                "dt_s": session.diagnostics["dt_s"]}


def vector(job):
    """Steps sessions side by side, each from rest under its weight: their state hashes after job["ticks"], the length of a
    tick, and how long a tick of all of them takes by the clock, over job["clock_s"] at least [s]."""
    with viscera.VectorSession(viscera.Scene(job["scene"]), job["sessions"]) as sessions:
        begun, ticks = time.monotonic(), job["ticks"]
        sessions.step(n=ticks)
        taken, hashes = time.monotonic() - begun, list(sessions.hashes)
        while taken < job["clock_s"]:  # the pace is unknown at the start
            ticks = max(ticks, int(ticks * job["clock_s"] / taken) + 1)
            begun = time.monotonic()
            sessions.step(n=ticks)
            taken = time.monotonic() - begun
        return {"hashes": hashes, "tick_s": sessions[0].tick_s, "clock_s": taken / ticks}


def straight(begin, end, ticks):
    """Returns positions of styluses at each tick on the way to their end."""
    begin, end = np.array(begin, float), np.array(end, float)
    return [(begin + (end - begin) * (k + 1) / ticks).tolist() for k in range(ticks)]


def drive(job):
    """Moves styluses through phases and reads what each feels at the end of a phase.

    job["begin"]: a pose per stylus (position [m], perhaps quaternion); job["phases"]: list of {"to": positions, "ticks",
    "hold"}, or with "path", poses at each tick, in place of both. Returns for each phase the mean force and torque over the
    last third of its hold [N, N m], and the displacement of points if there are some. job["picture"] is the file for what the
    camera shows after the phase job["shown"].
    """
    with opened(job["scene"]) as session:
        rest = vertices(session)
        chosen = nearest(rest, np.load(job["points"]))[0] if "points" in job else None
        put = lambda poses: [viscera.Stylus(pose[:3], *([pose[3:]] if len(pose) > 3 else [])) for pose in poses]
        last = job["begin"]
        session.step(put(last))
        out, moved, used, ticks = [], [], 0.0, 0
        for number, phase in enumerate(job["phases"]):
            path = phase["path"] if "path" in phase else straight(last, phase["to"], phase["ticks"])
            last, felt, begun = path[-1], [], time.process_time()
            for poses in path:
                session.step(put(poses))
            for _ in range(phase["hold"]):
                session.step(put(last))
                felt.append(session.wrenches.copy())
            used, ticks = used + time.process_time() - begun, ticks + len(path) + phase["hold"]
            out.append(np.mean(felt[-max(1, len(felt) // 3):], 0).tolist())
            if number == job.get("shown"):
                np.save(job["picture"], session.picture())
            if chosen is not None:
                moved.append((vertices(session) - rest)[chosen])
        if moved:
            np.save(job["moved"], np.array(moved))
        said = session.diagnostics
        return {"nodes": said["nodes"], "forces": out, "cost": used / (ticks * session.tick_s), "roll_backs": said["roll_backs"],
                "inverted": said["cells_inverted"], "speed": said["speed_now_m_per_s"]}


def swing(job):
    """Returns the mean displacement of the nodes in each box of job["seen"] over time [m]: (ticks, boxes, 3).

    With job["pull"], two positions, a stylus grabs at the first, moves to the second in job["pull_ticks"] and lets go.
    """
    with opened(job["scene"]) as session:
        rest = session.rest_m[session.nodes]
        seen = [session.nodes[((rest >= low) & (rest <= high)).all(1)] for low, high in np.array(job["seen"], float)]
        if "pull" in job:
            begin, end = np.array(job["pull"], float)
            session.step(viscera.Stylus(begin.tolist(), button1=True))
            for k in range(job["pull_ticks"]):
                session.step(viscera.Stylus((begin + (end - begin) * (k + 1) / job["pull_ticks"]).tolist(), button1=True))
        out = []
        for _ in range(job["ticks"]):
            session.step()
            out.append([session.displacement_m[slots].astype(float).mean(0) for slots in seen])
        np.save(job["moved"], np.array(out))
        return {"nodes": session.diagnostics["nodes"], "seen": [len(slots) for slots in seen]}


def main():
    """Runs the job."""
    job = json.load(sys.stdin)
    print(json.dumps({"skin": skin, "settle": settle, "cost": cost, "drive": drive, "swing": swing, "vector": vector}[job["kind"]](job)))


if __name__ == "__main__":
    sys.exit(main())
