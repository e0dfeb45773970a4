#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The tool viscera/Mouse in rviz: the position of the tip that the mouse moves, and the buttons that it presses."""
import math
import os
import subprocess
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from rviz_screen import MOUSE_SIGN, Screen, rviz
from sensor_msgs.msg import Joy
from sent_ball import RADIUS_M, Sender
from simulator_watch import Latest, wait_until

CONFIG = os.path.join(subprocess.check_output(["rospack", "find", "viscera"], text=True).strip(),
                      "config", "viscera_plugin.rviz")
LIMIT_S = 60      # software rendering on a busy machine
NEAR_M = 0.001    # of the ball's facets, and of a pixel at the focus of the view
STEP_M = 0.001    # of the wheel, in CONFIG


class RvizMouseTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.screen = Screen()
        cls.sender = None
        cls.rviz = rviz(CONFIG, lambda: cls.screen.find(MOUSE_SIGN) and cls.sent_ball(), 30)  # a pose with each
        cls.pose = Latest("left/measured_cp", PoseStamped)
        cls.pressed = {1: [], 2: []}
        cls.buttons = [Latest("left/button%d" % b, Joy, lambda joy, b=b: cls.pressed[b].append(joy.buttons[0]),
                              queue_size=10) for b in (1, 2)]

    @classmethod
    def tearDownClass(cls):
        cls.rviz.end()
        cls.screen.end()

    def distance(self):
        """Returns the distance of the tip from the ball's centre."""
        p = self.pose.message.pose.position
        return math.sqrt(p.x**2 + p.y**2 + p.z**2)

    def at(self, depth_m):
        wait_until(lambda: self.pose.message and abs(self.distance() - (RADIUS_M - depth_m)) < NEAR_M, LIMIT_S,
                   "tip %g mm behind the skin" % (1e3 * depth_m))

    def held(self, button, last):
        wait_until(lambda: self.pressed[button] and self.pressed[button][-1] == last, LIMIT_S,
                   "button %d, %d" % (button, last))

    def wheel(self, button, notches):
        for _ in range(notches):
            self.screen.do("click", button)

    @classmethod
    def ball(cls):
        """Returns the centre of the ball on the screen, by its red colour."""
        picture = cls.screen.picture()
        red = (picture[:, :, 0] > 1.5 * picture[:, :, 1]) & (picture[:, :, 0] > 40) & (picture[:, :, 1] > 10)
        rows, columns = red.nonzero()
        return (int(columns.mean()), int(rows.mean())) if len(rows) > 10000 else None

    @classmethod
    def sent_ball(cls):
        """Sends the ball repeatedly, as a simulator does: rviz subscribes more than once while it starts."""
        cls.sender = cls.sender or Sender()
        cls.sender.topology(1)
        cls.sender.vertices(1)
        return cls.ball()

    def test_mouse(self):
        middle = wait_until(self.sent_ball, LIMIT_S, "ball")
        self.screen.click(*wait_until(lambda: self.screen.find(MOUSE_SIGN), LIMIT_S, "tool in the toolbar"))
        self.screen.do("mousemove", middle[0], middle[1])
        self.screen.do("mousemove", middle[0] + 1, middle[1])
        self.at(-0.01)
        self.assertEqual(self.pose.message.header.frame_id, "tissue")
        self.screen.keep("mouse.ppm")

        self.wheel(4, 12)  # away from the user: deeper
        self.at(12 * STEP_M - 0.01)
        wait_until(lambda: self.pose.count > 50, LIMIT_S, "poses")
        self.wheel(5, 12)
        self.at(-0.01)

        self.screen.do("mousedown", 1)
        self.held(1, 1)
        before = self.pose.message.pose.position
        self.screen.do("mousemove", middle[0] + 60, middle[1] + 40)
        wait_until(lambda: math.dist((before.x, before.y, before.z),
                                     (self.pose.message.pose.position.x, self.pose.message.pose.position.y,
                                      self.pose.message.pose.position.z)) > 0.01, LIMIT_S, "tip that is dragged")
        self.screen.do("mouseup", 1)
        self.held(1, 0)
        self.screen.do("keydown", "2")
        self.held(2, 1)
        self.screen.do("keyup", "2")
        self.held(2, 0)

        # Another tool is chosen: poses end, and pressed buttons are released.
        self.screen.do("keydown", "1")
        self.held(1, 1)
        self.screen.do("key", "m")
        self.held(1, 0)
        count = self.pose.count
        rospy.sleep(1)
        self.assertLess(self.pose.count - count, 10)
        self.rviz.process.send_signal(2)
        self.assertEqual(self.rviz.process.wait(LIMIT_S), 0, self.rviz.output)


if __name__ == "__main__":
    rospy.init_node("rviz_mouse_test")
    rostest.rosrun("viscera", "rviz_mouse", RvizMouseTest, sys.argv)
