#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two live styluses that push, hold and cut are recorded; `viscera run` ends with the simulator's hash."""
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import rospy
import rostest
from irregular_stylus import StylusDevice
from program import Program, node
from simulator_watch import Latest, SimulatorWatch, wait_until
from std_srvs.srv import Trigger
from viscera.msg import Samples, StylusState
from viscera.srv import SetToolMode, Step

LIMIT_S = 30
STALE_S = 0.4                      # longer than stale_after_s of the scene


class StylusRecordTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("stylus_record_test")
        cls.folder = tempfile.TemporaryDirectory()
        cls.file = os.path.join(cls.folder.name, "recorded.yaml")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        cls.left, cls.right = StylusDevice("left"), StylusDevice("right")
        wait_until(lambda: cls.left.heard() and cls.right.heard(), LIMIT_S, "subscribers")
        cls.call = {name: rospy.ServiceProxy(name, Trigger) for name in ("reset", "pause", "resume")}
        cls.step = rospy.ServiceProxy("step", Step)

    def command(self, *arguments):
        if "VISCERA_COMMAND" not in os.environ:
            self.skipTest("the command viscera is not built")
        return subprocess.run([os.environ["VISCERA_COMMAND"], *arguments], text=True, timeout=100,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def replayed(self, path):
        sets = [part for key in rospy.get_param("~overrides").split(";") for part in ("--set", key)]
        done = self.command("run", rospy.get_param("~scene"), "--strokes", path, "--no-view", *sets)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout.splitlines()[-1])

    def pull(self):
        self.left.go((0, -0.1, -0.02), (0, -0.052, -0.02), 0.5)
        self.left.press(1, True)
        self.left.go((0, -0.052, -0.02), (0, -0.07, -0.02), 0.4)

    def cut(self):
        self.right.go((-0.07, -0.025, -0.02), (-0.07, -0.025, -0.02), 0.4)
        self.right.press(2, True)
        self.right.go((-0.07, -0.025, -0.02), (0.07, -0.025, -0.021), 0.8)
        self.right.press(2, False)
        self.right.go((0.07, -0.025, -0.02), (0.07, -0.1, -0.02), 0.1)

    def act(self):
        hands = [threading.Thread(target=act) for act in (self.pull, self.cut)]
        for hand in hands:
            hand.start()
        for hand in hands:
            hand.join()

    def record(self, *arguments):
        program = Program([node("stylus_record"), "__name:=recorder",
                           "_file:=" + self.file, *arguments])
        self.addCleanup(program.end)
        return program

    def test_1_live_poses_are_replayed_to_the_bit(self):
        recorder = self.record()
        recorder.said("recording since tick 1")
        self.act()
        time.sleep(STALE_S)
        self.left.go((0, -0.1, -0.02), (0, -0.09, -0.02), 0.3)
        moving = threading.Thread(target=lambda: self.left.go((0, -0.09, -0.02), (0, -0.05, -0.02), 1.0))
        moving.start()
        time.sleep(0.2)
        self.assertTrue(self.call["pause"]().success)      # input is discarded, and what the styluses hold is released
        time.sleep(0.5)
        self.assertTrue(self.call["resume"]().success)     # the left stylus is inside by now, and must not push
        moving.join()
        self.right.go((-0.07, -0.025, -0.02), (-0.07, -0.025, -0.02), 0.1)
        time.sleep(STALE_S)                                # both styluses vanish, and time advances
        self.pull()
        self.assertTrue(self.call["pause"]().success)
        # ticks that a caller steps are recorded too
        at = StylusState(stylus="right")
        at.pose.position.y, at.pose.orientation.w = -0.2, 1
        self.assertTrue(self.step(ticks=3, styluses=[at]).success)
        live = self.step(ticks=0)
        saved = rospy.ServiceProxy("recorder/save", Trigger)()
        self.assertTrue(saved.success, saved.message)
        self.assertIn("%d ticks" % live.tick, saved.message)
        replayed = self.replayed(self.file)
        self.assertEqual(replayed["state_hash"], live.state_hash)
        self.assertIs(replayed["recorded_hash_met"], True)
        self.assertGreater(replayed["springs_cut"], 0)
        # a file without the effect of a pause is a different session: the check above can fail
        with open(self.file) as file:
            text = file.read()
        self.assertIn('scene: "%s"' % rospy.get_param("~scene"), text)
        self.assertIn(rospy.get_param("~overrides") + '"', text)
        begun = text.index("input_reset:")
        other = os.path.join(self.folder.name, "other.yaml")
        with open(other, "w") as file:
            file.write(text[:begun] + text[text.index("\n", begun) + 1:])
        replayed = self.replayed(other)
        self.assertNotEqual(replayed["state_hash"], live.state_hash)
        self.assertIs(replayed["recorded_hash_met"], False)

    def test_2_a_reset_begins_again_and_the_end_saves(self):
        self.call["resume"]()
        recorder = self.record("_seconds:=0.5")
        recorder.said("recording since tick 1")
        self.left.go((0, -0.1, -0.02), (0, -0.09, -0.02), 0.2)
        self.assertTrue(self.call["reset"]().success)
        recorder.said("restarts")
        self.left.go((0, -0.1, -0.02), (0, -0.09, -0.02), 1)
        recorder.said("ticks are in " + self.file)
        self.assertEqual(recorder.process.wait(LIMIT_S), 0)
        tick_hz = self.watch_samples().tick_hz
        self.assertAlmostEqual(self.replayed(self.file)["simulated_s"], 0.5, delta=2 / tick_hz)
        rate = self.command("run", rospy.get_param("~scene"), "--strokes", self.file, "--no-view", "--set", "solver.tick_hz=50")
        self.assertNotEqual(rate.returncode, 0)
        self.assertIn("'tick_hz' is %g Hz" % tick_hz, rate.stderr)

    def watch_samples(self):
        samples = Latest("samples", Samples)
        wait_until(lambda: samples.count, LIMIT_S, "samples")
        samples.stop()
        return samples.message

    def test_3_a_file_that_cannot_be_written_is_told_at_the_start(self):
        recorder = Program([node("stylus_record"), "__name:=refused", "_file:=/proc/none.yaml"])
        recorder.said("~file: /proc/none.yaml: cannot be written")
        self.assertEqual(recorder.process.wait(LIMIT_S), 1)

    def test_4_a_mode_that_is_not_the_scenes_ends_the_recording(self):
        self.call["resume"]()
        set_mode = rospy.ServiceProxy("set_tool_mode", SetToolMode)
        recorder = self.record()
        recorder.said("recording since tick 1")
        self.left.go((0, -0.1, -0.02), (0, -0.1, -0.02), 0.2)
        self.assertTrue(set_mode("left", "idle", "none").success)
        self.addCleanup(set_mode, "left", "idle", "probe")
        self.left.go((0, -0.1, -0.02), (0, -0.1, -0.02), 0.2)
        recorder.said("the mode of stylus 'left', which differs from the scene")
        self.assertEqual(recorder.process.wait(LIMIT_S), 1)
        self.assertTrue(os.path.exists(self.file))         # the recording before it


if __name__ == "__main__":
    rostest.rosrun("viscera", "stylus_record_test", StylusRecordTest, sys.argv)
