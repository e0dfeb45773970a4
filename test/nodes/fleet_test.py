#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""fleet.launch: as many simulators as asked for, each by its own names, with the scene, threads and device of its turn."""
import sys
import unittest

import rosnode
import rospy
import rostest
from simulator_watch import Latest, READY_LIMIT_S, SimulatorWatch, wait_until

from viscera.msg import Tick

FLEET = ["sim1", "sim2", "sim3", "sim4"]


class FleetTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("fleet_test")

    def test_each_steps_by_its_own_names(self):
        ticks = {name: Latest(name + "/tick", Tick) for name in FLEET}
        wait_until(lambda: all(tick.count > 5 for tick in ticks.values()), READY_LIMIT_S, "ticks of all four")
        simulators = sorted(node for node in rosnode.get_node_names() if node.endswith("/simulator"))
        self.assertEqual(simulators, ["/%s/simulator" % name for name in FLEET])

    def test_each_has_what_the_launch_says(self):
        for number, name in enumerate(FLEET, 1):
            wait_until(lambda: rospy.has_param("/%s/simulator/overrides" % name), READY_LIMIT_S, "parameters")
            keys = rospy.get_param("/%s/simulator/overrides" % name).split(";")
            self.assertEqual(keys, ["solver.threads=1", "solver.device=" + ("0" if number % 2 else "-1"), "solver.tick_hz=50"])
            self.assertEqual(rospy.get_param("/%s/simulator/frame_prefix" % name), name + "/")

    def test_diagnostics_tell_them_apart(self):
        for name in FLEET:
            SimulatorWatch(name + "/simulator").wait_ready()


if __name__ == "__main__":
    rostest.rosrun("viscera", "fleet_test", FleetTest, sys.argv)
