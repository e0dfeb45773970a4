# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks that an environment fulfils Gymnasium's contract."""
import numpy as np

from .spaces import HAVE_GYMNASIUM


class ContractError(AssertionError):
    pass


def _require(condition, text):
    if not condition:
        raise ContractError(text)


def _same(a, b):
    return a.keys() == b.keys() and all(np.array_equal(a[key], b[key]) for key in a)


def _played(env, seed, actions):
    """Plays an episode and checks every step. Returns its observations and rewards."""
    out = env.reset(seed=seed)
    _require(isinstance(out, tuple) and len(out) == 2 and isinstance(out[1], dict), "reset: must be (observation, info)")
    observations, rewards = [out[0]], []
    for action in actions:
        out = env.step(action)
        _require(isinstance(out, tuple) and len(out) == 5, "step: must be (observation, reward, terminated, truncated, info)")
        observation, reward, terminated, truncated, info = out
        _require(isinstance(reward, float) and np.isfinite(reward), f"step: reward: must be a finite float; found {reward!r}")
        _require(isinstance(terminated, bool) and isinstance(truncated, bool), "step: terminated, truncated: must be bool")
        _require(not (terminated and truncated), "step: terminated and truncated at once")
        _require(isinstance(info, dict), "step: info: must be a dict")
        if "reward_terms" in info:
            _require(abs(sum(info["reward_terms"].values()) - reward) <= 1e-9 * (1 + abs(reward)),
                     "step: info: reward_terms: must be terms that sum up to the reward")
        observations.append(observation)
        rewards.append(reward)
        if terminated or truncated:
            break
    for observation in observations:
        _require(env.observation_space.contains(observation), f"observation outside of {env.observation_space}")
    return observations, rewards


def check(env, steps=50, seed=1):
    """Raises ContractError if env violates Gymnasium's contract. Also runs Gymnasium's check_env if it is installed."""
    for space in (env.observation_space, env.action_space):
        _require(space.contains(space.sample()), f"{space} does not contain its sample")
    _require(np.isfinite(env.action_space.low).all() and np.isfinite(env.action_space.high).all(), "actions: must have finite bounds")
    env.action_space.seed(seed)
    actions = [env.action_space.sample() for _ in range(steps)]
    one, other = _played(env, seed, actions), _played(env, seed, actions)
    _require(len(one[0]) == len(other[0]) and all(map(_same, one[0], other[0])) and one[1] == other[1],
             "the same seed and actions gave another episode")
    first, second = env.reset(seed=seed + 1)[0], env.reset()[0]
    _require(not (_same(first, one[0][0]) and _same(second, first)), "seeds change nothing")
    if env.render_mode == "rgb_array":
        picture = env.render()
        _require(picture.ndim == 3 and picture.shape[2] == 3 and picture.dtype == np.uint8, "render: must be (h, w, 3) uint8")
    if HAVE_GYMNASIUM:
        from gymnasium.utils.env_checker import check_env
        check_env(env.unwrapped, skip_render_check=env.render_mode is None)
