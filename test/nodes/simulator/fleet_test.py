#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""fleet.launch: a requested number of simulators, each with its own names, and with scene, threads and device in
turn."""
import os
import sys
import unittest

import roslaunch.config
import roslib.packages
import rosnode
import rospy
import rostest
from simulator_watch import Latest, READY_LIMIT_S, SimulatorWatch, wait_until

from viscera.msg import Tick

FLEET_LAUNCH = os.path.join(roslib.packages.get_pkg_dir("viscera"), "launch/fleet.launch")
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

    def machines_of(self, *arguments):
        """Returns the names of simulators, and their roslaunch machines, for a launch with these arguments."""
        config = roslaunch.config.load_config_default([(FLEET_LAUNCH, ["n:=4"] + list(arguments))], None, verbose=False)
        self.assertEqual(config.config_errors, [])
        return {node.namespace.strip("/"): node.machine for node in config.nodes if node.type == "simulator"}, config

    def test_hosts_take_simulators_in_turn(self):
        machines, config = self.machines_of("hosts:=192.0.2.1 lab@192.0.2.2", "env_loader:=/opt/env.sh", "devices:=0 1", "strokes:=demo")
        self.assertEqual([machines[name].address for name in FLEET], ["192.0.2.1", "192.0.2.2"] * 2)
        self.assertEqual([machines[name].user for name in FLEET], [None, "lab"] * 2)
        self.assertEqual({machines[name].env_loader for name in FLEET}, {"/opt/env.sh"})
        devices = {node.namespace.strip("/"): node.args.split("solver.device=")[1][0] for node in config.nodes}
        self.assertEqual([devices[name] for name in FLEET], ["0", "0", "1", "1"])
        self.assertEqual(len(config.nodes), 8)  # replays run on the same machines as their simulators
        for node in config.nodes:
            self.assertEqual(node.machine, machines[node.namespace.strip("/")])

    def test_without_hosts_all_run_here(self):
        machines, _ = self.machines_of()
        self.assertEqual([machines[name].address for name in FLEET], ["localhost"] * 4)

    def test_diagnostics_tell_them_apart(self):
        for name in FLEET:
            SimulatorWatch(name + "/simulator").wait_ready()


if __name__ == "__main__":
    rostest.rosrun("viscera", "fleet_test", FleetTest, sys.argv)
