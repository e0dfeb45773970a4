#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Whatever styluses do to the tissue, the simulator stays alive, sends finite numbers only, and can be reset.
VISCERA_CUTS: number of cuts, 1000 in the long form."""
import math
import os
import random
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy
from simulator_watch import Latest, SimulatorWatch, wait_until
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker

LIMIT_S = 30
RATE_HZ = 60
PRESSES = 10  # number of presses of a grip, 2 s each, or of a blade
SKIN = (0, -0.046, -0.02)  # [m] on the front of the phantom
BOUND_M = 1.5              # limit of the surface's vertices: solver.sleep_distance_m and the tissue's own size
BACK_M = 0.004             # after a reset the surface is where it was, except for its sag under gravity
CUTS = int(os.environ.get("VISCERA_CUTS", "200"))


class Senses:
    """Subscribes to everything that is published, and records whether a number was not finite."""

    def __init__(self):
        self.faults = []
        self.farthest_m = 0
        self.points = None
        self.marker = Latest("surface_marker", Marker, self.on_marker)
        self.forces = [Latest(name + "/body/servo_cf", WrenchStamped, self.on_force) for name in ("left", "right")]

    def on_marker(self, marker):
        self.points = [(p.x, p.y, p.z) for p in marker.points]
        far = max((max(abs(x) for x in p) for p in self.points), default=0)
        if not all(math.isfinite(x) for p in self.points for x in p):
            self.faults.append("a vertex of the skin is not finite")
        self.farthest_m = max(self.farthest_m, far)

    def on_force(self, message):
        f = message.wrench.force
        if not all(map(math.isfinite, (f.x, f.y, f.z))):
            self.faults.append("a force is not finite")


class AbuseTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("abuse_test")
        random.seed(1)
        cls.watch = SimulatorWatch()
        cls.senses = Senses()
        cls.poses = {n: rospy.Publisher(n + "/measured_cp", PoseStamped, queue_size=10) for n in ("left", "right")}
        cls.button1 = rospy.Publisher("left/button1", Joy, queue_size=10)
        cls.button2 = rospy.Publisher("right/button2", Joy, queue_size=10)
        cls.watch.wait_ready()
        wait_until(lambda: all(p.get_num_connections() for p in (*cls.poses.values(), cls.button1, cls.button2)),
                   LIMIT_S, "subscriber")
        wait_until(lambda: cls.senses.points, LIMIT_S, "skin at rest")
        cls.rest = cls.senses.points
        cls.rate = rospy.Rate(RATE_HZ)

    def move(self, name, x, y, z):
        message = PoseStamped()
        message.header.frame_id = "tissue"
        message.header.stamp = rospy.Time.now()
        message.pose.position.x, message.pose.position.y, message.pose.position.z = x, y, z
        message.pose.orientation.w = message.pose.orientation.x = math.sqrt(0.5)  # the shaft comes from -y
        self.poses[name].publish(message)
        self.rate.sleep()

    @staticmethod
    def press(publisher, pressed):
        message = Joy()
        message.header.stamp = rospy.Time.now()
        message.buttons = [1 if pressed else 0]
        publisher.publish(message)

    def assertAliveAndFinite(self):
        before = self.watch.value("simulation", "tick")
        wait_until(lambda: self.watch.value("simulation", "tick") > before, LIMIT_S, "tick")
        self.assertEqual(self.watch.value("simulation", "nonfinite_nodes"), 0)
        self.assertEqual(self.senses.faults, [])
        self.assertLess(self.senses.farthest_m, BOUND_M)

    def test_1_poses_that_are_not_finite(self):
        before = self.watch.value("left", "dropped_not_finite")
        for _ in range(100):
            self.move("left", float("nan"), 0, 0)
        wait_until(lambda: self.watch.value("left", "dropped_not_finite") > before, LIMIT_S, "dropped poses")
        self.assertAliveAndFinite()

    def test_2_probe_faster_than_sound(self):
        fastest = 0
        for i in range(2 * RATE_HZ):  # 1.7 m from one pose to the next: 100 m/s
            self.move("left", 0.85 * (-1) ** i, 0.02 * random.random(), -0.02)
            fastest = max(fastest, self.watch.value("simulation", "max_speed_m_per_s"))
        self.assertAliveAndFinite()
        self.assertGreater(fastest, 0)

    def test_3_grip_pulled_to_ten_times_the_size_of_the_tissue(self):
        x, y, z = SKIN
        for _ in range(RATE_HZ // 2):
            self.move("left", x, y, z)
        held = 0
        for _ in range(PRESSES):  # a busy machine may lose tracking during a press, and diagnostics come once a second
            self.press(self.button1, True)
            for _ in range(2 * RATE_HZ):
                self.move("left", x, y, z)
                held = self.watch.value("left", "nodes_held") or 0
                if held:
                    break
            if held:
                break
            self.press(self.button1, False)
            self.move("left", x, y, z)
        self.assertGreater(held, 0)
        for i in range(2 * RATE_HZ):
            self.move("left", x, y - 0.9 * min(1, i / RATE_HZ), z)
        self.press(self.button1, False)
        for _ in range(RATE_HZ):
            self.move("left", x, -0.9, z)
        self.assertAliveAndFinite()

    def test_4_many_cuts(self):
        for _ in range(RATE_HZ // 2):  # a button that is down when tracking begins does nothing
            self.move("right", 0.2, 0, 0)
        def springs_cut():
            return self.watch.value("simulation", "springs_cut")

        for _ in range(PRESSES):  # like those of a grip
            self.press(self.button2, True)
            for _ in range(CUTS // PRESSES):
                self.move("right", *(random.uniform(-0.06, 0.06) for _ in range(3)))
            if springs_cut():
                continue  # still pressed
            self.press(self.button2, False)
            self.move("right", 0.2, 0, 0)
        self.press(self.button2, False)
        wait_until(springs_cut, LIMIT_S, "springs cut")
        self.assertAliveAndFinite()

    def test_5_reset_makes_all_whole(self):
        for _ in range(RATE_HZ):
            self.move("left", 0.9, 0, 0)
            self.move("right", 0.9, 0, 0)
        self.assertTrue(rospy.ServiceProxy("reset", Trigger)().success)
        wait_until(lambda: self.watch.value("simulation", "springs_cut") == 0, LIMIT_S, "whole springs")

        def back():
            points = self.senses.points
            return len(points) == len(self.rest) and all(
                abs(a - b) < BACK_M for p, q in zip(points, self.rest) for a, b in zip(p, q))

        wait_until(back, LIMIT_S, "skin as it was at rest")
        self.assertAliveAndFinite()


if __name__ == "__main__":
    rostest.rosrun("viscera", "abuse", AbuseTest, sys.argv)
