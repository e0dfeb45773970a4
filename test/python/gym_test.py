#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Environments by Gymnasium's API, with Gymnasium or without."""
import os
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np

import viscera
from viscera import gym


def toward(goal, tip, most=1.0):
    return np.clip((goal - tip) / 0.004, -most, most)


def touching(step, goal, tip, force_n):
    """Above the target, then down until it is felt."""
    action = toward(goal, tip)
    beside = np.linalg.norm((goal - tip)[:2]) > 0.004
    action[2] = 0 if beside or force_n > 0.1 else max(action[2], -0.5)
    return action


def lifting(step, goal, tip, force_n):
    if step > 14 or np.linalg.norm(goal - tip) < 0.004:
        return np.array([0, 0, 0.3, 1])
    return np.append(toward(goal, tip), -1)


def cutting(step, goal, tip, force_n):
    return np.append(toward(goal, tip, 0.5), 1)


POLICIES = {"touch": touching, "lift_flap": lifting, "cut_line": cutting}


def played(env, policy, seed, options=None):
    """Rewards, and what the last step returned."""
    observation, _ = env.reset(seed=seed, options=options)
    rewards = []
    while True:
        tip, force = observation["poses"][0, :3].astype(float), observation["forces"][0, :3]
        out = env.step(policy(len(rewards), observation["goal"].astype(float), tip, np.linalg.norm(force)))
        observation = out[0]
        rewards.append(out[1])
        if out[2] or out[3]:
            return rewards, out


class TaskTest(unittest.TestCase):
    def test_contract(self):
        for task in gym.TASKS:
            gym.check(gym.make(task, observations=("poses", "forces", "points")))

    def test_points_are_of_the_skin_that_is_shown(self):
        for task in gym.TASKS:
            env = gym.make(task, observations=("points",))
            points = env.reset(seed=0)[0]["points"]
            skin = env.unwrapped.session.skin()
            shown = skin.positions_m[skin.used]
            self.assertTrue((points[:, None] == shown[None]).all(-1).any(1).all(), task)
            self.assertGreaterEqual(len(np.unique(points, axis=0)), min(len(points), len(shown)) * 9 // 10, task)
            env.close()

    def test_each_can_be_done(self):
        for task, policy in POLICIES.items():
            for seed in range(5):
                rewards, (_, _, terminated, truncated, info) = played(gym.make(task), policy, seed)
                self.assertTrue(terminated and info["is_success"] and not truncated, (task, seed, info))
                self.assertGreater(info["reward_terms"]["success"], 0)

    def test_doing_nothing_is_cut_off(self):
        for task in gym.TASKS:
            env = gym.make(task, max_episode_steps=7)
            rewards, out = played(env, lambda *a: np.zeros(env.action_space.shape), 0)
            self.assertEqual((len(rewards), out[2], out[3], out[4]["is_success"]), (7, False, True, False))

    def test_force_fails(self):
        env = gym.make("touch", most_n=1)
        down = np.array([0, 0, -1])
        rewards, out = played(env, lambda *a: down, 1, {"target_m": [0, 0]})
        self.assertEqual((out[2], out[4]["failure"], out[4]["is_success"]), (True, "force", False))
        self.assertLess(out[4]["reward_terms"]["force"], 0)
        self.assertEqual(out[4]["reward_terms"]["failure"], -10)

    def test_beside_the_line_costs(self):
        env = gym.make("cut_line")
        beside = lambda step, goal, tip, force: np.append(toward(goal + [0, 0.012, 0], tip) if step < 9 else [0.5, 0, 0], 1)
        env.reset(seed=1, options={"line": [0, 0]})
        on = off = 0
        for step in range(40):
            observation, _, _, _, info = env.step(beside(step, np.array([-0.023, 0, -0.005]), env.unwrapped._episode.tip, 0))
            on, off = on + info["reward_terms"]["on_path"], off + info["reward_terms"]["off_path"]
        self.assertEqual(on, 0)
        self.assertLess(off, -1)

    def test_terms(self):
        env = gym.make("touch", terms={"time": 0, "distance": 3})
        env.reset(seed=1)
        terms = env.step(np.zeros(3))[4]["reward_terms"]
        self.assertEqual(terms["time"], 0)
        other = gym.make("touch")
        other.reset(seed=1)
        self.assertAlmostEqual(terms["distance"], 3 * other.step(np.zeros(3))[4]["reward_terms"]["distance"])

    def test_options(self):
        env = gym.make("touch")
        self.assertEqual(env.reset(options={"target_m": [0.01, -0.01]})[0]["goal"].tolist(),
                         np.array([0.01, -0.01, 0.015], np.float32).tolist())
        for wrong in ({"target_m": [1, 0]}, {"target_m": [0]}, {"target_m": [np.nan, 0]}, {"goal": 1}):
            with self.assertRaises(ValueError):
                env.reset(options=wrong)
        stiff = gym.make("touch", overrides={"bodies[0].material.young_modulus_pa": 40000})
        self.assertIn("young_modulus_pa=40000", stiff.unwrapped.scene.keys)

    def test_misuse(self):
        env = gym.make("touch")
        with self.assertRaisesRegex(RuntimeError, "reset"):
            env.step(np.zeros(3))
        env.reset(seed=0)
        for wrong in (np.zeros(4), np.zeros(2), np.full(3, np.nan), 0.5, [[0, 0, 0]]):
            with self.assertRaises(ValueError):
                env.step(wrong)
        for make in (lambda: gym.make("sew"), lambda: gym.make("touch", observations=("smell",)), lambda: gym.make("touch", control_hz=7),
                     lambda: gym.make("touch", render_mode="human"), lambda: gym.make("touch", max_episode_steps=0),
                     lambda: gym.make("touch", terms={"beauty": 1})):
            with self.assertRaises(ValueError):
                make()
        for options in ({"speed": 1}, {"begin": 1}, {"_TOP_M": 1}):
            with self.assertRaises(TypeError):
                gym.make("touch", **options)
        env.close()
        with self.assertRaisesRegex(viscera.Error, "closed"):
            env.step(np.zeros(3))

    def test_checker_finds(self):
        class Wrong(gym.TissueEnv):
            def step(self, action):
                out = super().step(action)
                return out[0], self.spoil(out[1]), *out[2:]
        for spoil in (np.float32, lambda reward: float("nan"), lambda reward: reward + 1):
            env = Wrong(gym.Touch())
            env.spoil = spoil
            with self.assertRaises(AssertionError):
                gym.check(env)

    def test_pictures(self):
        try:
            env = gym.make("touch", observations=("poses", "rgb", "depth", "labels"), render_mode="rgb_array")
        except viscera.GpuError as error:
            self.skipTest(str(error))
        gym.check(env, steps=3)
        observation = env.reset(seed=1)[0]
        self.assertEqual(observation["rgb"].shape, (96, 96, 3))
        self.assertTrue(np.isfinite(observation["depth"]).any() and observation["labels"].any())
        env.close()


class VectorTest(unittest.TestCase):
    def test_each_is_as_alone(self):
        for task in gym.TASKS:
            many, count, limit = gym.make_vec(task, 3, max_episode_steps=9), 3, 9
            alone = [gym.make(task, max_episode_steps=limit) for _ in range(count)]
            seen, _ = many.reset(seed=5)
            singles = [env.reset(seed=5 + i)[0] for i, env in enumerate(alone)]
            rng = np.random.default_rng(0)
            for step in range(20):
                actions = rng.uniform(-1, 1, many.action_space.shape).astype(np.float32)
                seen, rewards, terminated, truncated, info = many.step(actions)
                for i, env in enumerate(alone):
                    one, reward, term, trunc, single = env.step(actions[i])
                    self.assertEqual((reward, term, trunc), (rewards[i], terminated[i], truncated[i]))
                    self.assertEqual(single["peak_force_n"], info["peak_force_n"][i])
                    if term or trunc:
                        self.assertTrue(all(np.array_equal(one[key], info["final_obs"][i][key]) for key in one))
                        one = env.reset()[0]
                    self.assertTrue(all(np.array_equal(one[key], seen[key][i]) for key in one), (task, step))
            self.assertTrue(many.observation_space.contains(seen))
            many.close()

    def test_misuse(self):
        many = gym.make_vec("touch", 2)
        with self.assertRaisesRegex(RuntimeError, "reset"):
            many.step(np.zeros((2, 3)))
        many.reset()
        for wrong in (np.zeros(3), np.zeros((3, 3)), np.full((2, 3), np.inf)):
            with self.assertRaises(ValueError):
                many.step(wrong)
        for make in (lambda: gym.make_vec("touch", 0), lambda: gym.make_vec("touch", 2, observations=("rgb",)),
                     lambda: gym.make_vec("touch", 2, max_episode_steps=0), lambda: many.reset(seed=[1])):
            with self.assertRaises(ValueError):
                make()


class WrapperTest(unittest.TestCase):
    def test_recorder(self):
        with tempfile.TemporaryDirectory() as folder:
            env = gym.Recorder(gym.make("touch", max_episode_steps=6), folder)
            played(env, lambda *a: np.array([0, 0.5, 0]), 3)
            env.reset()
            env.step(np.zeros(3))
            env.close()
            self.assertEqual(sorted(os.listdir(folder)), ["episode_000000.npz", "episode_000001.npz"])
            with np.load(os.path.join(folder, "episode_000000.npz")) as file:
                self.assertEqual(file["actions"].shape, (6, 3))
                self.assertEqual(file["observations_poses"].shape, (7, 1, 7))
                self.assertTrue(file["truncated"] and not file["terminated"] and file["seed"] == 3)
                terms = sum(file[key] for key in file if key.startswith("terms_"))
                np.testing.assert_allclose(terms, file["rewards"])
                again = gym.make("touch")
                again.reset(seed=int(file["seed"]))
                for action, seen in zip(file["actions"], file["observations_forces"][1:]):
                    np.testing.assert_array_equal(again.step(action)[0]["forces"], seen)
            self.assertEqual(int(np.load(os.path.join(folder, "episode_000001.npz"))["seed"]), -1)
            self.assertEqual(gym.Recorder(gym.make("touch"), folder)._episode, 2)

    def test_real_time(self):
        env = gym.RealTime(gym.make("touch"))
        env.reset(seed=0)
        start = time.monotonic()
        for _ in range(6):
            env.step(np.zeros(3))
        self.assertGreaterEqual(time.monotonic() - start, 6 / 20)


class ExampleTest(unittest.TestCase):
    def test_same_curve_twice(self):
        """Also on another number of threads."""
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "learn_to_touch", "learn_to_touch.py")
        curves = []
        with tempfile.TemporaryDirectory() as folder:
            for threads in ("1", "3"):
                file = os.path.join(folder, threads)
                subprocess.run([sys.executable, script, "--seeds", "2", "--generations", "2", "--population", "5", "--targets", "1",
                                "--tests", "2", "--threads", threads, "--out", file], check=True, capture_output=True, timeout=300)
                with open(file, encoding="utf-8") as text:
                    curves.append(text.read())
        self.assertEqual(curves[0], curves[1])
        self.assertEqual(len(curves[0].splitlines()), 5)


if __name__ == "__main__":
    unittest.main()
