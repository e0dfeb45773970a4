#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""How the nodes start: with rosrun, after another launch, after a restart of the master, without a clock."""
import os
import signal
import socket
import sys
import tempfile
import unittest
import xml.etree.ElementTree
import xmlrpc.client

import rosgraph
import roslaunch.config
import roslaunch.core
import roslaunch.xmlloader
import roslib.packages
import rostest
import yaml
from program import END_LIMIT_S, START_LIMIT_S, Program
from simulator_watch import wait_until

SCENE = os.path.join(roslib.packages.get_pkg_dir("viscera"), "test/nodes/views/scene_view.yaml")
INPUT = os.path.join(os.path.dirname(os.path.dirname(SCENE)), "input")
TWO_HANDS = os.path.join(INPUT, "devices.yaml")
SCENE_NODES = "504 nodes"  # of scene_view.yaml


class LaunchingTest(unittest.TestCase):
    def setUp(self):
        self.uri = os.environ["ROS_MASTER_URI"]  # rostest's, except for tests that restart it
        self.master = rosgraph.Master("/launching_test", self.uri)
        self.programs = []

    def tearDown(self):
        for program in reversed(self.programs):
            program.end()
        if self.uri == os.environ["ROS_MASTER_URI"]:
            for left in set(self.master.getParamNames()) - self.params:
                if self.master.hasParam(left):
                    self.master.deleteParam(left)

    @classmethod
    def setUpClass(cls):
        cls.params = set(rosgraph.Master("/launching_test").getParamNames())

    def own_master(self):
        """Starts a master that may be restarted."""
        with socket.socket() as probe:
            probe.bind(("localhost", 0))
            self.port = probe.getsockname()[1]
        self.uri = "http://localhost:%d" % self.port
        self.master = rosgraph.Master("/launching_test", self.uri)
        return self.start_master()

    def start(self, *arguments):
        self.programs.append(Program(arguments, self.uri))
        return self.programs[-1]

    def start_master(self):
        core = self.start("roscore", "-p", str(self.port))
        wait_until(lambda: self.has_run_id(), START_LIMIT_S, "master")
        return core

    def has_run_id(self):
        try:
            return self.master.hasParam("/run_id")
        except (OSError, xmlrpc.client.Fault):  # the port is open shortly before the methods are known
            return False

    def test_rosrun_finds_the_nodes(self):
        simulator = self.start("rosrun", "viscera", "simulator", "_scene:=" + SCENE)
        simulator.said("ready: " + SCENE_NODES)
        replay = self.start("rosrun", "viscera", "stylus_replay", "_strokes:=nowhere")
        replay.said("~strokes")

    def test_rosrun_says_what_an_earlier_start_has_left(self):
        first = self.start("rosrun", "viscera", "simulator", "_scene:=" + SCENE, "_overrides:=solver.tick_hz=50")
        first.said("ready: " + SCENE_NODES)
        self.assertNotIn("these parameters on the master", first.output)
        first.end()
        second = self.start("rosrun", "viscera", "simulator", "_scene:=" + SCENE)
        second.said("ready: " + SCENE_NODES)
        self.assertIn("these parameters on the master", second.output)
        self.assertIn(" ~overrides=solver.tick_hz=50; `rosparam delete /simulator` removes them", second.output)

    def test_parameters_of_an_earlier_launch_are_cleared(self):
        self.master.setParam("/simulator/mesh_unit_m", 0.001)
        simulator = self.start("roslaunch", "viscera", "training.launch", "scene:=" + SCENE)
        simulator.said("ready: " + SCENE_NODES)
        self.assertFalse(self.master.hasParam("/simulator/mesh_unit_m"))

    @staticmethod
    def nodes_of(launch_file, **arguments):
        """Returns the nodes that roslaunch would start: arguments by node name."""
        config = roslaunch.config.ROSLaunchConfig()
        path = os.path.join(roslib.packages.get_pkg_dir("viscera"), "launch", launch_file)
        roslaunch.xmlloader.XmlLoader().load(path, config, argv=["%s:=%s" % item for item in arguments.items()],
                                             verbose=False)
        return {node.namespace + node.name: node.args for node in config.nodes}

    def test_arguments_that_mean_nothing_are_refused(self):
        for file, arguments, words in (("fleet", {"n": 0}, "n:=0 is no number of simulators"),
                                       ("fleet", {"n": 1.5}, "n:=1.5 is no number of simulators"),
                                       ("training", {"device_left": "haply_inverse3:left", "device_right": "haply_inverse3"},
                                        "two haply_inverse3 need their handedness"),
                                       ("training", {"rviz": "true", "view": "nosuch"}, "nosuch.rviz")):
            with self.assertRaises(roslaunch.core.RLException) as refused:
                self.nodes_of(file + ".launch", **arguments)
            self.assertIn(words, str(refused.exception))
        self.assertEqual(set(self.nodes_of("fleet.launch", n=2)), {"/sim1/simulator", "/sim2/simulator"})
        self.assertNotIn("/page_server", self.nodes_of("training.launch"))
        self.assertEqual(self.nodes_of("lesson.launch", page="true", page_port=9000, page_control="true")["/page_server"], "_port:=9000 _control:=true")
        haply = self.nodes_of("training.launch", device_left="haply_inverse3:left", device_right="haply_inverse3:right")
        self.assertEqual((haply["/haply_left"], haply["/haply_right"]), ("_name:=left _device:=left", "_name:=right _device:=right"))
        self.assertEqual(self.nodes_of("training.launch", device_right="haply_inverse3")["/haply_right"], "")
        self.assertIn("/cloth.rviz", self.nodes_of("training.launch", rviz="true", view="cloth")["/rviz"])

    def test_a_watchdog_stands_before_each_driver_that_takes_forces(self):
        launched = self.start("roslaunch", "viscera", "training.launch", "scene:=" + TWO_HANDS, "watchdog:=true",
                              "device_left:=phantom_omni", "device_right:=polhemus")
        launched.said("ready: ")
        self.wait_watched("left", "/phantom/force_feedback", launched)
        self.assertNotIn("watchdog_right", launched.output)
        self.assertEqual(self.publishers("/right/unwatched"), [])

    def wait_watched(self, stylus, topic, launched):
        wait_until(lambda: (self.publishers(topic), self.publishers("/%s/unwatched" % stylus)) ==
                   (["/watchdog_" + stylus], ["/simulator"]), START_LIMIT_S, "watchdog: " + launched.output)

    def test_a_watchdog_stands_before_drivers_of_own_profiles_and_topics(self):
        """With profiles in the format of device_check."""
        folder = os.path.join(roslib.packages.get_pkg_dir("viscera"), "config/devices")
        with tempfile.TemporaryDirectory() as own:
            for name, written in (("geomagic", "mine"), ("tf", "bare")):
                with open(os.path.join(folder, name + ".yaml")) as text, open(os.path.join(own, written + ".yaml"), "w") as file:
                    file.write(text.read().replace("name: Geomagic", "name: desk"))
            launched = self.start("roslaunch", "viscera", "training.launch", "scene:=" + TWO_HANDS, "watchdog:=true",
                                  "device_left:=%s/mine.yaml" % own, "device_options:=right.force.topic=motors")
            launched.said("ready: ")
            self.wait_watched("left", "/desk/force_feedback", launched)
            self.wait_watched("right", "/motors", launched)
            launched.end()
            launched = self.start("roslaunch", "viscera", "training.launch", "scene:=" + TWO_HANDS, "watchdog:=true",
                                  "device_left:=%s/bare.yaml" % own)
            launched.said("ready: ")
            launched.said("the device accepts no forces")

    def test_watchdogs_know_the_shipped_profiles_that_take_forces(self):
        folder = os.path.join(roslib.packages.get_pkg_dir("viscera"), "config/devices")
        watched = 0
        for file in sorted(os.listdir(folder)):
            with open(os.path.join(folder, file)) as text:
                profile = yaml.safe_load(text)
            name = os.path.splitext(file)[0]
            left, right = (name + ":left", name + ":right") if name == "haply_inverse3" else (name, name + ":other")
            nodes = self.nodes_of("training.launch", watchdog="true", device_left=left, device_right=right)
            if profile["force"]["type"] == "none" or name in ("crtk_arm", "dvrk_psm", "dvrk_ecm"):  # others read their forces
                self.assertEqual(set(nodes), {"/simulator"}, name)
                continue
            for stylus, device in (("left", left), ("right", right)):
                for argument in ('_device:="%s"' % device, "_stylus:=" + stylus, "wrench_in:=%s/unwatched" % stylus):
                    self.assertIn(argument, nodes["/watchdog_" + stylus])
                self.assertIn("%s.force.topic=%s/unwatched" % (stylus, stylus), nodes["/simulator"])
            watched += 1
        self.assertEqual(watched, 7)

    def test_the_licence_is_named_as_spdx_names_it(self):
        package = roslib.packages.get_pkg_dir("viscera")
        licence = xml.etree.ElementTree.parse(os.path.join(package, "package.xml")).getroot().find("license")
        self.assertEqual(licence.text, "BSD-3-Clause")
        self.assertTrue(os.path.isfile(os.path.join(package, licence.get("file"))))

    def publishers(self, topic):
        return dict(self.master.getSystemState()[0]).get(topic, [])

    def test_styluses_without_a_device_start_by_their_names(self):
        launched = self.start("roslaunch", "viscera", "training.launch", "scene:=" + TWO_HANDS, "device_left:=marker",
                              "device_right:=joy")
        launched.said("ready: ")
        wait_until(lambda: (self.publishers("/left/measured_cp"), self.publishers("/right/measured_cp")) ==
                   (["/marker_left"], ["/joy_right"]), START_LIMIT_S, "hands: " + launched.output)

    def test_a_respawn_after_a_restart_of_the_master_runs_the_same_scene(self):
        core = self.own_master()
        simulator = self.start("roslaunch", "viscera", "training.launch", "scene:=" + SCENE, "respawn:=true")
        simulator.said("ready: ")
        core.end()
        self.start_master()
        simulator.said("master is lost")
        simulator.said("ready: ", 2)
        self.assertEqual(simulator.output.count("ready: " + SCENE_NODES), 2, simulator.output)

    def test_a_respawn_that_has_lost_its_parameters_is_refused(self):
        core = self.own_master()
        file = tempfile.NamedTemporaryFile("w", suffix=".launch")
        file.write('<launch><node name="simulator" pkg="viscera" type="simulator" output="screen" respawn="true" '
                   'respawn_delay="1"><param name="scene" value="%s"/></node></launch>' % SCENE)
        file.flush()
        simulator = self.start("roslaunch", file.name)
        simulator.said("ready: " + SCENE_NODES)
        core.end()
        self.start_master()
        simulator.said("master was restarted")
        self.assertEqual(simulator.output.count("ready: "), 1, simulator.output)
        file.close()

    def test_simulated_time_without_a_clock_is_said_and_nothing_hangs(self):
        self.master.setParam("/use_sim_time", True)
        launched = self.start("roslaunch", "viscera", "training.launch", "scene:=" + SCENE,
                              "strokes:=" + os.path.join(INPUT, "short_stroke.yaml"))
        launched.said("ready: ")
        launched.said("nothing is published on /clock", 2)  # of both nodes
        tick = self.start("rostopic", "echo", "-n", "3", "/tick")
        tick.said("viewed", 3)
        os.kill(launched.process.pid, signal.SIGINT)
        launched.process.wait(END_LIMIT_S)
        self.assertEqual(launched.output.count("nothing is published on /clock"), 2, launched.output)


if __name__ == "__main__":
    rostest.rosrun("viscera", "launching_test", LaunchingTest, sys.argv)
