#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The session continues whatever a device sends: bad messages are dropped and counted by reason."""
import sys
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped, TransformStamped, WrenchStamped
from program import Program
from sensor_msgs.msg import Joy
from simulator_watch import Latest, SimulatorWatch, wait_until
from tf2_msgs.msg import TFMessage

LIMIT_S = 20
AWAY_M = 0.5     # far from the tissue, inside the workspace
NAN, INF = float("nan"), float("inf")


def pose(x=AWAY_M, qw=1.0, frame="tissue"):
    message = PoseStamped()
    message.header.frame_id = frame
    message.header.stamp = rospy.Time.now()
    message.pose.position.x = x
    message.pose.orientation.w = qw
    return message


def invalid_pose():
    message = pose()
    message.header.stamp = rospy.Time(0)
    return message


class InputFaultsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("input_faults_test")
        cls.watch = SimulatorWatch()
        cls.force = Latest("left/body/servo_cf", WrenchStamped)
        cls.tool = {}
        cls.tf = Latest("/tf", TFMessage, cls.on_tf)
        cls.poses = rospy.Publisher("left/measured_cp", PoseStamped, queue_size=10)
        cls.buttons = rospy.Publisher("left/button1", Joy, queue_size=10)
        cls.watch.wait_ready()
        wait_until(lambda: cls.poses.get_num_connections() and cls.buttons.get_num_connections(), LIMIT_S, "subscriber")

    @classmethod
    def on_tf(cls, message):
        for transform in message.transforms:
            cls.tool[transform.child_frame_id] = transform.transform.translation

    def count_of(self, reason):
        return self.watch.value("left", "dropped_" + reason)

    def assertDropped(self, *faults):
        """Asserts that each fault is counted under its reason, nothing is accepted, and time advances. @param faults 
        publisher, function that creates a message, and its reason. Only the newest pose is evaluated, so all are sent
        until they are counted"""
        before, tick = {reason: self.count_of(reason) for _, _, reason in faults}, self.watch.value("simulation", "tick")
        accepted = self.watch.value("left", "poses_accepted")

        def counted():
            left = [fault for fault in faults if self.count_of(fault[2]) == before[fault[2]]]
            for publisher, make, _ in left:
                publisher.publish(make())
                time.sleep(0.02)
            return not left
        wait_until(counted, LIMIT_S, "drops because of " + ", ".join(before))
        wait_until(lambda: self.watch.value("simulation", "tick") > tick, LIMIT_S, "tick after " + ", ".join(before))
        self.assertEqual(self.watch.value("left", "poses_accepted"), accepted)
        self.assertEqual(self.watch.value("simulation", "nonfinite_nodes"), 0)

    def assertAccepted(self, message):
        before = self.watch.value("left", "poses_accepted")
        self.poses.publish(message)
        wait_until(lambda: self.watch.value("left", "poses_accepted") > before, LIMIT_S, "accepted pose")

    def test_bad_poses_and_buttons_are_counted_by_reason(self):
        self.assertDropped((self.poses, lambda: pose(x=NAN), "not_finite"), (self.poses, lambda: pose(qw=0), "bad_quaternion"),
                           (self.poses, invalid_pose, "stamp_zero"), (self.poses, lambda: pose(frame="moon"), "no_transform"),
                           (self.poses, lambda: pose(x=1000), "outside_workspace"), (self.buttons, Joy, "no_buttons"),
                           (self.buttons, lambda: Joy(buttons=[7]), "button_value"))
        self.watch.wait_news()  # all of these are counted
        self.assertDropped((self.poses, lambda: pose(x=INF), "not_finite"))
        self.watch.wait_news()
        self.assertDropped((self.poses, lambda: pose(qw=NAN), "not_finite"))

    def test_session_takes_good_poses_after_bad_ones(self):
        self.poses.publish(pose(x=NAN))
        self.assertAccepted(pose())
        self.assertAccepted(pose(frame="world"))
        self.assertAccepted(pose(frame=""))  # like crtk_python_client: in the tissue frame
        status = self.watch.status("simulation")
        self.assertEqual((status.level, status.message), (DiagnosticStatus.OK, "running"))

    def test_two_nodes_that_send_poses_are_named(self):
        other = Program(["rostopic", "pub", "-r", "20", "left/measured_cp", "geometry_msgs/PoseStamped",
                         "{header: {stamp: now, frame_id: tissue}, pose: {position: {x: 0.4}, orientation: {w: 1}}}"])
        try:
            def named():
                self.poses.publish(pose())
                message = self.watch.status("left").message
                return rospy.get_name() in message and "/rostopic_" in message

            wait_until(named, LIMIT_S, "warning that names both")
            self.assertEqual(self.watch.status("left").level, DiagnosticStatus.WARN)
        finally:
            other.end()  # rospy may deadlock if a signal arrives while it publishes
        wait_until(lambda: "several" not in self.watch.status("left").message, LIMIT_S, "end of the warning")

    def test_pose_in_the_frame_of_a_device_is_brought_to_the_tissue(self):
        static = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        base = TransformStamped()
        base.header.frame_id, base.child_frame_id = "world", "device_base"
        base.header.stamp = rospy.Time.now()
        base.transform.translation.y = 0.3
        base.transform.rotation.z = base.transform.rotation.w = 0.5 ** 0.5  # a quarter turn about z
        static.publish(TFMessage([base]))
        wait_until(static.get_num_connections, LIMIT_S, "tf listener")

        def arrived():
            self.poses.publish(pose(frame="device_base"))
            tip = self.tool.get("left_tool")
            return tip and abs(tip.x) < 1e-9 and abs(tip.y - (0.3 + AWAY_M)) < 1e-9

        wait_until(arrived, LIMIT_S, "tool where tf puts it")
        wait_until(lambda: self.force.message and self.force.message.header.frame_id == "device_base", LIMIT_S,
                   "force in the frame of the device")


if __name__ == "__main__":
    rostest.rosrun("viscera", "input_faults_test", InputFaultsTest, sys.argv)
