#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Knots by service: one that is asked for is drawn and tied, and told in /diagnostics; others are refused with what is accepted."""
import sys
import unittest

import rospy
import rostest
from simulator_watch import Latest, SimulatorWatch, wait_until

from viscera.msg import Threads
from viscera.srv import TieThread

LIMIT_S = 60
LOOP_MM = (10, 40)  # through 9 mm of tissue, 6 mm deep


class TieThreadTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("tie_thread_test")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        rospy.wait_for_service("tie_thread", LIMIT_S)
        cls.tie = rospy.ServiceProxy("tie_thread", TieThread)

    def test_a_knot_is_drawn_and_tied(self):
        threads = Latest("threads", Threads)
        wait_until(lambda: threads.message, LIMIT_S, "threads")
        self.assertEqual(threads.message.names, ["stitch_%d" % k for k in (1, 2, 3, 4)])
        self.assertEqual(len(threads.message.radii_m), 4)
        self.assertEqual(sum(threads.message.nodes) * 3, len(threads.message.positions_m))
        answer = self.tie(thread="stitch_1", knot="granny", tension_n=0.05)
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: self.watch.value("threads", "pieces[0].knots[0].tied") == "true", LIMIT_S, "knot")
        self.assertEqual(self.watch.value("threads", "pieces[0].name"), "stitch_1")
        self.assertEqual(self.watch.value("threads", "pieces[0].knots[0].knot"), "granny")
        loop_mm = 1e3 * float(self.watch.value("threads", "pieces[0].knots[0].loop_m"))
        self.assertTrue(LOOP_MM[0] < loop_mm < LOOP_MM[1], loop_mm)

    def test_what_cannot_be_is_refused(self):
        for request, said in (({"thread": "rope"}, "no thread 'rope'; it has stitch_1"),
                              ({"thread": "stitch_2", "piece": 3}, "is in 1, there is no 3"),
                              ({"thread": "stitch_2", "knot": "bow"}, "no knot 'bow'; there are half"),
                              ({"thread": "stitch_2", "tension_n": -1}, "tension_n: -1"),
                              ({"thread": "stitch_2", "strand_m": [0, 0]}, "strand_m: 2 numbers; 3, or none"),
                              ({"thread": "stitch_2", "strand_m": [0, 0, 20]}, "strand_m: 20"),
                              ({"thread": "stitch_2", "holds_n": float("nan")}, "holds_n: ")):
            answer = self.tie(**request)
            self.assertFalse(answer.success)
            self.assertIn(said, answer.message)


if __name__ == "__main__":
    rostest.rosrun("viscera", "tie_thread", TieThreadTest, sys.argv)
