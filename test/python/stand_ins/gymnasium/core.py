# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Env and Wrapper. A wrapper passes on the attributes of the API alone; others are those of env.unwrapped."""
import numpy as np


class Env:
    metadata = {"render_modes": []}
    render_mode = None
    spec = None
    _np_random = None

    def reset(self, *, seed=None, options=None):
        if seed is not None:
            self.np_random = np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed)))

    def step(self, action):
        raise NotImplementedError

    def render(self):
        raise NotImplementedError

    def close(self):
        pass

    @property
    def unwrapped(self):
        return self

    @property
    def np_random(self):
        if self._np_random is None:
            self.np_random = np.random.Generator(np.random.PCG64())
        return self._np_random

    @np_random.setter
    def np_random(self, value):
        self._np_random = value

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()
        return False


class Wrapper(Env):
    def __init__(self, env):
        if not isinstance(env, Env):
            raise AssertionError(f"a wrapper is for an Env; found {type(env)}")
        self.env = env

    action_space = property(lambda self: self.env.action_space)
    observation_space = property(lambda self: self.env.observation_space)
    metadata = property(lambda self: self.env.metadata)
    render_mode = property(lambda self: self.env.render_mode)
    spec = property(lambda self: self.env.spec)
    unwrapped = property(lambda self: self.env.unwrapped)
    np_random = property(lambda self: self.env.np_random)

    @property
    def _np_random(self):
        raise AttributeError("_np_random of a wrapper: use np_random, or unwrapped")

    def reset(self, *, seed=None, options=None):
        return self.env.reset(seed=seed, options=options)

    def step(self, action):
        return self.env.step(action)

    def render(self):
        return self.env.render()

    def close(self):
        return self.env.close()
