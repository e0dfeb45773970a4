#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Closing rviz at any time: while triangles change with every message, a service has not answered, the mouse moves a
stylus over the surface, and a simulator is killed meanwhile."""
import os
import signal
import subprocess
import sys
import time
import unittest

import rospy
import rostest
import stand_in_simulator
from geometry_msgs.msg import PoseStamped
from program import Program
from rviz_screen import MOUSE_SIGN, Screen, rviz
from simulator_watch import Latest, wait_until

CONFIG = os.path.join(subprocess.check_output(["rospack", "find", "viscera"], text=True).strip(),
                      "config", "viscera_plugin.rviz")
PAUSE = (0, 114, 178)  # icon on the button
LIMIT_S = 60           # software rendering on a busy machine
DEAD_S = 0.3           # time since the simulator was killed when rviz is closed: its connections break in between


class RvizClosingTest(unittest.TestCase):
    def setUp(self):
        self.simulator = Program(stand_in_simulator.COMMAND)
        self.screen = Screen()
        self.rviz = rviz(CONFIG, lambda: self.screen.find(MOUSE_SIGN) and self.screen.find(PAUSE) and self.screen.ball())
        self.pose = Latest("left/measured_cp", PoseStamped)

    def tearDown(self):
        self.rviz.end()
        self.simulator.end()
        self.screen.end()

    def beginAll(self):
        self.screen.click(*self.screen.find(PAUSE))
        self.simulator.said("asked")
        x, y = wait_until(self.screen.ball, LIMIT_S, "ball")
        self.screen.click(*wait_until(lambda: self.screen.find(MOUSE_SIGN), LIMIT_S, "tool in the toolbar"))
        self.screen.do("mousemove", x, y)
        self.screen.do("mousedown", 1)
        wait_until(lambda: self.pose.count, LIMIT_S, "pose of the mouse")
        for step in range(10):
            self.screen.do("mousemove", x + 4 * step, y)

    def close(self, how):
        self.screen.keep("closing_%s.ppm" % how)
        self.assertIsNone(self.rviz.process.poll(), "rviz has ended: " + self.rviz.output)
        if how == "window":
            self.screen.do("key", "ctrl+q")
        else:
            self.rviz.process.send_signal(how)
        self.assertEqual(self.rviz.process.wait(LIMIT_S), 0, self.rviz.output)


def test(how, dies):
    def run(self):
        self.beginAll()
        if dies:
            self.simulator.process.send_signal(signal.SIGKILL)
            time.sleep(DEAD_S)
        self.close(how)
    return run


for name, how in (("interrupt", signal.SIGINT), ("window", "window")):
    setattr(RvizClosingTest, "test_by_" + name, test(how, False))
    setattr(RvizClosingTest, "test_by_%s_when_the_simulator_was_killed" % name, test(how, True))


if __name__ == "__main__":
    rospy.init_node("rviz_closing_test")
    rostest.rosrun("viscera", "rviz_closing", RvizClosingTest, sys.argv)
