#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A gripper opens and closes a grasper. Tissue between its jaws is held and keeps them open; jaw/measured_js reports
both."""
import sys
import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState
from simulator_watch import Latest, SimulatorWatch, wait_until
from std_srvs.srv import Trigger
from viscera.msg import Samples, StylusState
from viscera.srv import Step

LIMIT_S = 20
RATE_HZ = 100
ANGLE = 1e-6                       # rad: rounding of a float
OUTSIDE, IN_WALL = -0.1, -0.055    # y of the tip, m: in front of the block's front wall, and in it


class JawsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("jaws_test")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        cls.poses = rospy.Publisher("left/measured_cp", PoseStamped, queue_size=1)
        cls.gripper = rospy.Publisher("left/gripper/measured_js", JointState, queue_size=10)
        cls.jaw = Latest("left/jaw/measured_js", JointState)
        cls.samples = Latest("samples", Samples)
        cls.y_m, cls.angle_rad = OUTSIDE, 0.5
        threading.Thread(target=cls.play, daemon=True).start()
        wait_until(lambda: cls.poses.get_num_connections() and cls.gripper.get_num_connections(), LIMIT_S, "listener")
        wait_until(lambda: cls.jaw.message, LIMIT_S, "jaw/measured_js")

    @classmethod
    def play(cls):
        while not rospy.is_shutdown():
            pose = PoseStamped()
            pose.header.stamp, pose.header.frame_id = rospy.Time.now(), "tissue"
            pose.pose.position.y, pose.pose.position.z, pose.pose.orientation.w = cls.y_m, -0.02, 1
            cls.poses.publish(pose)
            if cls.angle_rad is not None:
                cls.gripper.publish(JointState(position=[cls.angle_rad]))
            time.sleep(1 / RATE_HZ)

    def measures(self, angle_rad):
        wait_until(lambda: abs(self.jaw.message.position[0] - angle_rad) < ANGLE, LIMIT_S, "jaws at %g rad" % angle_rad)

    def close(self, angle_rad):
        type(self).angle_rad = angle_rad

    def test_0_jaws_follow_and_are_told(self):
        self.measures(0.5)
        self.close(0.3)
        self.measures(0.3)
        self.assertEqual(self.jaw.message.name, ["jaw"])
        self.assertEqual(list(self.jaw.message.effort), [0])
        state = wait_until(lambda: self.samples.message and self.samples.message.styluses, LIMIT_S, "sample")[0]
        self.assertTrue(state.has_jaw)
        self.close(-0.05)  # a gripper with a small zero offset
        self.measures(0)

    def test_1_what_is_no_angle_is_dropped_and_counted(self):
        self.close(0.4)
        self.measures(0.4)
        self.close(None)
        for bad, reason in ((float("nan"), "not_finite"), (90.0, "jaw_angle")):
            before = self.watch.value("left", "dropped_" + reason) or 0
            self.gripper.publish(JointState(position=[bad]))
            wait_until(lambda: self.watch.value("left", "dropped_" + reason) == before + 1, LIMIT_S, reason)
        before = self.watch.value("left", "dropped_no_buttons") or 0
        self.gripper.publish(JointState())
        wait_until(lambda: self.watch.value("left", "dropped_no_buttons") == before + 1, LIMIT_S, "count")
        self.measures(0.4)

    def test_2_tissue_between_them_is_held_and_keeps_them_open(self):
        self.close(0.65)
        self.measures(0.65)
        type(self).y_m = IN_WALL
        time.sleep(1)
        self.close(0.05)
        wait_until(lambda: (self.watch.value("left", "nodes_held") or 0) > 0, LIMIT_S, "tissue in the jaws")
        wait_until(lambda: self.jaw.message.effort[0] > 0, LIMIT_S, "moment")
        self.assertGreater(self.jaw.message.position[0], 0.05 + ANGLE)
        self.close(0.69)
        wait_until(lambda: self.watch.value("left", "nodes_held") == 0, LIMIT_S, "open jaws")
        type(self).y_m = OUTSIDE

    def test_3_steps_take_an_opening_and_refuse_what_is_none(self):
        self.assertTrue(rospy.ServiceProxy("pause", Trigger)().success)
        step = rospy.ServiceProxy("step", Step)
        state = StylusState(stylus="left", has_jaw=True, jaw_rad=0.2)
        state.pose.position.y, state.pose.orientation.w = OUTSIDE, 1
        self.assertTrue(step(ticks=2, styluses=[state]).success)
        self.measures(0.2)
        state.jaw_rad = 4
        answer = step(ticks=1, styluses=[state])
        self.assertFalse(answer.success)
        self.assertIn("jaw_rad of 'left' must be 0 .. 3.1416 rad", answer.message)


if __name__ == "__main__":
    rostest.rosrun("viscera", "jaws_test", JawsTest, sys.argv)
