#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Knots by service: a requested knot is drawn, tied and reported in /diagnostics; others are refused with the accepted
values."""
import sys
import unittest

import rospy
import rostest
from simulator_watch import Latest, SimulatorWatch, wait_until

from viscera.msg import Sutures
from viscera.srv import TieSuture

LIMIT_S = 60
LOOP_MM = (10, 40)  # through 9 mm of tissue, 6 mm deep


class TieSutureTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("tie_suture_test")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        rospy.wait_for_service("tie_suture", LIMIT_S)
        cls.tie = rospy.ServiceProxy("tie_suture", TieSuture)

    def test_a_knot_is_drawn_and_tied(self):
        sutures = Latest("sutures", Sutures)
        wait_until(lambda: sutures.message, LIMIT_S, "sutures")
        self.assertEqual(sutures.message.names, ["stitch_%d" % k for k in (1, 2, 3, 4)])
        self.assertEqual(len(sutures.message.radii_m), 4)
        self.assertEqual(sum(sutures.message.nodes) * 3, len(sutures.message.positions_m))
        answer = self.tie(suture="stitch_1", knot="granny", tension_n=0.05)
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: self.watch.value("sutures", "pieces[0].knots[0].tied") == "true", LIMIT_S, "knot")
        self.assertEqual(self.watch.value("sutures", "pieces[0].name"), "stitch_1")
        self.assertEqual(self.watch.value("sutures", "pieces[0].knots[0].knot"), "granny")
        loop_mm = 1e3 * float(self.watch.value("sutures", "pieces[0].knots[0].loop_m"))
        self.assertTrue(LOOP_MM[0] < loop_mm < LOOP_MM[1], loop_mm)

    def test_what_cannot_be_is_refused(self):
        for request, said in (({"suture": "rope"}, "no suture 'rope'; it has stitch_1"),
                              ({"suture": "stitch_2", "piece": 3}, "has 1 piece, but no piece 3"),
                              ({"suture": "stitch_2", "knot": "bow"}, "unknown knot 'bow'; accepted: half"),
                              ({"suture": "stitch_2", "tension_n": -1}, "tension_n: -1"),
                              ({"suture": "stitch_2", "strand_m": [0, 0]}, "strand_m: 2 numbers; 3 or none"),
                              ({"suture": "stitch_2", "strand_m": [0, 0, 20]}, "strand_m: 20"),
                              ({"suture": "stitch_2", "holds_n": float("nan")}, "holds_n: ")):
            answer = self.tie(**request)
            self.assertFalse(answer.success)
            self.assertIn(said, answer.message)


if __name__ == "__main__":
    rostest.rosrun("viscera", "tie_suture", TieSutureTest, sys.argv)
