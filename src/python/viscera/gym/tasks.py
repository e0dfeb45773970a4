# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tasks: their scenes, initial poses of tools, and rewards."""
import copy

import numpy as np


class Task:
    """Base class of tasks with one tool. A derived task sets the values below and begin(), goal() and judge().

    scene       dict, as in viscera.Scene; solver.tick_hz is a multiple of control_hz
    terms       weights of the reward's terms, by name; judge() returns the terms, and the reward is their weighted sum
    """
    name = ""
    scene = {}
    steps = 100             # limit of an episode
    control_hz = 20
    step_m = 0.004          # largest displacement of the tip along an axis per action
    low_m, high_m = (-0.04, -0.04, -0.01), (0.04, 0.04, 0.06)  # bounds of the tip
    start_m, start_spread_m = (0, 0, 0.045), 0.005
    button = None           # 0 or 1: the button that is pressed if the last number of an action is above 0
    limit_n = 0.5           # force above which there is a cost
    most_n = 3              # force above which an episode has failed
    terms = {}

    def __init__(self, terms=None, overrides=None, **values):
        """terms: weights that replace the defaults; overrides: keys of the scene; values: attributes of the class, by name."""
        self.terms = dict(self.terms)
        for key, weight in (terms or {}).items():
            if key not in self.terms:
                raise ValueError(f"terms: must be some of {', '.join(self.terms)}; found {key!r}")
            self.terms[key] = float(weight)
        for key, value in values.items():
            if key.startswith("_") or not hasattr(type(self), key) or callable(getattr(type(self), key)):
                raise TypeError(f"{type(self).__name__} has no option {key!r}")
            setattr(self, key, value)
        self.scene = copy.deepcopy(self.scene)
        self.overrides = dict(overrides or {})
        self._calm = 0

    def begin(self, session, rng, options):
        """Begins an episode, after the tissue was reset."""
        self._calm = 0

    def goal(self):
        """Returns the current target of the tip, (3,) [m], which is part of the observations."""
        raise NotImplementedError

    def judge(self, session, tip_m, force_n, peak_n, pressed):
        """Returns the terms by name, and whether the task is done. Called after a step.
        force_n: (3,) force on the tip at the end of the step; peak_n: largest force in it."""
        raise NotImplementedError

    def _kept(self, good, steps=3):
        self._calm = self._calm + 1 if good else 0
        return self._calm >= steps

    def _over(self, peak_n):
        return max(0.0, peak_n / self.limit_n - 1)


def _point(options, key, default, low, high):
    value = np.asarray(options.get(key, default), float)
    if value.shape != np.shape(default) or not ((value >= low) & (value <= high)).all():
        raise ValueError(f"options: {key}: must be {np.shape(default)} within {low} .. {high}; found {options.get(key)!r}")
    return value


def _known(options, keys):
    unknown = sorted(set(options) - set(keys))
    if unknown:
        raise ValueError(f"options: must be some of {', '.join(keys)}; found {', '.join(map(str, unknown))}")


_CAMERA = {"name": "camera", "position_m": [0.05, -0.12, 0.09], "target_m": [0, 0, 0.01], "width_px": 96, "height_px": 96}
_SOLVER = {"backend": "auto", "threads": 1, "tick_hz": 60}


class Touch(Task):
    """Touch a target on a block for three steps, pressing no harder than the limit."""
    name = "touch"
    scene = {
        "name": "gym_touch",
        "bodies": [{"name": "tissue", "source": "box", "box_size_m": [0.06, 0.06, 0.03], "spacing_m": 0.006,
                    "material": {"young_modulus_pa": 10000, "density_kg_per_m3": 1000},
                    "fixed": [{"shape": "plane", "point_m": [0, 0, -0.012], "normal": [0, 0, 1]}]}],
        "styluses": [{"name": "tool", "probe": {"radius_m": 0.008}}],
        "cameras": [_CAMERA], "environment": {"gravity_m_per_s2": [0, 0, 0]}, "solver": _SOLVER,
    }
    steps = 60
    touch_n = 0.05          # least force of a touch
    radius_m = 0.006        # radius of the target, seen from above
    terms = {"distance": 1, "touch": 0.2, "force": 1, "time": 0.1, "success": 10, "failure": 10}
    _TOP_M, _REACH_M = 0.015, 0.018

    def begin(self, session, rng, options):
        super().begin(session, rng, options)
        _known(options, ["target_m"])
        drawn = rng.uniform(-self._REACH_M, self._REACH_M, 2)
        self._target = np.append(_point(options, "target_m", drawn, -self._REACH_M, self._REACH_M), self._TOP_M)

    def goal(self):
        return self._target

    def judge(self, session, tip_m, force_n, peak_n, pressed):
        off = np.linalg.norm(tip_m[:2] - self._target[:2])
        touches = off <= self.radius_m and np.linalg.norm(force_n) >= self.touch_n
        radius = self.scene["styluses"][0]["probe"]["radius_m"]
        away = np.linalg.norm(tip_m - self._target - [0, 0, radius])
        done = self._kept(touches and peak_n <= self.limit_n)
        return {"distance": -away / 0.05, "touch": float(touches), "force": -self._over(peak_n), "time": -1.0,
                "success": float(done)}, done


class LiftFlap(Task):
    """Take a flap by its free edge (grip: button 1) and lift the edge."""
    name = "lift_flap"
    scene = {
        "name": "gym_lift_flap",
        "bodies": [{"name": "flap", "source": "box", "box_size_m": [0.05, 0.03, 0.004], "spacing_m": 0.004,
                    "material": {"young_modulus_pa": 30000, "density_kg_per_m3": 1000},
                    "fixed": [{"shape": "box", "min_m": [-1, -1, -1], "max_m": [-0.019, 1, 1]}]}],
        "styluses": [{"name": "gripper", "idle": "none", "button1": "grab", "grab": {"radius_m": 0.006}}],
        "cameras": [_CAMERA], "environment": {"gravity_m_per_s2": [0, 0, 0]}, "solver": _SOLVER,
    }
    steps = 80
    button = 0
    start_m = (0.02, 0, 0.03)
    limit_n, most_n = 1.5, 4
    lift_m = 0.015
    terms = {"distance": 1, "height": 1, "force": 1, "time": 0.1, "success": 10, "failure": 10}

    def begin(self, session, rng, options):
        super().begin(session, rng, options)
        _known(options, [])
        rest = session.rest_m
        self._edge = np.flatnonzero(rest[:, 0] > np.nanmax(rest[:, 0]) - 0.001)
        self._rest = rest[self._edge].mean(0)
        self._now = self._rest

    def goal(self):
        return self._now

    def judge(self, session, tip_m, force_n, peak_n, pressed):
        self._now = session.positions_m[self._edge].astype(float).mean(0)
        height = self._now[2] - self._rest[2]
        done = self._kept(height >= self.lift_m and peak_n <= self.limit_n)
        return {"distance": -np.linalg.norm(tip_m - self._now) / 0.05, "height": float(np.clip(height / self.lift_m, 0, 1)),
                "force": -self._over(peak_n), "time": -1.0, "success": float(done)}, done


class CutLine(Task):
    """Cut a sheet along a line (blade: button 2). Springs cut off the line have a cost."""
    name = "cut_line"
    scene = {
        "name": "gym_cut_line",
        "bodies": [{"name": "sheet", "source": "sheet", "structure": "surface", "box_size_m": [0.08, 0.06, 0.001],
                    "spacing_m": 0.004, "thickness_m": 0.001, "bending_ratio": 0.05,
                    "material": {"young_modulus_pa": 20000, "density_kg_per_m3": 1000,
                                 "cut": {"toughness_j_per_m2": 20}},
                    "fixed": [{"shape": "box", "min_m": [-1, -1, -1], "max_m": [-0.037, 1, 1]},
                              {"shape": "box", "min_m": [0.037, -1, -1], "max_m": [1, 1, 1]}]}],
        "styluses": [{"name": "knife", "idle": "none", "button2": "cut", "cut": {"blade_length_m": 0.02}}],
        "cameras": [_CAMERA], "environment": {"gravity_m_per_s2": [0, 0, 0]}, "solver": _SOLVER,
    }
    steps = 120
    button = 1
    start_m = (-0.025, 0, 0.02)
    limit_n, most_n = 1, 4
    width_m = 0.004         # half width of the line: cuts within are on it
    depth_m = 0.005         # target depth of the tip below the sheet
    ahead_m = 0.006         # target distance ahead of the covered line: more than a spring
    terms = {"distance": 1, "on_path": 0.2, "off_path": 0.2, "covered": 10, "force": 1, "time": 0.1, "success": 10, "failure": 10}
    _LENGTH_M, _PARTS = 0.04, 20

    def begin(self, session, rng, options):
        super().begin(session, rng, options)
        _known(options, ["line"])  # y of its centre [m], angle to x [rad]
        most = np.array([0.01, 0.25])
        offset, angle = _point(options, "line", rng.uniform(-most, most), -most, most)
        self._along = np.array([np.cos(angle), np.sin(angle)])
        self._first = np.array([0, offset]) - 0.5 * self._LENGTH_M * self._along
        self._covered = np.zeros(self._PARTS, bool)
        self._cut, self._at, self._entered = 0, None, False

    def goal(self):
        """Returns a point before the line until the tip has reached it, then one ahead of the covered part."""
        at = -self.width_m
        if self._entered:
            part = self._PARTS if self._covered.all() else int(np.argmin(self._covered))
            at = part / self._PARTS * self._LENGTH_M + self.ahead_m
        return np.append(self._first + at * self._along, -self.depth_m)

    def judge(self, session, tip_m, force_n, peak_n, pressed):
        """Assigns the cuts of a step to the tip's position at its end. The line between two cuts on it counts as covered."""
        away = np.linalg.norm(tip_m - self.goal())
        self._entered |= away <= self.width_m
        way = tip_m[:2] - self._first
        at, off = way @ self._along, abs(way[0] * self._along[1] - way[1] * self._along[0])
        cut = session.diagnostics.get("springs_cut", 0)
        new, self._cut = cut - self._cut, cut
        on = pressed and off <= self.width_m and -2 * self.width_m <= at <= self._LENGTH_M + 2 * self.ahead_m
        before = self._covered.sum()
        if new and on and self._at is not None:
            middles = (np.arange(self._PARTS) + 0.5) / self._PARTS * self._LENGTH_M
            self._covered |= (middles >= min(at, self._at)) & (middles <= max(at, self._at))
        if new or not on or self._at is None:
            self._at = at if on else None
        done = bool(self._covered.all())
        return {"distance": -away / 0.05, "on_path": float(new if on else 0), "off_path": -float(0 if on else new),
                "covered": float(self._covered.sum() - before) / self._PARTS, "force": -self._over(peak_n), "time": -1.0,
                "success": float(done)}, done


TASKS = {task.name: task for task in (Touch, LiftFlap, CutLine)}
