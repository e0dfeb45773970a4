# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Soft-tissue tasks with Gymnasium's API. Uses Gymnasium's classes if it is installed; it is not required.

    env = viscera.gym.make("touch")
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

docs/python.md has tables of tasks, observations, terms of the reward and wrappers.
"""
from .checker import check
from .env import TissueEnv, VectorTissueEnv
from .tasks import TASKS, CutLine, LiftFlap, Task, Touch
from .wrappers import RealTime, Recorder, TimeLimit

__all__ = ["TASKS", "CutLine", "LiftFlap", "RealTime", "Recorder", "Task", "TimeLimit", "TissueEnv", "Touch",
           "VectorTissueEnv", "check", "make", "make_vec"]


def _task(task, options):
    if isinstance(task, Task):
        if options:
            raise TypeError(f"a Task object takes no options; found {sorted(options)}")
        return task
    if task not in TASKS:
        raise ValueError(f"task: must be one of {', '.join(TASKS)}; found {task!r}")
    return TASKS[task](**options)


def make(task, max_episode_steps=None, observations=("poses", "forces"), render_mode=None, **options):
    """Returns an environment for a task, given by name or as a Task, with its limit of steps. Options go to the task."""
    made = _task(task, options)
    limit = made.steps if max_episode_steps is None else max_episode_steps
    return TimeLimit(TissueEnv(made, observations, render_mode), limit)


def make_vec(task, num_envs=1, max_episode_steps=None, observations=("poses", "forces"), threads=0, **options):
    """Returns a vector environment: several sessions that one call steps. An episode that ends restarts in the same step.
    Its final data are in info["final_obs"] and info["final_info"], for the episodes of info["_final_obs"]."""
    return VectorTissueEnv(_task(task, options), num_envs, observations, max_episode_steps, threads)
