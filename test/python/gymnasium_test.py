#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""viscera.gym where Gymnasium is installed: its classes, and the rules of its check_env. Usage: gymnasium_test.py [--real]

Debian has no package of Gymnasium: test/python/stand_ins takes its place. With --real it is the Gymnasium that is installed.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import warnings
from unittest import mock

if "--real" in sys.argv:
    sys.argv.remove("--real")
else:
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "stand_ins"))
import gymnasium  # noqa: E402  of the stand-ins, or what is installed
import numpy as np  # noqa: E402
from gymnasium.utils import env_checker  # noqa: E402
from gymnasium.vector import AutoresetMode, VectorEnv  # noqa: E402

import viscera  # noqa: E402
from viscera import gym  # noqa: E402

EPISODE = """
import hashlib, numpy, viscera
from viscera import gym
env, digest = gym.make("touch", observations=("poses", "forces", "points")), hashlib.sha256()
rng = numpy.random.default_rng(4)
for part in [env.reset(seed=3)[0]] + [env.step(rng.uniform(-1, 1, 3).astype("float32"))[0] for _ in range(5)]:
    for key in sorted(part):
        digest.update(part[key].tobytes())
print(gym.spaces.HAVE_GYMNASIUM, digest.hexdigest())
"""


def told(env, **options):
    """Returns the texts of what check_env advises; its errors are AssertionError."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        env_checker.check_env(env, **options)
    return [str(each.message) for each in found]


class Spoilt(gym.TissueEnv):
    """An environment with one thing wrong: a function that takes what reset or step returns."""

    def __init__(self, of_reset=None, of_step=None):
        super().__init__(gym.Touch())
        self.of_reset, self.of_step = of_reset or (lambda out: out), of_step or (lambda out: out)

    def reset(self, *, seed=None, options=None):
        return self.of_reset(super().reset(seed=seed, options=options))

    def step(self, action):
        return self.of_step(super().step(action))


class Signature(Spoilt):
    def reset(self, *, seed=None):
        return super().reset(seed=seed)


class OwnSeed(Spoilt):
    def reset(self, *, seed=None, options=None):
        return super().reset(seed=None, options=options)


class WithoutSpace(Spoilt):
    def __init__(self):
        super().__init__()
        del self.action_space


class WithSpace(Spoilt):
    def __init__(self, low, high, dtype=np.float32):
        super().__init__()
        self.action_space = gymnasium.spaces.Box(low, high, (3,), dtype)


def goal(observation, value):
    return {**observation, "goal": value}


def spoilt():
    """Yields (name, environment, whether it is an error): each breaks one rule."""
    far = np.full(3, 11, np.float32)
    yield "reset without info", Spoilt(of_reset=lambda out: out[0]), True
    yield "reset with a list", Spoilt(of_reset=lambda out: (out[0], [])), True
    yield "reset outside of the space", Spoilt(of_reset=lambda out: (goal(out[0], far), out[1])), True
    yield "reset without a key", Spoilt(of_reset=lambda out: ({"goal": out[0]["goal"]}, out[1])), True
    yield "reset with another type", Spoilt(of_reset=lambda out: (goal(out[0], out[0]["goal"].astype(float)), out[1])), True
    yield "reset without options", Signature(), True
    yield "reset that forgets its seed", OwnSeed(), True
    yield "step of four", Spoilt(of_step=lambda out: out[:3] + out[4:]), True
    yield "step without info", Spoilt(of_step=lambda out: out[:4] + (None,)), True
    yield "step without a key", Spoilt(of_step=lambda out: ({},) + out[1:]), True
    yield "step outside of the space", Spoilt(of_step=lambda out: (goal(out[0], far),) + out[1:]), False
    yield "step with a reward in words", Spoilt(of_step=lambda out: (out[0], "good") + out[2:]), False
    yield "step with no finite reward", Spoilt(of_step=lambda out: (out[0], float("nan")) + out[2:]), False
    yield "step with a number for terminated", Spoilt(of_step=lambda out: out[:2] + (0,) + out[3:]), False
    yield "no action space", WithoutSpace(), True
    yield "actions beyond 1", WithSpace(-2.0, 2.0), False
    yield "actions to one side", WithSpace(-0.5, 1.0), False
    yield "actions without bounds", WithSpace(-np.inf, np.inf), False


class GymnasiumTest(unittest.TestCase):
    def test_uses_its_classes(self):
        self.assertTrue(gym.spaces.HAVE_GYMNASIUM)
        env = gym.make("touch")
        for each in (env, env.unwrapped):
            self.assertIsInstance(each, gymnasium.Env)
        self.assertIsInstance(env.observation_space, gymnasium.spaces.Dict)
        self.assertIsInstance(env.action_space, gymnasium.spaces.Box)
        env.close()

    def test_check_env_has_nothing_to_say(self):
        for task in gym.TASKS:
            env = gym.make(task, observations=("poses", "forces", "points")).unwrapped
            self.assertEqual([text for text in told(env) if "spec" not in text], [], task)
            env.close()

    def test_check_env_of_pictures(self):
        """A depth has no upper bound, which is advice and no rule."""
        try:
            env = gym.make("touch", observations=("poses", "rgb", "depth", "labels"), render_mode="rgb_array").unwrapped
        except viscera.GpuError as error:
            self.skipTest(str(error))
        advice = [text for text in told(env) if "spec" not in text]
        self.assertEqual([text for text in advice if "infinit" not in text], [])
        env.close()

    def test_check_env_finds_what_is_wrong(self):
        for name, env, error in spoilt():
            with self.subTest(name):
                if error:
                    with self.assertRaises(Exception):
                        told(env)
                else:
                    self.assertNotEqual([text for text in told(env) if "spec" not in text], [])
            env.close()

    def test_check_runs_check_env(self):
        with mock.patch.object(env_checker, "check_env", wraps=env_checker.check_env) as called:
            env = gym.make("touch", max_episode_steps=5)
            gym.check(env, steps=5)
        called.assert_called_once()
        self.assertIs(called.call_args.args[0], env.unwrapped)
        env.close()

    def test_wrappers(self):
        with tempfile.TemporaryDirectory() as folder:
            env = gym.RealTime(gym.Recorder(gym.make("touch", max_episode_steps=3), folder))
            observation, info = env.reset(seed=2)
            self.assertIn(observation, env.observation_space)
            while True:
                _, _, terminated, truncated, _ = env.step(env.action_space.sample())
                if terminated or truncated:
                    break
            self.assertTrue(truncated)
            env.close()
            self.assertEqual(os.listdir(folder), ["episode_000000.npz"])

    def test_vector(self):
        many = gym.make_vec("touch", 2, max_episode_steps=2)
        self.assertIsInstance(many, VectorEnv)
        self.assertIs(many.metadata["autoreset_mode"], AutoresetMode.SAME_STEP)
        observation, info = many.reset(seed=1)
        self.assertIn(observation, many.observation_space)
        for _ in range(3):
            observation, rewards, terminated, truncated, info = many.step(many.action_space.sample())
            self.assertIn(observation, many.observation_space)
            self.assertEqual((rewards.shape, terminated.dtype, truncated.dtype), ((2,), bool, bool))
        many.close()

    def test_episodes_are_those_without_it(self):
        here = os.pathsep.join(sys.path[:1] + [os.environ.get("PYTHONPATH", "")])
        runs = [subprocess.run([sys.executable, "-c", EPISODE], env={**os.environ, "PYTHONPATH": path}, check=True, timeout=300,
                               capture_output=True, text=True).stdout.split() for path in (here, os.environ.get("PYTHONPATH", ""))]
        self.assertEqual(runs[0][0], "True")
        self.assertEqual(runs[0][1], runs[1][1])


if __name__ == "__main__":
    unittest.main()
