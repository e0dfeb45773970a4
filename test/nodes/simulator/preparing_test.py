#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""What rviz shows while a scene is created: a text that counts up and disappears when the tissue exists, or gives the
reason of a failure."""
import re
import sys
import unittest

import rospy
import rostest
from program import Program, node
from simulator_watch import READY_LIMIT_S, wait_until
from visualization_msgs.msg import Marker, MarkerArray


class PreparingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("preparing_test")

    def setUp(self):
        self.events = []  # texts; "" when one disappears; "tissue"
        self.subscribers = [rospy.Subscriber("scene_markers", MarkerArray, self.on_markers, queue_size=1000),
                            rospy.Subscriber("surface_marker", Marker, self.on_tissue, queue_size=1000)]

    def tearDown(self):
        self.program.end()
        for subscriber in self.subscribers:
            subscriber.unregister()

    def on_markers(self, array):
        for marker in array.markers:
            if marker.ns != "preparing" or marker.action == Marker.DELETEALL:
                continue
            self.assertEqual(marker.type, Marker.TEXT_VIEW_FACING)
            self.events.append(marker.text if marker.action == Marker.ADD else "")

    def on_tissue(self, marker):
        if marker.action == Marker.ADD and marker.points:
            self.events.append("tissue")

    def start(self, *parameters):
        self.program = Program([node("simulator")] + list(parameters))

    def test_the_text_counts_up_until_the_tissue_is_there(self):
        self.start("_scene:=heart", "_overrides:=bodies[0].spacing_m=0.004")
        wait_until(lambda: "tissue" in self.events and "" in self.events, READY_LIMIT_S, "tissue")
        texts = [event for event in self.events[:self.events.index("")] if event != "tissue"]
        for text in texts:
            self.assertRegex(text, r"^preparing: \d+ %$")
        percents = [int(re.search(r"\d+", text).group()) for text in texts]
        self.assertGreater(len(percents), 3, percents)
        self.assertEqual(percents, sorted(percents))
        self.assertLess(percents[-1], 100)
        # One thread sends both, the tissue first; the two topics may still arrive in the other order.
        self.assertEqual([event for event in self.events[self.events.index(""):] if "%" in event], [])

    def test_what_ends_the_making_is_said(self):
        self.start("_scene:=heart", "_overrides:=bodies[0].fixed=[{shape: sphere, radius_m: 1}]")
        wait_until(lambda: [e for e in self.events if "every node of the scene is fixed" in e], READY_LIMIT_S, "the error")
        self.assertNotIn("\n", self.events[-1])
        self.program.said("every node of the scene is fixed")


if __name__ == "__main__":
    rostest.rosrun("viscera", "preparing_test", PreparingTest, sys.argv)
