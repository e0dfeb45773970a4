# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Wrappers of environments: a limit of steps, real time, a file per episode."""
import os
import time

import numpy as np

from .spaces import Wrapper


class TimeLimit(Wrapper):
    """Truncates episodes after max_episode_steps steps."""

    def __init__(self, env, max_episode_steps):
        if max_episode_steps < 1:
            raise ValueError(f"max_episode_steps: must be 1 or more; found {max_episode_steps}")
        super().__init__(env)
        self._limit, self._steps = max_episode_steps, 0

    def reset(self, *, seed=None, options=None):
        self._steps = 0
        return self.env.reset(seed=seed, options=options)

    def step(self, action):
        observation, reward, terminated, truncated, info = self.env.step(action)
        self._steps += 1
        return observation, reward, terminated, truncated or (self._steps >= self._limit and not terminated), info


class RealTime(Wrapper):
    """Delays steps to at least their simulated duration, for human viewers and users."""

    def reset(self, *, seed=None, options=None):
        out = self.env.reset(seed=seed, options=options)
        self._next = time.monotonic()
        return out

    def step(self, action):
        out = self.env.step(action)
        now = time.monotonic()
        self._next = max(self._next + 1 / self.unwrapped.task.control_hz, now)
        time.sleep(self._next - now)
        return out


class Recorder(Wrapper):
    """Writes every episode that ends, or that reset() or close() interrupts, to a file in a folder: episode_000000.npz and
    so on. A file has actions, rewards, terms_NAME, terminated, truncated, seed (-1: none), scene, and observations_NAME
    with one row more than actions."""

    def __init__(self, env, folder):
        super().__init__(env)
        os.makedirs(folder, exist_ok=True)
        self._folder = folder
        self._episode = 0
        while os.path.exists(self._file()):
            self._episode += 1
        self._rows = None

    def _file(self):
        return os.path.join(self._folder, f"episode_{self._episode:06d}.npz")

    def reset(self, *, seed=None, options=None):
        self._write()
        observation, info = self.env.reset(seed=seed, options=options)
        self._rows, self._seed, self._first = [], -1 if seed is None else seed, observation
        return observation, info

    def step(self, action):
        out = self.env.step(action)
        if self._rows is not None:
            self._rows.append((np.array(action, np.float32), *out))
        if out[2] or out[3]:
            self._write()
        return out

    def _write(self):
        rows, self._rows = self._rows, None
        if not rows:
            return
        actions, observations, rewards, terminated, truncated, infos = zip(*rows)
        arrays = {"actions": np.array(actions), "rewards": np.array(rewards), "terminated": terminated[-1],
                  "truncated": truncated[-1], "seed": self._seed, "scene": self.unwrapped.scene.keys}
        for key in self._first:
            arrays[f"observations_{key}"] = np.stack([self._first[key]] + [each[key] for each in observations])
        for name in infos[0]["reward_terms"]:
            arrays[f"terms_{name}"] = np.array([info["reward_terms"][name] for info in infos])
        draft = self._file() + ".draft"
        with open(draft, "wb") as file:
            np.savez_compressed(file, **arrays)
        os.replace(draft, self._file())
        self._episode += 1

    def close(self):
        self._write()
        self.env.close()
