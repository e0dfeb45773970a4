#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""rviz keeps nothing of topologies that it no longer draws. VISCERA_CHANGES: number of changes, 10,000 in the long
form."""
import os
import sys
import unittest

import rospy
import rostest
import rviz_screen
from simulator_watch import wait_until
from stand_in_simulator import ChangingBall

CHANGES = int(os.environ.get("VISCERA_CHANGES", "600"))
WARM = CHANGES // 4   # for permanent memory, and pools that grow initially
RATE_HZ = 60
LIMIT_S = 500
# 0.1 MB were measured, with 600 changes and with 10,000. Meshes that are never removed are 84 MB with 600.
LEAK_LIMIT_MB = 8


def resident_mb(pid):
    """Returns the resident memory [MB]. Textures and buffers of software renderers are included."""
    with open("/proc/%d/statm" % pid) as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


class RvizLeaksTest(unittest.TestCase):
    def setUp(self):
        self.screen = rviz_screen.Screen(320, 240)
        self.rviz = rviz_screen.alone(self.screen, RATE_HZ, "--disable-anti-aliasing")

    def tearDown(self):
        self.rviz.end()
        self.screen.end()

    def draw(self, ball, changes):
        """Draws further topologies. rviz reports how many it has drawn, each with another topology."""
        rate, enough = rospy.Rate(2 * RATE_HZ), sum(rviz_screen.drawn_hz(self.rviz.output)) + changes

        def drawn():
            for _ in range(RATE_HZ):
                ball.step()
                rate.sleep()
            self.assertIsNone(self.rviz.process.poll(), "rviz has ended: " + self.rviz.output)
            return sum(rviz_screen.drawn_hz(self.rviz.output)) >= enough

        wait_until(drawn, LIMIT_S, "%d topologies" % changes)

    def test_topologies_that_change_leave_nothing(self):
        ball = ChangingBall()
        self.draw(ball, WARM)
        before = resident_mb(self.rviz.process.pid)
        self.draw(ball, CHANGES)
        kept = resident_mb(self.rviz.process.pid) - before
        print("%d changes, %.0f MB, %+.1f MB" % (CHANGES, before + kept, kept), flush=True)
        self.assertLess(kept, LEAK_LIMIT_MB)


if __name__ == "__main__":
    rospy.init_node("rviz_leaks_test")
    rostest.rosrun("viscera", "rviz_leaks", RvizLeaksTest, sys.argv)
