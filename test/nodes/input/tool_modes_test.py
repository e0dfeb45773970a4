#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""set_tool_mode: tool modes change while running and paused, with bit-identical results, and wrong names are
reported."""
import sys
import unittest

import rospy
import rostest
from simulator_watch import READY_LIMIT_S, SimulatorWatch
from std_srvs.srv import Trigger
from viscera.msg import StylusState
from viscera.srv import SetToolMode, Step

TICKS = 8


class ToolModesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("tool_modes_test")
        SimulatorWatch().wait_ready()
        for name in ("set_tool_mode", "step", "pause", "resume", "reset"):
            rospy.wait_for_service(name, READY_LIMIT_S)
        cls.set_mode = rospy.ServiceProxy("set_tool_mode", SetToolMode)
        cls.step = rospy.ServiceProxy("step", Step)
        cls.pause, cls.reset = rospy.ServiceProxy("pause", Trigger), rospy.ServiceProxy("reset", Trigger)

    def refused(self, text, *request):
        answer = self.set_mode(*request)
        self.assertFalse(answer.success)
        self.assertIn(text, answer.message)

    def test_0_wrong_names_are_told(self):
        self.refused("the scene has no stylus 'middle'; it has right, left", "middle", "idle", "probe")
        self.refused("'button3' is not one of idle, button1, button2", "left", "button3", "probe")
        self.refused("mode: 'laser' is not one of grasper, none, cautery, probe, grab", "left", "idle", "laser")

    def test_1_running(self):
        self.assertTrue(self.set_mode("left", "button1", "suction").success)

    def pulled(self, mode):
        """Returns the hash after the left stylus was in the front wall with button 1 down, in that mode, and was drawn
        out."""
        self.assertTrue(self.reset().success)
        self.assertTrue(self.set_mode("left", "button1", mode).success)
        for y_m in (-0.055, -0.07):
            state = StylusState(stylus="left", button1=True)
            state.pose.position.y, state.pose.position.z, state.pose.orientation.w = y_m, -0.02, 1
            answer = self.step(ticks=TICKS, styluses=[state])
            self.assertTrue(answer.success, answer.message)
        return answer.state_hash

    def test_2_paused_and_to_the_bit(self):
        self.assertTrue(self.pause().success)
        grabbed, idle = self.pulled("grab"), self.pulled("none")
        self.assertNotEqual(grabbed, idle)
        self.assertEqual(grabbed, self.pulled("grab"))


if __name__ == "__main__":
    rostest.rosrun("viscera", "tool_modes_test", ToolModesTest, sys.argv)
