#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Obstacles measure the load on them: a table measures the block's weight, a wall without contact measures nothing."""
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import WrenchStamped
from simulator_watch import Latest, SimulatorWatch, wait_until

WEIGHT_N = 0.02**3 * 1000 * 9.81
TOLERANCE_N = 0.01 * WEIGHT_N  # required accuracy; the block settles within a second


class ObstacleForceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("obstacle_force_test")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        cls.table = Latest("obstacles/table/force", WrenchStamped)
        cls.wall = Latest("obstacles/wall/force", WrenchStamped)

    def test_the_table_bears_the_weight_and_the_wall_nothing(self):
        def borne():
            message = self.table.message
            return message is not None and abs(message.wrench.force.z + WEIGHT_N) < TOLERANCE_N

        wait_until(borne, 30, "the block's weight on the table")
        message = self.table.message
        self.assertEqual(message.header.frame_id, "tissue")
        self.assertLess(abs(message.wrench.force.x) + abs(message.wrench.force.y), TOLERANCE_N)
        wall = wait_until(lambda: self.wall.message, 10, "a message for the wall").wrench
        self.assertEqual((wall.force.x, wall.force.y, wall.force.z), (0, 0, 0))


if __name__ == "__main__":
    rostest.rosrun("viscera", "obstacle_force", ObstacleForceTest, sys.argv)
