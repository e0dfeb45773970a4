# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The rules of Gymnasium's check_env: what raises an error there raises AssertionError here, what warns there warns here."""
import copy
import inspect
import warnings

import numpy as np

from ..core import Env
from ..spaces import Box, Dict, Space


def _require(condition, text):
    if not condition:
        raise AssertionError(text)


def _advise(condition, text):
    if not condition:
        warnings.warn(text)


def _boxes(space, what):
    """Yields the boxes of a space; all of it must be spaces."""
    _require(isinstance(space, Space), f"{what} space: no Space, but {type(space)}")
    if isinstance(space, Dict):
        _require(len(space) > 0, f"{what} space: an empty Dict")
        for each in space.values():
            yield from _boxes(each, what)
    else:
        yield space


def _check_space(space, what):
    for box in _boxes(space, what):
        _require(isinstance(box, Box), f"{what} space: the stand-in knows Box and Dict; found {type(box)}")
        _require(box.low.shape == box.shape and box.high.shape == box.shape, f"{what} space: bounds of another shape: {box}")
        _advise((box.low != box.high).all(), f"{what} space: equal bounds: {box}")
        _advise((box.low <= box.high).all(), f"{what} space: a lower bound above the upper: {box}")
        _advise(not np.isneginf(box.low).any() and not np.isposinf(box.high).any(), f"{what} space: infinite bounds: {box}")
        if what == "action":
            symmetric = (box.low == 0) | (np.abs(box.low) == np.abs(box.high))
            _advise(symmetric.all() and (box.low >= -1).all() and (box.high <= 1).all(), f"action space: not normalised: {box}")


def _check_observation(observation, space, where):
    """Checks types on the way down, then whether the whole is within the space."""
    if isinstance(space, Dict):
        _require(isinstance(observation, dict), f"{where}: no dict, but {type(observation)}")
        _require(observation.keys() == space.keys(), f"{where}: keys {list(observation)}, those of the space are {list(space)}")
        for key in space:
            _check_observation(observation[key], space[key], f"{where}[{key!r}]")
    else:
        _advise(isinstance(observation, np.ndarray), f"{where}: no array, but {type(observation)}")
        _advise(getattr(observation, "dtype", None) == space.dtype, f"{where}: not of {space.dtype}")
    _advise(observation in space, f"{where}: not within {space}")


def _equal(a, b):
    if type(a) is not type(b):
        return False
    if isinstance(a, dict):
        return a.keys() == b.keys() and all(_equal(a[key], b[key]) for key in a)
    if isinstance(a, np.ndarray):
        return a.shape == b.shape and a.dtype == b.dtype and np.allclose(a, b, atol=1e-5, equal_nan=True)
    return a == b


def _check_reset(env):
    parameters = inspect.signature(env.reset).parameters
    for name in ("seed", "options"):
        _require(name in parameters or "kwargs" in parameters, f"reset: takes no {name}")
    _advise("seed" not in parameters or parameters["seed"].default is None, "reset: seed is not None by default")
    _advise("return_info" not in parameters, "reset: return_info is of the past")
    _advise(not callable(getattr(env, "seed", None)), "seed(): of the past; seeds go to reset")
    result = env.reset()
    _require(isinstance(result, tuple) and len(result) == 2, f"reset: not (observation, info), but {type(result)}")
    _require(isinstance(result[1], dict), f"reset: info is no dict, but {type(result[1])}")
    _require(result[0] in env.observation_space, "reset: the observation is not within the space")
    _check_observation(result[0], env.observation_space, "reset")
    env.reset(options={})


def _check_seeds(env):
    first = env.reset(seed=123)[0]
    _require(env.unwrapped._np_random is not None, "reset: no generator after a seed; super().reset(seed=seed) makes it")
    generator = copy.deepcopy(env.unwrapped._np_random)
    second = env.reset(seed=123)[0]
    for observation in (first, second):
        _require(observation in env.observation_space, "reset: the observation is not within the space after a seed")
    # Gymnasium asks this of environments with a spec, and viscera of all
    _require(_equal(first, second), "reset: the same seed gives another observation")
    state = generator.bit_generator.state
    _require(env.unwrapped._np_random.bit_generator.state == state, "reset: the same seed gives another generator")
    env.reset(seed=456)
    _require(env.unwrapped._np_random.bit_generator.state != state, "reset: another seed gives the same generator")


def _check_step(env):
    env.reset()
    result = env.step(env.action_space.sample())
    _require(isinstance(result, tuple) and len(result) == 5, "step: not (observation, reward, terminated, truncated, info)")
    observation, reward, terminated, truncated, info = result
    _advise(isinstance(terminated, (bool, np.bool_)) and isinstance(truncated, (bool, np.bool_)), "step: terminated, truncated: no bool")
    _check_observation(observation, env.observation_space, "step")
    number = np.issubdtype(type(reward), np.integer) or np.issubdtype(type(reward), np.floating)
    _advise(number, f"step: the reward is no number, but {type(reward)}")
    _advise(not number or np.isfinite(reward), f"step: the reward is {reward}")
    _require(isinstance(info, dict), f"step: info is no dict, but {type(info)}")


def _check_render(env):
    modes, fps = env.metadata.get("render_modes"), env.metadata.get("render_fps")
    _advise(isinstance(modes, (list, tuple)) and all(isinstance(mode, str) for mode in modes), f"metadata: render_modes: {modes!r}")
    _advise(np.issubdtype(type(fps), np.integer) or np.issubdtype(type(fps), np.floating), f"metadata: render_fps: {fps!r}")
    _require(fps is None or fps > 0, f"metadata: render_fps: {fps!r}")
    _require(env.render_mode in modes, f"render_mode {env.render_mode!r} is none of {modes}")
    picture = env.render()
    _advise(isinstance(picture, np.ndarray) and picture.dtype == np.uint8 and picture.ndim == 3 and picture.shape[2] == 3,
            "render: rgb_array: no array (height, width, 3) of uint8")


def check_env(env, warn=None, skip_render_check=False):
    _require(isinstance(env, Env), f"no Env, but {type(env)}")
    _advise(env.unwrapped is env, "check_env is for the environment without its wrappers: env.unwrapped")
    for what in ("action", "observation"):
        _require(hasattr(env, f"{what}_space"), f"no {what} space")
        _check_space(getattr(env, f"{what}_space"), what)
    _check_reset(env)
    _check_seeds(env)
    _check_step(env)
    if not skip_render_check and env.render_mode is not None:
        _check_render(env)
