#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Two simulators on one master, each with a namespace and a frame prefix: their frames and topics are separate."""
import collections
import sys
import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import CameraInfo
from simulator_watch import Latest, READY_LIMIT_S, wait_until
from tf2_msgs.msg import TFMessage

LIMIT_S = 20
WATCHED_S = 4
SIDES = {"a": -0.2, "b": 0.2}  # [m] x of each one's left tool
STILL_M = 1e-6                 # a tool that is not moved stays, except for rounding


class TwoSimulatorsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("two_simulators_test")
        cls.parents = collections.defaultdict(set)
        cls.senders = collections.defaultdict(set)
        cls.places = collections.defaultdict(set)
        cls.hands = {side: rospy.Publisher(side + "/left/measured_cp", PoseStamped, queue_size=1) for side in SIDES}
        cls.tf = [Latest(topic, TFMessage, cls.on_tf) for topic in ("/tf", "/tf_static")]
        wait_until(lambda: all(hand.get_num_connections() for hand in cls.hands.values()), READY_LIMIT_S, "simulators")
        threading.Thread(target=cls.send, daemon=True).start()
        wait_until(lambda: cls.frames_expected().keys() <= cls.parents.keys(), READY_LIMIT_S, "frames")
        time.sleep(WATCHED_S)

    @staticmethod
    def frames_expected():
        """Returns the parents of each frame."""
        expected = {}
        for side in SIDES:
            expected[side + "/tissue"] = {"world"}
            expected[side + "/left_tool"] = {side + "/tissue"}
            expected[side + "/camera_optical_frame"] = {side + "/tissue"}
        return expected

    @classmethod
    def send(cls):
        while not rospy.is_shutdown():
            for side, x in SIDES.items():
                message = PoseStamped()  # no frame: the tissue's, whatever its name
                message.header.stamp = rospy.Time.now()
                message.pose.position.x = x
                message.pose.orientation.w = 1
                cls.hands[side].publish(message)
            time.sleep(0.02)

    @classmethod
    def on_tf(cls, message):
        for transform in message.transforms:
            cls.parents[transform.child_frame_id].add(transform.header.frame_id)
            cls.senders[transform.child_frame_id].add(message._connection_header["callerid"])
            cls.places[transform.child_frame_id].add(round(transform.transform.translation.x, 6))

    def test_each_has_a_tree_of_its_own_below_the_world(self):
        self.assertEqual(dict(self.parents), self.frames_expected())

    def test_each_frame_has_one_sender(self):
        for frame, senders in self.senders.items():
            self.assertEqual(senders, {"/" + frame[0] + "/simulator"}, frame)

    def test_no_tool_jumps(self):
        for side, x in SIDES.items():
            self.assertEqual(len(self.places[side + "/left_tool"]), 1)
            self.assertAlmostEqual(min(self.places[side + "/left_tool"]), x, delta=STILL_M)

    def test_topics_are_apart_and_messages_name_their_frames(self):
        for side in SIDES:
            force = Latest(side + "/left/body/servo_cf", WrenchStamped)
            info = Latest(side + "/camera/camera_info", CameraInfo)
            wait_until(lambda: force.count and info.count, LIMIT_S, "messages of " + side)
            self.assertEqual(force.message.header.frame_id, side + "/tissue")
            self.assertEqual(info.message.header.frame_id, side + "/camera_optical_frame")


if __name__ == "__main__":
    rostest.rosrun("viscera", "two_simulators_test", TwoSimulatorsTest, sys.argv)
