#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""An obstacle on a tf frame: it stays and warns while the frame is unknown, then follows the frame and pushes."""
import sys
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import TransformStamped
from simulator_watch import Latest, SimulatorWatch, wait_until
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker

BELOW_M, ABOVE_M = -0.03, 0.01  # heights of the plate's top
TOP_M = -0.05  # of the plate in its frame
UNDERSIDE_M = -0.01  # of the block at rest
TOLERANCE_M = 5e-4  # surface and nodes of a block that is pushed


class MovingObstacleTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("moving_obstacle_test")
        cls.frames = rospy.Publisher("/tf", TFMessage, queue_size=10)
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        cls.marker = Latest("surface_marker", Marker)

    def place(self, top_m):
        transform = TransformStamped()
        transform.header.stamp = rospy.Time.now()
        transform.header.frame_id = "tissue"
        transform.child_frame_id = "lift"
        transform.transform.translation.z = top_m - TOP_M
        transform.transform.rotation.w = 1
        self.frames.publish([transform])

    def lowest(self):
        message = self.marker.message
        return min(point.z for point in message.points) if message and message.points else None

    def test_0_an_unknown_frame_is_counted_and_moves_nothing(self):
        wait_until(lambda: (self.watch.value("obstacles", "frames_missed") or 0) > 0, 10, "missed frame")
        self.assertEqual(self.watch.value("obstacles", "frames_found"), 0)
        wait_until(lambda: "is unknown" in self.watch.status("obstacles").message, 10, "warning")
        self.assertAlmostEqual(wait_until(self.lowest, 10, "surface"), UNDERSIDE_M, delta=TOLERANCE_M)

    def test_1_the_obstacle_goes_where_its_frame_goes(self):
        steps = 100
        for step in range(steps + 1):
            self.place(BELOW_M + (ABOVE_M - BELOW_M) * step / steps)
            time.sleep(0.02)
        wait_until(lambda: (self.watch.value("obstacles", "frames_found") or 0) > 0, 10, "found frame")
        wait_until(lambda: (self.lowest() or BELOW_M) > ABOVE_M - TOLERANCE_M, 10, "block on the plate")

    def test_2_a_frame_that_jumps_is_held_back_and_counted(self):
        self.assertEqual(self.watch.value("obstacles", "ticks_speed_limited"), 0)
        jumps = 0

        def speed_limited():
            """Jumps again: a transform that is sent once is soon too old, which is reported instead of the jump."""
            nonlocal jumps
            jumps += 1
            self.place(BELOW_M - 1 - jumps % 2)  # a metre in a tick is faster than any wave in tissue
            return (self.watch.value("obstacles", "ticks_speed_limited") or 0) > 0 and "speed limited" in self.watch.status(
                "obstacles"
            ).message

        wait_until(speed_limited, 10, "warning that the obstacle is held back, and how often")


if __name__ == "__main__":
    rostest.rosrun("viscera", "moving_obstacle", MovingObstacleTest, sys.argv)
