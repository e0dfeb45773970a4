#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A tracker with a wrong pose, and a tip that was not calibrated: `register_stylus` finds both."""
import math
import os
import random
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import rospy
import rostest
import yaml
from geometry_msgs.msg import PoseStamped, TransformStamped
from program import Program, node
from sensor_msgs.msg import Joy
from simulator_watch import wait_until
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

LIMIT_S = 20
RATE_HZ = 100
NOISE_M = 1e-4          # per coordinate, for the tracker's positions
TIP_M = [0.01, -0.02, 0.15]
BASE_M = [0.4, -0.3, 0.2]   # of the tracker, tissue frame
POINTS = {"apex": (0, -0.05, 0.01), "left": (-0.06, 0, 0), "right": (0.05, 0.01, 0.02), "top": (0.01, 0, 0.07)}
FOUND_M = 1e-3          # ten times the noise: an error of a frame or a sign is centimetres


def turn(axis, angle):
    """Returns a quaternion xyzw."""
    share = math.sin(angle / 2) / math.hypot(*axis)
    return [share * a for a in axis] + [math.cos(angle / 2)]


def back(q):
    return [-q[0], -q[1], -q[2], q[3]]


def turned(q, v):
    """Returns v rotated by q."""
    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    t = [2 * c for c in cross(q, v)]
    return [a + q[3] * b + c for a, b, c in zip(v, t, cross(q, t))]


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


BASE_TURN = turn((1, 2, -1), 2.2)


class Tracker:
    """Sends the pose of a device in its own frame, `tracker`, with its tip at `tip` of the tissue frame."""

    def __init__(self):
        self.tip = POINTS["apex"]
        self.tilting, self.speed = False, 0.0
        self.begun = time.monotonic()
        self.poses = rospy.Publisher("left/measured_cp", PoseStamped, queue_size=100)
        self.frames = rospy.Publisher("/tf", TFMessage, queue_size=100)
        self.button = rospy.Publisher("left/button1", Joy, queue_size=10)
        threading.Thread(target=self.play, daemon=True).start()

    def play(self):
        while not rospy.is_shutdown():
            since = time.monotonic() - self.begun
            way = 5 * since
            r = turn((math.cos(way), math.sin(way), 0.1), 0.5) if self.tilting else turn((1, 0, 0), 0.3)
            tip = minus(self.tip, [self.speed * math.sin(7 * since), 0, 0])
            at = minus(turned(back(BASE_TURN), minus(tip, BASE_M)), turned(r, TIP_M))
            self.send([a + random.gauss(0, NOISE_M) for a in at], r)
            time.sleep(1 / RATE_HZ)

    def send(self, at, q):
        pose = PoseStamped()
        pose.header.frame_id = "tracker"
        pose.header.stamp = rospy.Time.now()
        pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = at
        o = pose.pose.orientation
        o.x, o.y, o.z, o.w = q
        self.poses.publish(pose)
        frame = TransformStamped(header=pose.header, child_frame_id="pen")
        t = frame.transform.translation
        t.x, t.y, t.z = at
        frame.transform.rotation = o
        self.frames.publish(TFMessage([frame]))


class RegisterStylusTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("register_stylus_test")
        cls.tracker = Tracker()
        cls.folder = tempfile.TemporaryDirectory()
        cls.file = os.path.join(cls.folder.name, "left.yaml")
        cls.points = os.path.join(cls.folder.name, "points.yaml")
        with open(cls.points, "w") as out:
            yaml.safe_dump({"points": [{"name": n, "position_m": list(p)} for n, p in POINTS.items()]}, out)

    def start(self, name, *arguments):
        program = Program([node("register_stylus"), "__name:=" + name, "_file:=" + self.file, *arguments])
        self.addCleanup(program.end)
        calls = [rospy.ServiceProxy(name + "/" + call, Trigger) for call in ("collect", "discard", "solve")]
        for call in calls:
            call.wait_for_service(LIMIT_S)
        return (program, *calls)

    def check(self, answer, good, *words):
        self.assertEqual(answer.success, good, answer.message)
        for word in words:
            self.assertIn(word, answer.message)

    def read(self):
        with open(self.file) as file:
            return yaml.safe_load(file)

    def residual_mm(self, unknown_shares):
        """Returns the expected residual: sigma sqrt(3 - 6 / N), here with N in the hundreds or as given."""
        return 1e3 * NOISE_M * math.sqrt(3 - unknown_shares)

    def test_1_pivot_finds_the_tip(self):
        program, collect, discard, solve = self.start("pivot", "_mode:=pivot", "_window_s:=2")
        self.check(solve(), False, "20 poses at least")
        self.check(discard(), False, "nothing")
        self.check(collect(), True, "poses")       # held still: not rotated
        self.check(solve(), False, "turned too little")
        self.check(discard(), True)
        self.tracker.tilting = True
        wait_until(lambda: self.tracker.button.get_num_connections(), LIMIT_S, "listener of button1")
        before = program.output.count(" poses; call `collect` again")
        self.tracker.button.publish(Joy(buttons=[1]))
        self.tracker.button.publish(Joy(buttons=[0]))
        program.said(" poses; call `collect` again", before + 1)
        self.check(solve(), True, "tip at", "residual", self.file)
        found = self.read()
        self.assertEqual(set(found), {"tip", "residual_mm"})
        self.assertLess(math.dist(found["tip"]["position_m"], TIP_M), FOUND_M)
        self.assertLess(abs(found["residual_mm"] / self.residual_mm(0) - 1), 0.3)  # for about 200 poses: six deviations
        self.tracker.tilting = False

    def test_2_points_find_the_base(self):
        _, collect, discard, solve = self.start("points", "_mode:=points", "_points:=" + self.points, "_tf_frame:=pen",
                                                "_tf_base:=tracker")
        self.tracker.speed = 0.02
        self.check(collect(), False, "'apex'", "moved")
        self.tracker.speed = 0
        self.check(solve(), False, "0 of 4")
        for name, place in POINTS.items():
            self.tracker.tip = place
            time.sleep(0.1)
            self.check(collect(), True, "'%s' is touched" % name)
        self.check(collect(), False, "all points are touched")
        self.check(discard(), True, "touch 'top' (4 of 4)")
        self.check(collect(), True, "'top' is touched")
        self.check(solve(), True, "tracker", "residual", "apex")
        found = self.read()
        self.assertEqual(set(found), {"tip", "base", "residual_mm"})
        self.assertLess(math.dist(found["base"]["position_m"], BASE_M), 10 * FOUND_M)  # half a metre away
        same = sum(a * b for a, b in zip(found["base"]["orientation_xyzw"], BASE_TURN))
        self.assertGreater(abs(same), math.cos(0.02 / 2))
        self.assertLess(found["residual_mm"], 1)

    def refused(self, *arguments):
        done = subprocess.run([node("register_stylus"), "__name:=refused", *arguments], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=LIMIT_S)
        self.assertEqual(done.returncode, 1, done.stdout)
        return done.stdout

    def test_3_bad_parameters_are_refused(self):
        self.assertIn("~mode: must be pivot or points", self.refused("_file:=/tmp/x.yaml"))
        self.assertIn("~points: must name", self.refused("_mode:=points", "_file:=" + self.file + "2"))
        bad = os.path.join(self.folder.name, "bad.yaml")
        with open(bad, "w") as out:
            out.write("points:\n  - {name: apex, at: [0, 0, 0]}\n")
        self.assertIn("bad.yaml:2: unknown key", self.refused("_mode:=points", "_file:=" + self.file + "2", "_points:=" + bad))


if __name__ == "__main__":
    rostest.rosrun("viscera", "register_stylus_test", RegisterStylusTest, sys.argv)
