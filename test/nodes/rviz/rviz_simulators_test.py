#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""rviz with no simulator, with one, with two in one namespace, and with one that is restarted."""
import os
import subprocess
import sys
import time
import unittest

import rospy
import rostest
import stand_in_simulator
from program import Program
from rviz_screen import MOUSE_SIGN, Screen, rviz
from simulator_watch import wait_until

from viscera.msg import SurfaceVertices

CONFIG = os.path.join(subprocess.check_output(["rospack", "find", "viscera"], text=True).strip(),
                      "config", "viscera_plugin.rviz")
PAUSE = (0, 114, 178)  # icon on the button, grey without a simulator
WARNING = (192, 64, 0)  # of text in the panel
DISPLAY_WARNING = (192, 128, 0)  # of the name of a display, as rviz paints it
WARNED_S = 2           # time after the simulator was killed
LIMIT_S = 60           # software rendering on a busy machine


class RvizSimulatorsTest(unittest.TestCase):
    def setUp(self):
        self.screen = Screen()
        self.rviz = rviz(CONFIG, lambda: self.screen.find(MOUSE_SIGN) and self.screen.draws())
        self.simulators = []

    def tearDown(self):
        for program in [self.rviz, *self.simulators]:
            program.end()
        self.screen.end()

    def start(self):
        self.simulators.append(Program(stand_in_simulator.COMMAND))
        return self.simulators[-1]

    def expect(self, buttons, warning, what):
        def seen():
            self.assertIsNone(self.rviz.process.poll(), "rviz has ended: " + self.rviz.output)
            return bool(self.screen.find(PAUSE)) == buttons and bool(self.screen.find(WARNING)) == warning
        wait_until(seen, LIMIT_S, what)
        self.screen.keep(what.replace(" ", "_") + ".ppm")

    def expect_ball(self, is_there, what):
        try:
            wait_until(lambda: bool(self.screen.ball()) == is_there, LIMIT_S, what)
        except AssertionError as error:
            self.screen.keep("no_%s.ppm" % what.replace(" ", "_"))
            raise AssertionError("%s; rviz, which returned %s, said: %s" % (error, self.rviz.process.poll(), self.rviz.output))

    def test_none_one_two_and_one_that_comes_again(self):
        self.expect(False, False, "panel without a simulator")
        self.assertIsNone(self.screen.ball())
        first = self.start()
        self.expect(True, False, "panel of a simulator")
        self.expect_ball(True, "ball of the first simulator")
        second = self.start()
        self.expect(True, True, "warning of two simulators")
        first.end()
        self.expect(True, False, "panel of the one that is left")
        second.process.kill()
        wait_until(lambda: self.screen.find(DISPLAY_WARNING, 1), WARNED_S, "warning of the display")
        self.screen.keep("display_of_a_dead_simulator.ppm")
        self.assertTrue(self.screen.ball(), "its last surface is shown")
        self.expect(False, False, "panel after the last one was killed")
        # A simulator that has no surface yet: the surface of the dead one disappears.
        silent = rospy.Publisher("surface", SurfaceVertices, queue_size=1)
        self.expect_ball(False, "view without the ball of the one that died")
        time.sleep(1)
        self.assertIsNone(self.screen.ball(), "the surface of the one that died has come again")
        silent.unregister()
        self.start()
        self.expect(True, False, "panel of one that was started again")
        self.expect_ball(True, "ball of the one that was started again")
        self.rviz.process.send_signal(2)
        self.assertEqual(self.rviz.process.wait(LIMIT_S), 0, self.rviz.output)


if __name__ == "__main__":
    rospy.init_node("rviz_simulators_test")
    rostest.rosrun("viscera", "rviz_simulators", RvizSimulatorsTest, sys.argv)
