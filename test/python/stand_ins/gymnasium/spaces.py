# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Box and Dict. A Box that would lose precision by a cast of its bounds warns, as Gymnasium's does."""
import warnings
from collections.abc import Mapping

import numpy as np


class Space:
    def __init__(self, shape=None, dtype=None, seed=None):
        self._shape, self.dtype = shape, dtype
        self.seed(seed)

    @property
    def shape(self):
        return self._shape

    def seed(self, seed=None):
        self.np_random = np.random.default_rng(seed)
        return seed

    def __contains__(self, x):
        return self.contains(x)


class Box(Space):
    def __init__(self, low, high, shape=None, dtype=np.float32, seed=None):
        dtype = np.dtype(dtype)
        if shape is None:
            shape = np.shape(low) if isinstance(low, np.ndarray) else np.shape(high) if isinstance(high, np.ndarray) else (1,)
        self.low, self.high = self._bound(low, shape, dtype), self._bound(high, shape, dtype)
        super().__init__(tuple(int(side) for side in shape), dtype, seed)

    @staticmethod
    def _bound(value, shape, dtype):
        if not isinstance(value, np.ndarray):
            if not np.isscalar(value):
                raise AssertionError(f"a bound is a number or an array; found {type(value)}")
            return np.full(shape, value, dtype)
        if value.shape != tuple(shape):
            raise AssertionError(f"a bound has shape {value.shape}, the space {shape}")
        if value.dtype.kind == "f" and value.dtype.itemsize > dtype.itemsize:
            warnings.warn(f"Box: bounds lose precision as {dtype}")
        return value.astype(dtype)

    def contains(self, x):
        if not isinstance(x, np.ndarray):
            warnings.warn(f"Box: a value should be an array; found {type(x)}")
            x = np.asarray(x)
        return bool(np.can_cast(x.dtype, self.dtype) and x.shape == self.shape and (x >= self.low).all() and (x <= self.high).all())

    def sample(self):
        free = ~(np.isfinite(self.low) & np.isfinite(self.high))
        low, high = np.where(free, 0, self.low.astype(float)), np.where(free, 1, self.high.astype(float))
        if self.dtype.kind in "iu":
            return self.np_random.integers(low.astype(int), high.astype(int), endpoint=True).astype(self.dtype)
        return np.clip(self.np_random.uniform(low, high).astype(self.dtype), self.low, self.high)

    def __eq__(self, other):
        return (isinstance(other, Box) and self.shape == other.shape and np.allclose(self.low, other.low)
                and np.allclose(self.high, other.high))

    def __repr__(self):
        return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"


class Dict(Space, Mapping):
    def __init__(self, spaces, seed=None):
        wrong = [key for key, space in spaces.items() if not isinstance(space, Space)]
        if wrong:
            raise AssertionError(f"Dict: no spaces: {wrong}")
        self.spaces = {key: spaces[key] for key in sorted(spaces)}
        super().__init__(None, None, seed)

    def seed(self, seed=None):
        super().seed(seed)
        return {key: space.seed(None if seed is None else int(self.np_random.integers(2 ** 31)))
                for key, space in self.spaces.items()}

    def contains(self, x):
        return isinstance(x, dict) and x.keys() == self.spaces.keys() and all(self.spaces[key].contains(x[key]) for key in x)

    def __contains__(self, x):
        return self.contains(x)

    def sample(self):
        return {key: space.sample() for key, space in self.spaces.items()}

    def __getitem__(self, key):
        return self.spaces[key]

    def __iter__(self):
        return iter(self.spaces)

    def __len__(self):
        return len(self.spaces)

    def __eq__(self, other):
        return isinstance(other, Dict) and self.spaces == other.spaces

    def __repr__(self):
        return f"Dict({self.spaces})"
