#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Styluses without a device: a marker of rviz pushes the tissue, and a gamepad drives a tip."""
import math
import subprocess
import sys
import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy
from simulator_watch import Latest, SimulatorWatch, wait_until
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit

LIMIT_S = 20
SPEED_M_PER_S = 0.1                # the default of both nodes
BUSY = 1.5                         # stamps of a busy machine: a step may be told late
JOY_HZ = 50
FELT_N = 0.02


class Path:
    """Poses of a stylus, as (stamp, place)."""

    def __init__(self, stylus):
        self.places = []
        self.topic = Latest(stylus + "/measured_cp", PoseStamped, self.note, queue_size=1000)

    def note(self, message):
        p = message.pose.position
        self.places.append((message.header.stamp.to_sec(), (p.x, p.y, p.z)))

    def at(self):
        return self.places[-1][1]

    def fastest(self, window_s=0.2):
        """Over windows that are long beside what a busy machine adds to stamps."""
        fastest, first = 0, 0
        for stamp, place in self.places:
            while stamp - self.places[first][0] > window_s:
                fastest = max(fastest, math.dist(place, self.places[first][1]) / (stamp - self.places[first][0]))
                first += 1
        return fastest


class Gamepad:
    def __init__(self):
        self.publisher = rospy.Publisher("joy", Joy, queue_size=1)
        self.message = None
        threading.Thread(target=self.play, daemon=True).start()

    def play(self):
        while not rospy.is_shutdown():
            if self.message:
                self.publisher.publish(self.message)
            time.sleep(1 / JOY_HZ)


class SteeringTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("steering_test")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        cls.left, cls.right = Path("left"), Path("right")
        cls.buttons = {name: Latest(name, Joy) for name in ("left/button1", "left/button2", "right/button1", "right/button2")}
        cls.feedback = rospy.Publisher("left/marker/feedback", InteractiveMarkerFeedback, queue_size=10)
        wait_until(lambda: cls.feedback.get_num_connections() and cls.left.places, LIMIT_S, "stylus_marker")

    def down(self, name):
        message = self.buttons[name].message
        return bool(message and message.buttons[0])

    def drag(self, at, frame="tissue"):
        message = InteractiveMarkerFeedback(marker_name="stylus", client_id="test",
                                            event_type=InteractiveMarkerFeedback.POSE_UPDATE)
        message.header.frame_id = frame
        p = message.pose.position
        p.x, p.y, p.z = at
        message.pose.orientation.x = message.pose.orientation.w = math.sqrt(0.5)
        self.feedback.publish(message)

    def choose(self, title):
        """An entry of the menu, as rviz would."""
        shown = Latest("left/marker/update_full", InteractiveMarkerInit)
        wait_until(lambda: shown.message, LIMIT_S, "marker")
        shown.stop()
        entry = next(e.id for e in shown.message.markers[0].menu_entries if title in e.title)
        self.feedback.publish(InteractiveMarkerFeedback(marker_name="stylus", client_id="test", menu_entry_id=entry,
                                                        event_type=InteractiveMarkerFeedback.MENU_SELECT))

    def test_1_marker_pushes_the_tissue_at_a_limited_speed(self):
        force = Latest("left/body/servo_cf", WrenchStamped)
        self.drag((0, -0.05, -0.02))               # the mouse jumps by 5 cm
        wait_until(lambda: math.dist(self.left.at(), (0, -0.05, -0.02)) < 1e-9, LIMIT_S, "tip at the marker")
        self.assertLess(self.left.fastest(), BUSY * SPEED_M_PER_S)
        wait_until(lambda: force.message and force.message.wrench.force.y < -FELT_N, LIMIT_S, "force out of the tissue")
        self.drag((0, 0, 0), "camera_optical_frame")   # another frame: dropped
        self.drag((math.nan, 0, 0))
        time.sleep(0.3)
        self.assertLess(math.dist(self.left.at(), (0, -0.05, -0.02)), 1e-9)
        self.choose("Back to the start")
        wait_until(lambda: math.dist(self.left.at(), (0, -0.1, -0.02)) < 1e-9, LIMIT_S, "tip at the start")

    def test_2_menu_presses_the_buttons(self):
        for number in (1, 2):
            name = "left/button%d" % number
            self.choose("Button %d" % number)
            wait_until(lambda: self.down(name), LIMIT_S, name)
            self.choose("Button %d" % number)
            wait_until(lambda: not self.down(name), LIMIT_S, name)

    def test_3_poses_come_steadily_while_nothing_moves(self):
        before = len(self.left.places)
        time.sleep(2)
        self.assertGreater(len(self.left.places) - before, 100)   # half of what ~rate_hz asks for
        self.assertFalse(self.watch.status("left").message.startswith("stale"))

    def test_4_gamepad_drives_the_tip(self):
        self.assertFalse(self.right.places)        # no stylus before there is a gamepad
        pad = Gamepad()
        pad.message = Joy(axes=[0, 0.05], buttons=[0, 0])   # within the dead zone
        wait_until(lambda: len(self.right.places) > 20, LIMIT_S, "poses")
        self.assertEqual(self.right.at(), (0.1, 0, 0))
        pad.message = Joy(axes=[0, -1], buttons=[0, 1])
        wait_until(lambda: self.right.at()[0] < 0.08, LIMIT_S, "way of 2 cm")
        self.assertLess(self.right.fastest(), BUSY * SPEED_M_PER_S)
        wait_until(lambda: self.down("right/button2") and not self.down("right/button1"), LIMIT_S, "button 2")
        wait_until(lambda: self.right.at()[0] < 0.0501, LIMIT_S, "end of its reach")
        time.sleep(0.3)
        self.assertAlmostEqual(self.right.at()[0], 0.05)
        pad.message = Joy(axes=[0.55, 0], buttons=[0, 1])
        wait_until(lambda: self.right.topic.message.pose.orientation.x < -0.1, LIMIT_S, "turn")
        pad.message = None                         # unplugged
        wait_until(lambda: not self.down("right/button2"), LIMIT_S, "button let go")
        stands, count = self.right.topic.message.pose.orientation.x, len(self.right.places)
        wait_until(lambda: len(self.right.places) > count + 20, LIMIT_S, "poses of a hand that stands still")
        self.assertEqual(self.right.topic.message.pose.orientation.x, stands)

    def test_5_bad_parameters_are_refused(self):
        for number, (node, argument, words) in enumerate((("stylus_joy", "_axes:=0 1 2", "~axes: must be six words"),
                                                          ("stylus_marker", "_start:=0 0 1", "~start: must be 6 numbers"),
                                                          ("stylus_marker", "_axes:=none", "~axes: unknown"),
                                                          ("stylus_joy", "_dead_zone:=2", "~dead_zone: must be a number, 0..0.9"))):
            done = subprocess.run(["rosrun", "viscera", node, "__name:=refused%d" % number, argument], text=True, timeout=LIMIT_S,
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertIn(words, done.stdout)


if __name__ == "__main__":
    rostest.rosrun("viscera", "steering_test", SteeringTest, sys.argv)
