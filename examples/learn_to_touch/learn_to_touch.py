#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Learns to touch a target without pressing harder than 0.5 N, by the cross-entropy method, with NumPy alone.

A policy is a matrix that maps the position of the target, the force and the distance to the motion of the tip. A population
of random matrices is drawn; the best of them give the mean and spread of the next population. The test uses targets that
were not used for learning. The same seed gives the same curve, bit by bit.
"""
import argparse
import sys
import time

import numpy as np

from viscera import gym

LIMIT_N = 0.5
FEATURES, ACTIONS = 8, 3
ELITE = 0.2            # share of the population
FIRST_SPREAD, LEAST_SPREAD = 1.0, 0.05
TEST_SEED = 1_000_000  # targets that are not used for learning: seeds of learners are lower


def features(observation):
    """Returns (envs, FEATURES): vector to target [cm], horizontal distance, force over its limit, contact, proximity, 1."""
    way = 100 * (observation["goal"] - observation["poses"][:, 0, :3]).astype(float)
    level = np.linalg.norm(way[:, :2], axis=1, keepdims=True)
    force = np.linalg.norm(observation["forces"][:, 0, :3].astype(float), axis=1, keepdims=True) / LIMIT_N
    return np.hstack([way, level, force, np.minimum(force, 1) > 0.1, np.exp(-level ** 2), np.ones_like(level)])


def play(env, policies, seeds):
    """Plays the episode of each seed with each policy. Returns (policies, seeds) rewards, successes and largest forces [N]."""
    rewards, done, peaks = [], [], []
    for seed in seeds:
        observation, _ = env.reset(seed=[int(seed)] * len(policies))
        earned, won, peak, alive = np.zeros(len(policies)), np.zeros(len(policies), bool), np.zeros(len(policies)), None
        while alive is None or alive.any():
            alive = np.ones(len(policies), bool) if alive is None else alive
            actions = np.tanh(np.einsum("naf,nf->na", policies, features(observation)))
            observation, reward, terminated, truncated, info = env.step(actions)
            earned += np.where(alive, reward, 0)
            won |= alive & info["is_success"]
            peak = np.where(alive, np.maximum(peak, info["peak_force_n"]), peak)
            alive &= ~(terminated | truncated)
        rewards.append(earned), done.append(won), peaks.append(peak)
    return np.array(rewards).T, np.array(done).T, np.array(peaks).T


def tested(policy, episodes, threads):
    """Returns the share of new targets touched without exceeding the force limit, and the largest force [N]."""
    env = gym.make_vec("touch", episodes, limit_n=LIMIT_N, threads=threads)
    observation, _ = env.reset(seed=TEST_SEED)
    won, peak, alive = np.zeros(episodes, bool), np.zeros(episodes), np.ones(episodes, bool)
    while alive.any():
        observation, _, terminated, truncated, info = env.step(np.tanh(np.einsum("af,nf->na", policy, features(observation))))
        won |= alive & info["is_success"]
        peak = np.where(alive, np.maximum(peak, info["peak_force_n"]), peak)
        alive &= ~(terminated | truncated)
    env.close()
    return (won & (peak <= LIMIT_N)).mean(), peak.max()


def learn(seed, generations, population, targets, threads):
    """Returns the policy, and for each generation: mean reward, that of the best fifth, share of successful episodes."""
    rng = np.random.default_rng(seed)
    env = gym.make_vec("touch", population, limit_n=LIMIT_N, threads=threads)
    mean, spread = np.zeros((ACTIONS, FEATURES)), np.full((ACTIONS, FEATURES), FIRST_SPREAD)
    curve, kept = [], max(2, round(ELITE * population))
    for generation in range(generations):
        policies = mean + spread * rng.standard_normal((population, ACTIONS, FEATURES))
        rewards, won, _ = play(env, policies, rng.integers(TEST_SEED, size=targets))
        order = np.argsort(-rewards.mean(1), kind="stable")[:kept]
        mean, spread = policies[order].mean(0), np.maximum(policies[order].std(0), LEAST_SPREAD)
        curve.append((rewards.mean(), rewards[order].mean(), won.mean()))
        print(f"seed {seed} generation {generation + 1:2d}: reward {curve[-1][0]:8.3f}, best fifth {curve[-1][1]:8.3f}, "
              f"won {curve[-1][2]:.3f}", file=sys.stderr, flush=True)
    env.close()
    return mean, curve


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=3, help="learners, of seeds 0, 1 ...")
    parser.add_argument("--generations", type=int, default=20)
    parser.add_argument("--population", type=int, default=32)
    parser.add_argument("--targets", type=int, default=3, help="episodes of each policy in a generation")
    parser.add_argument("--tests", type=int, default=100, help="episodes with new targets at the end")
    parser.add_argument("--threads", type=int, default=0, help="0: one per processor")
    parser.add_argument("--out", default="", help="write the curves here, as CSV, each number to the bit")
    options = parser.parse_args()
    rows = ["seed,generation,reward,reward_of_best_fifth,won"]
    for seed in range(options.seeds):
        start = time.monotonic()
        policy, curve = learn(seed, options.generations, options.population, options.targets, options.threads)
        rows += [",".join(map(repr, (seed, g + 1, *map(float, point)))) for g, point in enumerate(curve)]
        share, most = tested(policy, options.tests, options.threads)
        print(f"seed {seed}: {100 * share:.0f} % of {options.tests} new targets touched below {LIMIT_N} N, largest force "
              f"{most:.2f} N, {time.monotonic() - start:.0f} s")
    if options.out:
        with open(options.out, "w", encoding="utf-8") as file:
            file.write("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
