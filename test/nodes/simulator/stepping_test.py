#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Services of the simulator: wrong states are refused, a reset restores the state bit by bit, and nothing is sent
without a request."""
import os
import sys
import unittest

import rospy
import rostest
from sensor_msgs.msg import Image
from simulator_watch import Latest, READY_LIMIT_S, SimulatorWatch, wait_until
from std_srvs.srv import Trigger
from viscera.srv import FileCommand, Step
from visualization_msgs.msg import Marker


class SteppingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("stepping_test")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        for name in ("reset", "pause", "resume", "step"):
            rospy.wait_for_service(name, READY_LIMIT_S)
        cls.reset = rospy.ServiceProxy("reset", Trigger)
        cls.pause = rospy.ServiceProxy("pause", Trigger)
        cls.resume = rospy.ServiceProxy("resume", Trigger)
        cls.step = rospy.ServiceProxy("step", Step)
        cls.save_state, cls.load_state, cls.save_surface = (
            rospy.ServiceProxy(name, FileCommand) for name in ("save_state", "load_state", "save_surface"))

    def tearDown(self):
        self.resume()

    def assertDone(self, answer):
        self.assertTrue(answer.success, answer.message)

    def assertRefused(self, answer):
        self.assertFalse(answer.success)
        self.assertTrue(answer.message)

    def test_0_without_subscribers_nothing_was_mapped_drawn_or_read_back(self):
        self.watch.wait_news()
        self.assertGreater(self.watch.value("simulation", "ticks"), 0)
        for counter in ("mappings", "renders", "read_backs"):
            self.assertEqual(self.watch.value("simulation", counter), 0, counter)

    def test_services_in_the_wrong_state_are_refused(self):
        self.assertRefused(self.resume())
        self.assertRefused(self.step(ticks=1))
        self.assertDone(self.pause())
        self.assertRefused(self.pause())
        self.assertRefused(self.step(ticks=1000000))
        self.assertDone(self.step(ticks=1))

    def test_step_makes_exactly_that_many_ticks(self):
        self.assertDone(self.pause())
        self.assertDone(self.reset())
        before = self.step(ticks=0)
        self.assertEqual(before.tick, 0)
        after = self.step(ticks=5)
        self.assertEqual(after.tick, 5)
        self.assertNotEqual(after.state_hash, before.state_hash)
        self.assertRegex(after.state_hash, "^[0-9a-f]{16}$")

    def test_reset_restores_the_state_to_the_bit(self):
        self.assertDone(self.pause())
        self.assertDone(self.reset())
        rest, later = self.step(ticks=0).state_hash, self.step(ticks=7).state_hash
        self.assertDone(self.reset())
        self.assertEqual(self.step(ticks=0).state_hash, rest)
        self.assertEqual(self.step(ticks=7).state_hash, later)

    def test_a_saved_state_is_gone_on_from_to_the_bit(self):
        self.assertDone(self.pause())
        self.assertDone(self.reset())
        self.step(ticks=3)
        saved = self.save_state(file="stepping.state")
        self.assertDone(saved)
        there, later = self.step(ticks=0), self.step(ticks=6)
        self.assertDone(self.reset())
        self.assertDone(self.load_state(file="stepping.state"))
        again = self.step(ticks=0)
        self.assertEqual((again.tick, again.state_hash), (3, there.state_hash))
        self.assertEqual(self.step(ticks=6).state_hash, later.state_hash)
        with open(saved.message, "r+b") as file:
            file.truncate(os.path.getsize(saved.message) // 2)
        self.assertRefused(self.load_state(file="stepping.state"))
        self.assertEqual(self.step(ticks=0).state_hash, later.state_hash)

    def test_files_are_plain_names_that_are_there(self):
        for name in ("", "../x.state", "/tmp/x.state", ".state"):
            for call in (self.save_state, self.load_state, self.save_surface):
                answer = call(file=name)
                self.assertRefused(answer)
                self.assertIn("~saved_folder", answer.message)
        self.assertRefused(self.load_state(file="there_is_none.state"))
        self.assertRefused(self.save_surface(file="skin.doc"))

    def test_the_surface_is_written_running_and_paused(self):
        for name, first in (("skin.ply", b"ply"), ("skin.glb", b"glTF"), ("skin.vtp", b"<?xml")):
            done = self.save_surface(file=name)
            self.assertDone(done)
            with open(done.message, "rb") as file:
                self.assertEqual(file.read(len(first)), first)
        self.assertDone(self.pause())
        self.assertDone(self.save_surface(file="skin.ply"))

    def test_time_stands_still_while_paused(self):
        self.assertDone(self.pause())
        self.watch.wait_news()
        tick = self.watch.value("simulation", "tick")
        self.watch.wait_news()
        self.assertEqual(self.watch.value("simulation", "tick"), tick)
        self.assertEqual(self.watch.status("simulation").message, "paused")
        self.assertDone(self.resume())
        wait_until(lambda: self.watch.value("simulation", "tick") > tick, 10, "tick after resume")

    def test_subscribers_are_served_and_cost_ends_with_them(self):
        image, marker = Latest("camera/image_raw", Image), Latest("surface_marker", Marker)
        wait_until(lambda: image.count and marker.count, 20, "image and marker")
        image.stop()
        marker.stop()

        def settled():
            counts = [self.watch.value("simulation", c) for c in ("mappings", "renders", "read_backs")]
            self.watch.wait_news()
            return counts == [self.watch.value("simulation", c) for c in ("mappings", "renders", "read_backs")]

        wait_until(settled, 20, "end of the work for subscribers that left")
        self.assertGreater(self.watch.value("simulation", "renders"), 0)


if __name__ == "__main__":
    rostest.rosrun("viscera", "stepping_test", SteppingTest, sys.argv)
