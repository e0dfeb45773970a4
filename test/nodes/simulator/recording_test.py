#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A live session is recorded: two styluses push, hold and cut, with jaws too, with a pause, a reset, a tool mode, a
saved state and another scene. `viscera replay` ends with the simulator's hash, also for a recording that ends when the
simulator is killed. VISCERA_LIVE_S: least duration for which styluses act in the session of jaws; if it is set,
recordings are replayed three times."""
import glob
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import xmlrpc.client

import rosgraph
import rosnode
import rospy
import rostest
from irregular_stylus import StylusDevice
from simulator_watch import Latest, SimulatorWatch, wait_until
from std_srvs.srv import Trigger
from viscera.msg import Tick
from viscera.srv import FileCommand, LoadScene, SetToolMode, Step

LIMIT_S = 30
LIVE_S = float(os.environ.get("VISCERA_LIVE_S", 0))
REPLAYS = 3 if LIVE_S else 1
OPEN_RAD, CLOSED_RAD = 0.6, 0.02
# As in the launch file: jaws are no finer than the lattice.
OVERRIDES = ["solver.backend=cpu", "styluses[0].grasper.radius_m=0.012", "styluses[0].grasper.jaw_length_m=0.03"]
LEAST_PULL_N = 0.1                 # force of the wall at 25 mm; a probe next to it has none
HERE = os.path.dirname(os.path.abspath(__file__))
OTHER = os.path.join(os.path.dirname(HERE), "views", "cameras.yaml")
WALL = os.path.join(os.path.dirname(HERE), "support", "front_wall.yaml")
RECORDINGS = os.path.join(os.environ["ROS_HOME"], "recordings")


class RecordingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("recording_test")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        cls.left, cls.right = StylusDevice("left"), StylusDevice("right")
        wait_until(lambda: cls.left.heard() and cls.right.heard(), LIMIT_S, "subscribers")
        cls.call = {name: rospy.ServiceProxy(name, Trigger) for name in ("reset", "pause", "resume", "stop_recording")}
        cls.file = {name: rospy.ServiceProxy(name, FileCommand) for name in ("save_state", "load_state", "start_recording")}
        cls.set_mode = rospy.ServiceProxy("set_tool_mode", SetToolMode)
        cls.step, cls.load = rospy.ServiceProxy("step", Step), rospy.ServiceProxy("load_scene", LoadScene)

    def done(self, answer):
        self.assertTrue(answer.success, answer.message)
        return answer.message

    def act(self):
        def pull():
            self.left.go((0, -0.1, -0.02), (0, -0.052, -0.02), 0.5)
            self.left.press(1, True)
            self.left.go((0, -0.052, -0.02), (0, -0.07, -0.02), 0.4)
            self.left.press(1, False)

        def cut():
            self.right.go((-0.07, -0.025, -0.02), (-0.07, -0.025, -0.02), 0.4)
            self.right.press(2, True)
            self.right.go((-0.07, -0.025, -0.02), (0.07, -0.025, -0.021), 0.8)
            self.right.press(2, False)
        self.together(pull, cut)

    def together(self, *acts):
        hands = [threading.Thread(target=act) for act in acts]
        for hand in hands:
            hand.start()
        for hand in hands:
            hand.join()

    def act_with_jaws(self):
        """The left stylus holds tissue between its jaws and pulls it; the right one snips three times along the
        wall."""
        def pull():
            self.left.grip(OPEN_RAD)
            self.left.go((0, -0.1, -0.02), (0, -0.05, -0.02), 0.5)
            self.left.grip(CLOSED_RAD)
            self.left.go((0, -0.05, -0.02), (0, -0.05, -0.02), 0.4)
            self.left.go((0, -0.05, -0.02), (0, -0.075, -0.02), 0.5)
            self.left.grip(OPEN_RAD)
            self.left.go((0, -0.075, -0.02), (0, -0.1, -0.02), 0.3)

        def snip():
            for x in (-0.02, 0, 0.02):
                self.right.grip(OPEN_RAD)
                self.right.go((x, -0.1, 0), (x, -0.045, 0), 0.3)
                self.right.grip(CLOSED_RAD)
                self.right.go((x, -0.045, 0), (x, -0.045, 0), 0.2)
                self.right.go((x, -0.045, 0), (x, -0.1, 0), 0.2)
        self.together(pull, snip)

    def replayed(self, path, *arguments):
        if "VISCERA_COMMAND" not in os.environ:
            self.skipTest("the command viscera is not built")
        done = subprocess.run([os.environ["VISCERA_COMMAND"], "replay", path, *arguments], text=True, timeout=100,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads(done.stdout.splitlines()[-1])

    def test_1_one_recording_at_a_time_and_none_is_overwritten(self):
        self.assertIn("already", self.file["start_recording"](file="another.viscera").message)
        path = self.done(self.call["stop_recording"]())      # the recording of ~record
        self.assertEqual(os.path.dirname(path), RECORDINGS)
        self.assertIs(self.replayed(path, "--no-view")["to_recorded_end"], True)
        self.assertIn("nothing is being recorded", self.call["stop_recording"]().message)
        for name in ("../a", "", ".hidden"):
            self.assertFalse(self.file["start_recording"](file=name).success, name)

    def test_2_a_live_session_is_replayed_to_the_bit(self):
        name = "live_%d.viscera" % time.time_ns()
        path = self.done(self.file["start_recording"](file=name))
        self.assertFalse(self.file["start_recording"](file=name).success)
        answer = self.file["save_state"](file=name)
        self.assertFalse(answer.success)
        self.assertIn("already exists as a recording", answer.message)
        self.act()
        self.done(self.file["save_state"](file="state"))
        self.done(self.call["pause"]())
        self.done(self.step(ticks=3))
        self.done(self.call["resume"]())
        self.done(self.set_mode("left", "idle", "none"))
        self.act()
        self.done(self.call["reset"]())
        self.act()
        self.done(self.file["load_state"](file="state"))
        self.act()
        self.done(self.load(scene=OTHER, overrides=["solver.backend=cpu"]))
        time.sleep(0.3)
        self.done(self.load(scene=WALL, overrides=OVERRIDES))
        self.act()
        self.done(self.call["pause"]())
        live = self.step(ticks=0)
        self.assertEqual(self.done(self.call["stop_recording"]()), path)
        for _ in range(REPLAYS):
            replayed = self.replayed(path, "--no-view")
            self.assertEqual(replayed["state_hash"], live.state_hash)
            self.assertIs(replayed["recorded_hash_met"], True)
            self.assertIs(replayed["to_recorded_end"], True)
        self.assertEqual(len(replayed["pieces"]), 5)         # a reset, a state, two scenes
        hands = {hand["stylus"]: hand for hand in replayed["pieces"][0]}
        self.assertGreater(hands["left"]["peak_force_n"], 0)
        self.assertGreater(hands["right"]["path_m"], 0.1)
        self.done(self.call["resume"]())

    def jaws(self):
        self.done(self.set_mode("left", "idle", "grasper"))
        self.done(self.set_mode("right", "idle", "scissors"))

    def test_3_jaws_are_replayed_to_the_bit(self):
        path = self.done(self.file["start_recording"](file="jaws_%d.viscera" % time.time_ns()))
        self.jaws()
        begun, rounds = time.monotonic(), 0
        while rounds < 2 or time.monotonic() - begun < LIVE_S:
            if rounds % 4 == 1:
                self.done(self.call["reset"]())
            if rounds % 4 == 3:
                self.done(self.load(scene=WALL, overrides=OVERRIDES))
                self.jaws()
            self.act_with_jaws()
            wait_until(lambda: self.watch.value("simulation", "springs_cut"), LIMIT_S, "springs that scissors have cut")
            rounds += 1
        self.done(self.call["pause"]())
        live = self.step(ticks=0)
        self.done(self.call["stop_recording"]())
        for _ in range(REPLAYS):
            replayed = self.replayed(path, "--no-view")
            self.assertEqual(replayed["state_hash"], live.state_hash)
            self.assertIs(replayed["to_recorded_end"], True)
        pulls = [hand["peak_force_n"] for piece in replayed["pieces"] for hand in piece if hand["stylus"] == "left"]
        self.assertGreater(max(pulls), LEAST_PULL_N)
        self.done(self.call["resume"]())

    def test_4_pictures_of_other_cameras_are_made_afterwards(self):
        path = max(glob.glob("viscera_saved/live_*.viscera") or
                   glob.glob(os.path.join(os.environ["ROS_HOME"], "viscera_saved", "live_*.viscera")))
        with tempfile.TemporaryDirectory() as out:
            self.replayed(path, "--until", "0.2", "--out", out, "--set",
                          "cameras=[{name: other, position_m: [0, -0.3, 0], width_px: 64, height_px: 48}]")
            self.assertTrue(glob.glob(os.path.join(out, "frames", "other_*.png")))
            self.assertTrue(os.path.exists(os.path.join(out, "tools.csv")))

    def test_5_what_was_recorded_before_a_kill_replays(self):
        path = self.done(self.file["start_recording"](file="killed_%d.viscera" % time.time_ns()))
        ticks = Latest("tick", Tick)
        wait_until(lambda: ticks.count, LIMIT_S, "tick")
        begun = ticks.message.tick
        self.act()
        lived = ticks.message.tick - begun
        uri = rosnode.get_api_uri(rosgraph.Master("/recording_test"), "/simulator")
        pid = xmlrpc.client.ServerProxy(uri).getPid("/recording_test")[2]
        time.sleep(1)                                        # the last second may be lost
        os.kill(pid, signal.SIGKILL)
        replayed = self.replayed(path, "--no-view")
        self.assertIs(replayed["recorded_hash_met"], True)
        self.assertIn("cut", replayed)
        self.assertGreaterEqual(replayed["steps"], lived)
        self.assertGreater(replayed["pieces"][0][0]["path_m"], 0)


if __name__ == "__main__":
    rostest.rosrun("viscera", "recording_test", RecordingTest, sys.argv)
