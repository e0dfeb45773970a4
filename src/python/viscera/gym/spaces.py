# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Spaces and base classes: Gymnasium's if it is installed, otherwise the parts that are needed here."""
import numpy as np

try:
    from gymnasium import Env, Wrapper, spaces
    from gymnasium.vector import VectorEnv
    Box, Dict = spaces.Box, spaces.Dict
    HAVE_GYMNASIUM = True
    try:  # from 1.1 on
        from gymnasium.vector import AutoresetMode
        SAME_STEP = AutoresetMode.SAME_STEP
    except ImportError:
        SAME_STEP = "SameStep"
except ImportError:
    HAVE_GYMNASIUM = False
    SAME_STEP = "SameStep"

    class Space:
        def __init__(self, seed=None):
            self.seed(seed)

        def seed(self, seed=None):
            self._rng = np.random.default_rng(seed)

    class Box(Space):
        """Arrays of one shape and type within bounds."""

        def __init__(self, low, high, shape=None, dtype=np.float32, seed=None):
            self.shape = tuple(shape if shape is not None else np.shape(low))
            self.dtype = np.dtype(dtype)
            self.low = np.broadcast_to(np.asarray(low, self.dtype), self.shape)
            self.high = np.broadcast_to(np.asarray(high, self.dtype), self.shape)
            super().__init__(seed)

        def contains(self, x):
            return (isinstance(x, np.ndarray) and x.shape == self.shape and x.dtype == self.dtype
                    and bool((x >= self.low).all() and (x <= self.high).all()))

        __contains__ = contains

        def sample(self):
            low = np.where(np.isfinite(self.low), self.low.astype(float), -1)
            high = np.where(np.isfinite(self.high), self.high.astype(float), np.maximum(low, 1))
            whole = self.dtype.kind in "iu"
            return (self._rng.integers(low.astype(int), high.astype(int), self.shape, endpoint=True) if whole
                    else self._rng.uniform(low, high)).astype(self.dtype)

        def __eq__(self, other):
            return (isinstance(other, Box) and self.shape == other.shape and self.dtype == other.dtype
                    and np.array_equal(self.low, other.low) and np.array_equal(self.high, other.high))

        def __repr__(self):
            return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"

    class Dict(Space):
        """Spaces by name."""

        def __init__(self, spaces, seed=None):
            self.spaces = dict(sorted(spaces.items()))
            super().__init__(seed)

        def seed(self, seed=None):
            super().seed(seed)
            for space in self.spaces.values():
                space.seed(None if seed is None else int(self._rng.integers(2 ** 31)))

        def contains(self, x):
            return (isinstance(x, dict) and x.keys() == self.spaces.keys()
                    and all(self.spaces[key].contains(x[key]) for key in x))

        __contains__ = contains

        def sample(self):
            return {key: space.sample() for key, space in self.spaces.items()}

        def __getitem__(self, key):
            return self.spaces[key]

        def __iter__(self):
            return iter(self.spaces)

        def keys(self):
            return self.spaces.keys()

        def items(self):
            return self.spaces.items()

        def __eq__(self, other):
            return isinstance(other, Dict) and self.spaces == other.spaces

        def __repr__(self):
            return f"Dict({self.spaces})"

    class Env:
        metadata = {"render_modes": []}
        render_mode = None
        spec = None
        _np_random = None

        def reset(self, *, seed=None, options=None):
            if seed is not None:
                self._np_random = np.random.default_rng(seed)

        @property
        def np_random(self):
            if self._np_random is None:
                self._np_random = np.random.default_rng()
            return self._np_random

        @property
        def unwrapped(self):
            return self

        def close(self):
            pass

        def __enter__(self):
            return self

        def __exit__(self, *args):
            self.close()

    VectorEnv = Env

    class Wrapper(Env):
        """Forwards everything to the wrapped environment."""

        def __init__(self, env):
            self.env = env

        def __getattr__(self, name):
            if name.startswith("_"):
                raise AttributeError(name)
            return getattr(self.env, name)

        metadata = property(lambda self: self.env.metadata)
        render_mode = property(lambda self: self.env.render_mode)
        np_random = property(lambda self: self.env.np_random)
        unwrapped = property(lambda self: self.env.unwrapped)

        def reset(self, *, seed=None, options=None):
            return self.env.reset(seed=seed, options=options)

        def step(self, action):
            return self.env.step(action)

        def render(self):
            return self.env.render()

        def close(self):
            self.env.close()


def batched(space, n):
    """Returns the space of n such values, stacked along the leading axis."""
    if isinstance(space, Dict):
        return Dict({key: batched(each, n) for key, each in space.items()})
    return Box(np.repeat(space.low[None], n, 0), np.repeat(space.high[None], n, 0), dtype=space.dtype)
