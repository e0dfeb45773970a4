# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Environments with one session, or with several."""
import copy

import numpy as np

from .. import Scene, Session, Stylus, VectorSession
from .spaces import SAME_STEP, Box, Dict, Env, VectorEnv, batched

_PICTURES = ("rgb", "depth", "labels")
_OBSERVATIONS = ("poses", "forces", "points") + _PICTURES
_POINTS = 512  # vertices of the surface mesh, evenly spaced by index
_FARTHEST_M = 10.0
_UPRIGHT = (0, 0, 0, 1)


def _value(scene, key):
    """Returns the value of a scene key, given or default."""
    for line in scene.keys.splitlines():
        name, _, value = line.partition("=")
        if name == key:
            return float(value)
    raise KeyError(key)


class _Layout:
    """Data that all episodes of an environment share: the scene and the spaces."""

    def __init__(self, task, observations):
        unknown = [each for each in observations if each not in _OBSERVATIONS]
        if isinstance(observations, str) or unknown:
            raise ValueError(f"observations: must be some of {', '.join(_OBSERVATIONS)}; found {observations!r}")
        self.kinds = tuple(observations)
        self.scene = Scene(task.scene, task.overrides)
        if len(self.scene.styluses) != 1:
            raise ValueError(f"a task has one stylus; found {len(self.scene.styluses)}")
        self.low, self.high = np.array(task.low_m, float), np.array(task.high_m, float)
        self.ticks = round(1 / (self.scene.tick_s * task.control_hz))
        if self.ticks < 1 or abs(self.ticks * self.scene.tick_s * task.control_hz - 1) > 1e-9:
            raise ValueError(f"control_hz: must be a divisor of solver.tick_hz, {1 / self.scene.tick_s:g}; found {task.control_hz}")
        count = 3 if task.button is None else 4
        self.action_space = Box(-1.0, 1.0, (count,), np.float32)
        self.observation_space = self._space()

    def _space(self):
        most_n, most_nm = _value(self.scene, "styluses[0].max_force_n"), _value(self.scene, "styluses[0].max_torque_nm")
        self.most = np.array([most_n] * 3 + [most_nm] * 3, np.float32)
        spaces = {"goal": Box(-_FARTHEST_M, _FARTHEST_M, (3,), np.float32)}
        if "poses" in self.kinds:
            low = np.append(self.low, [-1] * 4)[None].astype(np.float32)
            spaces["poses"] = Box(low, np.append(self.high, [1] * 4)[None].astype(np.float32), dtype=np.float32)
        if "forces" in self.kinds:
            spaces["forces"] = Box(-self.most[None], self.most[None], dtype=np.float32)
        if "points" in self.kinds:
            spaces["points"] = Box(-_FARTHEST_M, _FARTHEST_M, (_POINTS, 3), np.float32)
        if set(self.kinds) & set(_PICTURES):
            if not self.scene.cameras:
                raise ValueError("observations: rgb, depth and labels need a camera, but the scene has none")
            w, h = (int(_value(self.scene, f"cameras[0].{side}_px")) for side in ("width", "height"))
            for kind, space in (("rgb", Box(0, 255, (h, w, 3), np.uint8)), ("labels", Box(0, 255, (h, w), np.uint8)),
                                ("depth", Box(0, np.inf, (h, w), np.float32))):
                if kind in self.kinds:
                    spaces[kind] = space
        return Dict(spaces)

    def bounded(self, values, key):
        space = self.observation_space[key]
        return np.clip(np.asarray(values, np.float32), space.low, space.high)


class _Episode:
    """Tip, task and reward of one session."""

    def __init__(self, layout, task, session):
        self.layout, self.task, self.session = layout, task, session
        self._points = None

    def begin(self, rng, options):
        """Begins an episode; the tissue is at rest."""
        task, options = self.task, dict(options or {})
        start = np.array(task.start_m, float) + rng.uniform(-task.start_spread_m, task.start_spread_m, 3)
        self.tip = np.clip(start, self.layout.low, self.layout.high)
        self.peak_n = 0.0
        self.force = np.zeros(6)
        task.begin(self.session, rng, options)

    def way(self, action):
        """Returns the positions of the tip during an action, (ticks, 3), and the buttons, (2,)."""
        action = np.asarray(action, float)
        if action.shape != self.layout.action_space.shape or not np.isfinite(action).all():
            raise ValueError(f"action: must be {self.layout.action_space.shape} finite numbers; found {action!r}")
        action = np.clip(action, -1, 1)
        to = np.clip(self.tip + self.task.step_m * action[:3], self.layout.low, self.layout.high)
        share = np.arange(1, self.layout.ticks + 1)[:, None] / self.layout.ticks
        way = self.tip + share * (to - self.tip)
        self.tip, self.peak_n = to, 0.0
        buttons = np.zeros(2, bool)
        if self.task.button is not None:
            buttons[self.task.button] = action[3] > 0
        self.pressed = bool(buttons.any())
        return way, buttons

    def felt(self, wrench):
        self.force = wrench
        self.peak_n = max(self.peak_n, float(np.linalg.norm(wrench[:3])))

    def judged(self):
        """Returns reward, terminated and info."""
        task, trips = self.task, self.session.diagnostics["roll_backs"]
        terms, done = task.judge(self.session, self.tip, self.force[:3], self.peak_n, self.pressed)
        failure = "instability" if trips else "force" if self.peak_n > task.most_n else ""
        terms["failure"] = -float(bool(failure))
        terms = {name: task.terms[name] * float(value) for name, value in terms.items()}
        info = {"reward_terms": terms, "peak_force_n": self.peak_n, "is_success": bool(done and not failure), "failure": failure}
        return float(sum(terms.values())), bool(done or failure), info

    def observed(self):
        layout, out = self.layout, {"goal": self.layout.bounded(self.task.goal(), "goal")}
        if "poses" in layout.kinds:
            out["poses"] = layout.bounded(np.append(self.tip, _UPRIGHT)[None], "poses")
        if "forces" in layout.kinds:
            out["forces"] = layout.bounded(self.force[None], "forces")
        if "points" in layout.kinds:
            skin = self.session.skin()
            if self._points is None:  # chosen once, so that they stay the same after cuts
                self._points = skin.used[np.linspace(0, len(skin.used) - 1, _POINTS).astype(int)]
            out["points"] = layout.bounded(skin.positions_m[self._points], "points")
        for kind in set(layout.kinds) & set(_PICTURES):
            out[kind] = self.session.picture(0, "color" if kind == "rgb" else kind)
        return dict(sorted(out.items()))


class TissueEnv(Env):
    """A task with Gymnasium's API. An action is the displacement of the tip along x, y and z, in units of the task's step_m,
    and the button if the task has one. All are -1 .. 1, and are clipped. The tip stays upright."""
    metadata = {"render_modes": ["rgb_array"], "render_fps": 20}

    def __init__(self, task, observations=("poses", "forces"), render_mode=None):
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode: must be None or 'rgb_array'; found {render_mode!r}")
        layout = _Layout(task, observations)
        self.task, self.render_mode = task, render_mode
        self.metadata = {**type(self).metadata, "render_fps": task.control_hz}
        self.action_space, self.observation_space = layout.action_space, layout.observation_space
        pictures = render_mode is not None or bool(set(observations) & set(_PICTURES))
        self.session = Session(layout.scene, pictures=pictures)
        self.scene = layout.scene
        self._episode = _Episode(layout, task, self.session)
        self._begun = False

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.session.reset()
        self._episode.begin(self.np_random, options)
        self._begun = True
        return self._episode.observed(), {}

    def step(self, action):
        if not self._begun:
            raise RuntimeError("step: call reset() first")
        episode = self._episode
        way, buttons = episode.way(action)
        for place in way:
            self.session.step([Stylus(place, _UPRIGHT, bool(buttons[0]), bool(buttons[1]))])
            episode.felt(self.session.wrenches[0])
        reward, terminated, info = episode.judged()
        return episode.observed(), reward, terminated, False, info

    def render(self):
        return self.session.picture(0, "color") if self.render_mode == "rgb_array" else None

    def close(self):
        self.session.close()


class VectorTissueEnv(VectorEnv):
    """Several sessions of a task, which one call steps on several CPU threads (see make_vec)."""
    metadata = {"render_modes": [], "autoreset_mode": SAME_STEP}

    def __init__(self, task, num_envs=1, observations=("poses", "forces"), max_episode_steps=None, threads=0):
        layout = _Layout(task, observations)
        if set(observations) & set(_PICTURES):
            raise ValueError("observations: pictures exist only for single environments; vectors of environments accept poses, forces, points")
        self.num_envs, self.scene = num_envs, layout.scene
        self.sessions = VectorSession(layout.scene, num_envs, threads)
        self.single_action_space, self.single_observation_space = layout.action_space, layout.observation_space
        self.action_space = batched(layout.action_space, num_envs)
        self.observation_space = batched(layout.observation_space, num_envs)
        self._ticks = layout.ticks
        self._limit = task.steps if max_episode_steps is None else max_episode_steps
        if self._limit < 1:
            raise ValueError(f"max_episode_steps: must be 1 or more; found {self._limit}")
        self._episodes = [_Episode(layout, copy.deepcopy(task), session) for session in self.sessions]
        self._rngs = None

    def reset(self, *, seed=None, options=None):
        """seed: the seed of the first session, and the following numbers for the others; or one seed for each."""
        if seed is not None or self._rngs is None:
            seeds = [None] * self.num_envs if seed is None else seed
            seeds = [seeds + i for i in range(self.num_envs)] if isinstance(seeds, (int, np.integer)) else list(seeds)
            if len(seeds) != self.num_envs:
                raise ValueError(f"seed: must be a number or a list of {self.num_envs} numbers; found {len(seeds)}")
            self._rngs = [np.random.default_rng(each) for each in seeds]
        self.sessions.reset()
        self._steps = np.zeros(self.num_envs, int)
        for episode, rng in zip(self._episodes, self._rngs):
            episode.begin(rng, options)
        return self._stacked([episode.observed() for episode in self._episodes]), {}

    def step(self, actions):
        if self._rngs is None:
            raise RuntimeError("step: call reset() first")
        if np.shape(actions) != self.action_space.shape or not np.isfinite(np.asarray(actions, float)).all():
            raise ValueError(f"actions: must be {self.action_space.shape} finite numbers; found shape {np.shape(actions)}")
        ways, buttons = zip(*(episode.way(action) for episode, action in zip(self._episodes, actions)))
        ways, buttons = np.array(ways), np.array(buttons)[:, None]
        for tick in range(self._ticks):
            self.sessions.step(ways[:, None, tick], buttons)
            for episode, wrench in zip(self._episodes, self.sessions.wrenches[:, 0]):
                episode.felt(wrench)
        rewards, terminated, infos = zip(*(episode.judged() for episode in self._episodes))
        observations = [episode.observed() for episode in self._episodes]
        terminated = np.array(terminated)
        self._steps += 1
        truncated = (self._steps >= self._limit) & ~terminated
        info = {key: np.array([each[key] for each in infos]) for key in ("peak_force_n", "is_success", "failure")}
        info["reward_terms"] = {name: np.array([each["reward_terms"][name] for each in infos]) for name in infos[0]["reward_terms"]}
        over = terminated | truncated
        if over.any():
            info["final_obs"], info["final_info"] = (np.full(self.num_envs, None, object) for _ in range(2))
            info["_final_obs"] = info["_final_info"] = over
            self.sessions.reset(over)
            self._steps[over] = 0
            for i in np.flatnonzero(over):
                info["final_obs"][i], info["final_info"][i] = observations[i], infos[i]
                self._episodes[i].begin(self._rngs[i], None)
                observations[i] = self._episodes[i].observed()
        return self._stacked(observations), np.array(rewards), terminated, truncated, info

    @staticmethod
    def _stacked(observations):
        return {key: np.stack([each[key] for each in observations]) for key in observations[0]}

    def close(self, **_):
        self.sessions.close()
