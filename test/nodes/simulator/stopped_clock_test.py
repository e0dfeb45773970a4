#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""ROS time may stop, as when a bag is paused; the tissue must not."""
import sys
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image
from simulator_watch import Latest, SimulatorWatch, wait_until

LIMIT_S = 20
STOPPED_AT = rospy.Time(1234)


class StoppedClockTest(unittest.TestCase):
    def test_physics_runs_on_and_stamps_stand_still(self):
        rospy.init_node("stopped_clock_test")
        watch = SimulatorWatch()
        clock = rospy.Publisher("/clock", Clock, queue_size=1, latch=True)
        clock.publish(Clock(STOPPED_AT))
        watch.wait_ready()
        before = watch.value("simulation", "tick")
        wait_until(lambda: watch.value("simulation", "tick") > before, LIMIT_S, "tick while ROS time stands still")
        image = Latest("camera/image_raw", Image)
        wait_until(lambda: image.count > 1, LIMIT_S, "image while ROS time stands still")
        time.sleep(0.5)
        self.assertEqual(image.message.header.stamp, STOPPED_AT)
        self.assertGreater(watch.value("pace", "real_time_factor"), 0)


if __name__ == "__main__":
    rostest.rosrun("viscera", "stopped_clock_test", StoppedClockTest, sys.argv)
