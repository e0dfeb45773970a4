#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""load_scene: a bad scene is refused and the running one continues. A good one replaces it in the same node, with zero
as the last force, its own topics and the tick at 0, and back again."""
import json
import os
import subprocess
import sys
import unittest

import rosgraph
import rosnode
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from rosgraph_msgs.msg import Log
from simulator_watch import Latest, READY_LIMIT_S, SimulatorWatch, wait_until
from std_srvs.srv import Trigger
from viscera.msg import StylusState, SurfaceTopology, Tick
from viscera.srv import LoadScene, Step
from visualization_msgs.msg import Marker, MarkerArray

# Time between the last tick of one scene and the first of the next. Alone on two cores it is about 0.1 s. Tests share
# their cores with others. In a switch, one thread waits for another ten times, and a busy machine may delay each by 50
# ms. Creating a model again takes longer.
LONGEST_GAP_S = 0.6
TOO_SLOW = 0.2  # real-time factor for which a lattice is created: below the one that causes a warning
HERE = os.path.dirname(os.path.abspath(__file__))
OTHER = os.path.join(os.path.dirname(HERE), "views", "cameras.yaml")
HEART = ["bodies[0].spacing_m=0.008", "environment.gravity_m_per_s2=[0,0,0]"]  # takes longer to make than LONGEST_GAP_S
WALL = os.path.join(os.path.dirname(HERE), "support", "front_wall.yaml")  # as in the launch file


class LoadSceneTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("load_scene_test")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        rospy.wait_for_service("load_scene", READY_LIMIT_S)
        cls.load = rospy.ServiceProxy("load_scene", LoadScene)
        cls.tick = Latest("tick", Tick)
        cls.pid = cls.pid_of_simulator()

    @staticmethod
    def pid_of_simulator():
        return rosnode.get_api_uri(rosgraph.Master("/load_scene_test"), "/simulator")

    def topics(self):
        return {name for name, _ in rospy.get_published_topics()}

    def test_0_a_bad_scene_is_refused_and_the_running_one_goes_on(self):
        for request, said in (({"scene": ""}, "must be given"),
                              ({"scene": "nowhere"}, "no file"),
                              ({"scene": "heart", "overrides": ["bodies[0].spacing=1"]}, "bodies[0].spacing"),
                              ({"scene": "heart", "mesh": os.path.join(HERE, "nowhere.obj")}, "no file"),
                              ({"scene": "heart", "mesh": OTHER}, "cameras.yaml"),
                              ({"scene": "heart", "mesh_unit_m": 0.001}, "is only used with"),
                              ({"scene": WALL, "overrides": ["bodies[0].fixed=[{shape: sphere, radius_m: 1}]"]}, "")):
            answer = self.load(**request)
            self.assertFalse(answer.success, str(request))
            self.assertTrue(answer.message, str(request))
            self.assertIn(said, answer.message)
        before = self.tick.message.tick
        wait_until(lambda: self.tick.message.tick > before, 10, "tick of the old scene")
        self.assertIn("/left/body/servo_cf", self.topics())

    def test_0_files_outside_of_the_scene_folders_are_refused_and_not_quoted(self):
        outside = "/etc/passwd"
        with open(outside) as file:
            words = [word for word in file.read().split(":") if len(word) > 6 and word not in outside]
        for path in (outside, os.path.join(HERE, "../../../../../../../../../.." + outside), "/nowhere/to/be/found"):
            for request in ({"scene": path}, {"scene": "heart", "mesh": path},
                            {"scene": OTHER, "overrides": ["bodies[0].source=mesh", "bodies[0].mesh_file=" + path]}):
                answer = self.load(**request)
                self.assertFalse(answer.success, str(request))
                self.assertIn("~scene_folders", answer.message)
                self.assertIn(path, answer.message)
                for word in words:
                    self.assertNotIn(word, answer.message)

    def test_1_another_scene_takes_its_place_with_zero_as_the_last_force(self):
        hand = subprocess.Popen([sys.executable, os.path.join(os.path.dirname(HERE), "support", "stylus_device.py")], stdin=subprocess.PIPE,
                                stdout=subprocess.PIPE, text=True)
        hand.stdin.write("press\n")
        hand.stdin.flush()
        self.assertEqual(hand.stdout.readline(), "touching\n")
        before = self.tick.message.tick
        answer = self.load(scene=OTHER)
        felt = json.loads(hand.communicate(timeout=30)[0].splitlines()[-1])
        self.assertTrue(answer.success, answer.message)
        self.assertGreater(max(force for _, force, _, _ in felt), 0)
        self.assertEqual(felt[-1][1:3], [0, 0])
        wait_until(lambda: self.tick.message.tick < before, 10, "tick of the new scene")
        wait_until(lambda: "/scope/image_raw" in self.topics(), 10, "topics of the new scene")
        for gone in ("/left/body/servo_cf", "/camera/image_raw"):
            self.assertNotIn(gone, self.topics())
        topology = Latest("surface_topology", SurfaceTopology)
        wait_until(lambda: topology.message and topology.message.bodies == ["block"], 10, "its topology")
        self.assertEqual(self.pid_of_simulator(), self.pid)

    def test_2_services_stay(self):
        for name in ("pause", "reset", "resume"):
            answer = rospy.ServiceProxy(name, Trigger)()
            self.assertTrue(answer.success, answer.message)

    def test_5_no_model_is_made_twice_and_ticks_hardly_pause(self):
        ticks, lines, texts = [], [], []
        subscribers = [rospy.Subscriber("tick", Tick, lambda it: ticks.append((it.header.stamp.to_sec(), it.tick)), queue_size=1000),
                       rospy.Subscriber("/rosout", Log, lambda it: lines.append(it.msg), queue_size=1000),
                       rospy.Subscriber("scene_markers", MarkerArray, lambda it: texts.extend(
                           m.text for m in it.markers if m.ns == "preparing" and m.action == Marker.ADD), queue_size=100)]
        wait_until(lambda: ticks, 10, "ticks")
        del lines[:]
        answer = self.load(scene="heart", overrides=HEART)
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: ticks[-1][1] > 20 and any(after[1] < before[1] for before, after in zip(ticks, ticks[1:])), 10,
                   "ticks of the new scene")
        for subscriber in subscribers:
            subscriber.unregister()
        self.assertTrue([line for line in lines if line.startswith("load_scene: ")], "how the model is made")
        self.assertEqual([line for line in lines if line.startswith("preparing: ")], [])
        self.assertEqual(texts, [])
        gap = max(after[0] - before[0] for before, after in zip(ticks, ticks[1:]))
        print("longest time without a tick: %.3f s" % gap)
        self.assertLess(gap, LONGEST_GAP_S)

    def test_3_nodes_too_crowded_for_contacts_are_warned_of(self):
        answer = self.load(scene=os.path.join(HERE, "crowd.yaml"))
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: self.watch.value("simulation", "nodes_crowded"), 10, "crowd")
        status = self.watch.status("simulation")
        self.assertEqual(status.level, DiagnosticStatus.WARN)
        self.assertIn("%d nodes have no contacts" % self.watch.value("simulation", "nodes_crowded"), status.message)

    def test_4_and_back(self):
        answer = self.load(scene=WALL, overrides=["styluses[0].max_force_n=10"])
        self.assertTrue(answer.success, answer.message)
        self.assertIn("stylus left: max_force_n is 4, as set by the ~overrides of the launch file, not 10", answer.message)
        wait_until(lambda: "/left/body/servo_cf" in self.topics() and "/scope/image_raw" not in self.topics(), 10,
                   "topics of the old scene")

    def cut(self):
        """Cuts through the upper half of the block."""
        step = rospy.ServiceProxy("step", Step)
        self.assertTrue(rospy.ServiceProxy("pause", Trigger)().success)
        for x in (-0.03, -0.01, 0.01, 0.03):
            state = StylusState(stylus="right", button2=True)
            state.pose.position.x, state.pose.position.y, state.pose.position.z = x, 0.001, 0.001
            state.pose.orientation.w = 1
            answer = step(ticks=2, styluses=[state])
            self.assertTrue(answer.success, answer.message)
        self.assertTrue(rospy.ServiceProxy("resume", Trigger)().success)

    def test_6_a_lattice_that_is_too_fine_is_made_coarser(self):
        coarsen = rospy.ServiceProxy("coarsen", Trigger)
        self.assertIn("no body of the scene has spacing_m: auto", coarsen().message)
        lines = []
        subscriber = rospy.Subscriber("/rosout", Log, lambda it: lines.append(it.msg), queue_size=1000)
        answer = self.load(scene=OTHER, overrides=["bodies[0].spacing_m=auto", "solver.backend=cpu", "cameras=[]", "solver.sleep_speed_m_per_s=0",
                                                     "styluses=[{name: right, button2: cut}]", "solver.real_time_factor=%g" % TOO_SLOW])
        self.assertTrue(answer.success, answer.message)
        self.assertIn("has not run", coarsen().message)

        def said(text):
            return [line for line in lines if text in line]
        wait_until(lambda: said("call service coarsen"), 30, "offer of a coarser lattice")
        self.assertEqual(len(said("call service coarsen")), 1)
        self.cut()
        wait_until(lambda: self.watch.value("simulation", "springs_cut"), 10, "springs cut")
        answer = coarsen()
        self.assertTrue(answer.success, answer.message)
        nodes = [int(line.split()[1]) for line in said("ready: ")]
        self.assertEqual(len(nodes), 2)
        self.assertLess(nodes[1], 0.9 * nodes[0])
        self.assertTrue(said("instead of"))
        topology = Latest("surface_topology", SurfaceTopology)
        wait_until(lambda: topology.message and sum(topology.message.wound_triangles), 10, "wound that is still there")
        subscriber.unregister()

    def test_7_clips_blood_and_burns_are_told(self):
        """The vessel of config/strokes/bleeding.yaml: divided by scissors that close twice, clipped, burnt."""
        answer = self.load(scene="bleeding_vessel", overrides=["solver.backend=cpu", "cameras=[]"])
        self.assertTrue(answer.success, answer.message)
        step = rospy.ServiceProxy("step", Step)
        self.assertTrue(rospy.ServiceProxy("pause", Trigger)().success)

        def hold(stylus, x, z, across, ticks, **pressed):
            state = StylusState(stylus=stylus, **pressed)
            state.pose.position.x, state.pose.position.z = x, z
            state.pose.orientation.z = state.pose.orientation.w = 0.5 ** 0.5
            if not across:
                state.pose.orientation.z, state.pose.orientation.w = 0, 1
            done = step(ticks=ticks, styluses=[state])
            self.assertTrue(done.success, done.message)

        def told(part, key):
            return wait_until(lambda: self.watch.value(part, key), 10, "%s of %s" % (key, part))
        hold("right", 0, 0.03, True, 6)
        hold("right", 0, -0.007, True, 12)
        for _ in range(2):
            hold("right", 0, -0.007, True, 30, button1=True)
            hold("right", 0, -0.007, True, 6)
        self.assertEqual(told("bleeding", "stumps"), 2)
        hold("left", -0.006, 0.03, True, 6)
        hold("left", -0.006, -0.006, True, 30)
        hold("left", -0.006, -0.006, True, 30, button1=True)
        self.assertGreater(told("clips", "on[0].force_n"), 0)
        hold("right", 0.0022, 0.02, False, 6)
        hold("right", 0.0022, 0.0002, False, 30, button2=True)
        self.assertGreater(told("burns", "given_j"), 0)
        self.assertGreater(told("bleeding", "bled_ml"), 0)
        self.assertTrue(rospy.ServiceProxy("resume", Trigger)().success)


if __name__ == "__main__":
    rostest.rosrun("viscera", "load_scene_test", LoadSceneTest, sys.argv)
