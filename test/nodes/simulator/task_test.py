#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A lesson with replayed strokes: its task is passed, published and reported, and `viscera replay` of its recording has
the same score. Tasks are restarted and given up; a task that cannot start is refused with the accepted names."""
import json
import os
import struct
import subprocess
import unittest

import rospy
import rostest
from simulator_watch import SimulatorWatch, wait_until
from std_srvs.srv import Trigger
from viscera.msg import Metrics, TaskState
from viscera.srv import StartTask

LIMIT_S = 60
GONE_S = 1  # since the last pose: tracking is lost


class TaskTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("task_test")
        cls.states, cls.metrics = [], []
        rospy.Subscriber("task_state", TaskState, cls.states.append, queue_size=100)
        rospy.Subscriber("metrics", Metrics, cls.metrics.append, queue_size=100)
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        for name in ("start_task", "end_task", "stop_recording"):
            rospy.wait_for_service(name, LIMIT_S)
        cls.start = rospy.ServiceProxy("start_task", StartTask)
        cls.call = {name: rospy.ServiceProxy(name, Trigger) for name in ("end_task", "stop_recording", "reset")}

    def state(self):
        return self.states[-1].state if self.states else TaskState.NONE

    def test_1_a_good_session_passes_and_is_reported(self):
        wait_until(lambda: self.state() in (TaskState.PASSED, TaskState.FAILED), LIMIT_S, "the end of the task")
        wait_until(lambda: self.states[-1].report, LIMIT_S, "the report")
        last = self.states[-1]
        self.assertEqual(last.state, TaskState.PASSED, last.step)
        self.assertIn(TaskState.RUNNING, [state.state for state in self.states])
        self.assertEqual((last.task, last.kind, last.title), ("touch_targets", "touch_targets", "Touch in order"))
        self.assertIn("one after another", last.instructions)
        self.assertEqual(last.progress, 1)
        self.assertAlmostEqual(last.score, last.time_limit_s - last.time_s - last.penalties_s)
        self.assertGreaterEqual(last.score, last.pass_score)
        self.assertEqual(len(last.measures), len(last.values))
        self.assertEqual(len(last.measures), len(last.measure_penalties_s))
        self.assertEqual(last.values[last.measures.index("wrong_touches")], 0)
        whole = [message for message in self.metrics if message.complete]
        self.assertEqual(len(whole), 1)
        right = whole[0].styluses.index("right")
        self.assertGreater(whole[0].path_m[right], 0.2)
        self.assertLess(whole[0].sparc[right], -1)
        self.assertGreater(len(self.metrics), 3)

    def test_2_the_recording_comes_to_the_same_score(self):
        with open(os.path.join(self.states[-1].report, "report.json")) as file:
            live = json.load(file)
        with open(os.path.join(self.states[-1].report, "report.html")) as file:
            page = file.read()
        for name, caption in (("start", "at the start"), ("end", "at the end")):  # as `viscera task` has them
            with open(os.path.join(self.states[-1].report, name + ".png"), "rb") as file:
                self.assertEqual(file.read(24)[16:], struct.pack(">II", 64, 48))
            self.assertIn("<figcaption>" + caption, page)
        answer = self.call["stop_recording"]()
        self.assertTrue(answer.success, answer.message)
        if "VISCERA_COMMAND" not in os.environ:
            self.skipTest("the command viscera is not built")
        done = subprocess.run([os.environ["VISCERA_COMMAND"], "replay", answer.message, "--no-view"], text=True, timeout=100,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 0, done.stderr)
        replayed = json.loads(done.stdout.splitlines()[-1])["tasks"]
        attempts = [report.pop("attempt") for report in [live, *replayed]]  # their dates differ
        self.assertEqual([attempt["name"] for attempt in attempts], ["Ada", ""])
        self.assertRegex(attempts[0]["state_hash"], "^[0-9a-f]{16}$")
        self.assertEqual(replayed, [live])

    def test_3_a_task_is_given_up_and_begun_again(self):
        """Without styluses: those of the strokes, which may be late on a busy machine, have vanished first."""
        wait_until(lambda: (self.watch.value("right", "input_age_s") or 0) > GONE_S, LIMIT_S, "end of the strokes")
        self.assertIn("no task is running", self.call["end_task"]().message)
        answer = self.start(task="")
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.message, "Touch in order")
        wait_until(lambda: self.state() == TaskState.WAITING, LIMIT_S, "a task that waits")
        self.assertTrue(self.call["end_task"]().success)
        wait_until(lambda: self.state() == TaskState.FAILED, LIMIT_S, "its end")
        self.assertEqual(self.states[-1].step, "the task was given up")
        self.assertEqual(self.states[-1].score, 0)
        self.assertTrue(self.call["reset"]().success)
        wait_until(lambda: self.state() == TaskState.WAITING, LIMIT_S, "it begins again with a reset")

    def test_4_the_report_names_who_starts_the_task(self):
        answer = self.start(task="", trainee="Grace")
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: self.state() == TaskState.WAITING and not self.states[-1].report, LIMIT_S, "a task that waits")
        self.assertTrue(self.call["end_task"]().success)
        wait_until(lambda: self.states[-1].report, LIMIT_S, "the report")
        with open(os.path.join(self.states[-1].report, "report.json")) as file:
            self.assertEqual(json.load(file)["attempt"]["name"], "Grace")
        answer = self.start(task="", trainee="-")
        self.assertFalse(answer.success)
        self.assertIn("a trainee's name must have 1 to 64 printable characters", answer.message)

    def test_5_another_scenes_task_and_unknown_ones_are_refused(self):
        answer = self.start(task="pattern_cut")
        self.assertFalse(answer.success)
        self.assertIn("gauze", answer.message)
        self.assertIn("load_scene", answer.message)
        answer = self.start(task="no_such_task")
        self.assertFalse(answer.success)
        self.assertIn("pattern_cut", answer.message)


if __name__ == "__main__":
    rostest.rosrun("viscera", "task", TaskTest)
