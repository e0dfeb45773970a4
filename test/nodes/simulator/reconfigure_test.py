#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Settings at run time with the stock client of dynamic_reconfigure: limits apply to the force at once, modes change in
both directions, and values out of range are refused."""
import math
import sys
import threading
import time
import unittest

import rospy
import rostest
from dynamic_reconfigure.client import Client
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Image
from simulator_watch import Latest, SimulatorWatch, wait_until
from viscera.srv import FileCommand, SetToolMode

START_LIMIT_S = 30
OUTSIDE_Y_M, DEEP_Y_M = -0.06, -0.022  # in front of the block, with its face at -0.02, and 6 mm deep in it for a ball of 8 mm
SLACK_N = 1e-6
SLOW_HZ, SHARE = 1.0, 0.8  # reduced rate of images, a fifteenth; share of their period that always passes between two


class StylusDevice:
    def __init__(self):
        self.y_m = self.at_m = OUTSIDE_Y_M  # goal, and where it is
        self.poses = rospy.Publisher("left/measured_cp", PoseStamped, queue_size=1, tcp_nodelay=True)
        threading.Thread(target=self.run, daemon=True).start()

    def run(self):
        while not rospy.is_shutdown():
            self.at_m += max(-0.0005, min(0.0005, self.y_m - self.at_m))
            pose = PoseStamped()
            pose.header.frame_id, pose.header.stamp = "tissue", rospy.Time.now()
            pose.pose.position.y, pose.pose.orientation.w = self.at_m, 1
            try:
                self.poses.publish(pose)
            except rospy.ROSException:  # the test ends
                return
            time.sleep(0.01)


class ReconfigureTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("reconfigure_test")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        cls.left = Client("simulator/left", timeout=START_LIMIT_S)
        cls.force = Latest("left/body/servo_cf", WrenchStamped)
        cls.hand = StylusDevice()

    def newtons(self):
        f = self.force.message.wrench.force if self.force.message else None
        return math.hypot(f.x, f.y, f.z) if f else 0

    def test_0_the_scene_is_what_it_begins_with(self):
        config = self.left.get_configuration(timeout=START_LIMIT_S)
        self.assertEqual(config["max_force_n"], 5)
        self.assertEqual((config["idle"], config["button1"], config["button2"]), ("probe", "grab", "cut"))
        self.assertEqual(Client("simulator", timeout=START_LIMIT_S).get_configuration(START_LIMIT_S)["surface_rate_hz"], 30)

    def test_1_a_limit_holds_the_force_and_lets_it_go_again(self):
        self.hand.y_m = DEEP_Y_M
        wait_until(lambda: self.newtons() > 0.1, 30, "force")
        for limit_n in (0.05, 0.02):
            self.assertEqual(self.left.update_configuration({"max_force_n": limit_n})["max_force_n"], limit_n)
            wait_until(lambda: abs(self.newtons() - limit_n) < SLACK_N, 10, "force of %g N" % limit_n)
        self.left.update_configuration({"max_force_n": 5})
        wait_until(lambda: self.newtons() > 0.1, 10, "force beyond the old limit")

    def test_2_out_of_range_is_refused(self):
        for bad in (-1.0, 5.1, 1e9, float("nan")):  # more than in the scene is unsafe for the user
            self.assertEqual(self.left.update_configuration({"max_force_n": bad})["max_force_n"], 5)
        for bad in (0.0, 100.1):  # N/s: a force that never fades out
            now = self.left.update_configuration({"max_force_rate_n_per_s": bad})
            self.assertEqual(now["max_force_rate_n_per_s"], 100)
        self.assertEqual(self.left.update_configuration({"idle": "laser"})["idle"], "probe")

    def test_3_modes_go_both_ways(self):
        self.left.update_configuration({"idle": "none"})
        wait_until(lambda: self.newtons() == 0, 10, "no force from a tool that does nothing")
        answer = rospy.ServiceProxy("set_tool_mode", SetToolMode)("left", "button1", "suction")
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: self.left.get_configuration(timeout=1)["button1"] == "suction", 10, "news of the mode")

    def test_4_a_loaded_state_tells_its_modes_and_leaves_the_limits(self):
        set_mode = rospy.ServiceProxy("set_tool_mode", SetToolMode)
        self.assertTrue(set_mode("left", "button2", "suction").success)
        self.left.update_configuration({"max_force_n": 0.5})
        saved = rospy.ServiceProxy("save_state", FileCommand)("reconfigure")
        self.assertTrue(saved.success, saved.message)
        self.assertTrue(set_mode("left", "button2", "cut").success)
        self.left.update_configuration({"idle": "probe", "max_force_n": 0.1})
        wait_until(lambda: self.left.get_configuration(timeout=1)["button2"] == "cut", 10, "news of the mode")
        self.hand.y_m = OUTSIDE_Y_M
        wait_until(lambda: self.newtons() == 0, 10, "stylus outside the tissue")
        loaded = rospy.ServiceProxy("load_state", FileCommand)("reconfigure")
        self.assertTrue(loaded.success, loaded.message)
        wait_until(lambda: self.left.get_configuration(timeout=1)["button2"] == "suction", 10, "news of the mode")
        self.assertEqual(self.left.get_configuration(timeout=1)["idle"], "none")
        self.assertEqual(self.left.get_configuration(timeout=1)["max_force_n"], 0.1)
        self.left.update_configuration({"idle": "probe"})
        wait_until(lambda: self.left.get_configuration(timeout=1)["idle"] == "probe", 10, "news of the mode")
        # A tip that becomes a probe within tissue does not push.
        wait_until(lambda: self.hand.at_m == OUTSIDE_Y_M, 10, "stylus outside")
        self.watch.wait_news()
        self.hand.y_m = DEEP_Y_M
        wait_until(lambda: self.newtons() > 0.09, 20, "force")
        wait_until(lambda: abs(self.watch.value("left", "force_n") - 0.1) < SLACK_N, 10, "force within the limit of now, in the diagnostics too")

    def test_5_the_rate_of_pictures_changes(self):
        # Judged by stamps: images may arrive late.
        stamps = []
        image = Latest("camera/image_raw", Image, lambda m: stamps.append(m.header.stamp.to_sec()), queue_size=100)
        wait_until(lambda: image.count > 3, 30, "pictures")
        camera = Client("simulator/cameras/camera", timeout=START_LIMIT_S)
        self.assertEqual(camera.update_configuration({"rate_hz": SLOW_HZ})["rate_hz"], SLOW_HZ)
        changed_s = rospy.get_time() + 1 / SLOW_HZ
        after = wait_until(lambda: (now := [s for s in stamps if s > changed_s])[3:] and now, 30, "pictures at the new rate")
        self.assertGreater(min(b - a for a, b in zip(after, after[1:])), SHARE / SLOW_HZ)


if __name__ == "__main__":
    rostest.rosrun("viscera", "reconfigure_test", ReconfigureTest, sys.argv)
