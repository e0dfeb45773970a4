#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Motion of a stylus before a gap, a pause or a reset is discarded: it causes no cut, push or force afterwards."""
import math
import sys
import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, TransformStamped, WrenchStamped
from sensor_msgs.msg import Image, Joy
from simulator_watch import Latest, SimulatorWatch, wait_until
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from viscera.msg import StylusState, SurfaceVertices
from viscera.srv import Step
from visualization_msgs.msg import Marker

LIMIT_S = 20
STALE_S = 0.5                     # longer than stale_after_s of the scene
RATE_HZ = 100
OUTSIDE, DEEP = (0, -0.1, -0.02), (0, -0.05, -0.02)       # of the probe: in front of the front wall, and behind it
LEFT, RIGHT = (-0.07, -0.025, -0.02), (0.07, -0.025, -0.02)  # of the tip: next to the heart, at the depth of a cut
DOWN = (math.sqrt(0.5), 0, 0, math.sqrt(0.5))             # the tip points along +y, into the tissue
FELT_N = 0.02
QUIET_S = 0.5                     # time after which no message of a paused session is in transit
REST_S = 1.0                      # time in which the soft tissue comes to rest
PRESS_S, SWEEP_S = 0.5, 0.8       # durations of the motions in and across


class StylusDevice:
    """Publishes its pose repeatedly, until it vanishes."""

    def __init__(self, name, frame="tissue"):
        self.name, self.frame = name, frame
        self.poses = rospy.Publisher(name + "/measured_cp", PoseStamped, queue_size=1, tcp_nodelay=True)
        self.buttons = [rospy.Publisher("%s/button%d" % (name, b), Joy, queue_size=10) for b in (1, 2)]
        self.at = None
        threading.Thread(target=self.play, daemon=True).start()

    def wait_heard(self):
        wait_until(lambda: all(p.get_num_connections() for p in (self.poses, *self.buttons)), LIMIT_S, "subscriber")

    def play(self):
        while not rospy.is_shutdown():
            at = self.at
            if at:
                message = PoseStamped()
                message.header.frame_id = self.frame
                message.header.stamp = rospy.Time.now()
                message.pose.position.x, message.pose.position.y, message.pose.position.z = at
                turn = message.pose.orientation
                turn.x, turn.y, turn.z, turn.w = DOWN
                self.poses.publish(message)
            time.sleep(1 / RATE_HZ)

    def press(self, button, down):
        self.buttons[button - 1].publish(Joy(buttons=[1 if down else 0]))
        time.sleep(0.1)

    def go(self, to, seconds):
        start, begun = self.at, time.monotonic()
        while self.at != to:
            way = min(1.0, (time.monotonic() - begun) / seconds)
            self.at = to if way == 1 else tuple(a + way * (b - a) for a, b in zip(start, to))
            time.sleep(1 / RATE_HZ)

    def appear(self, at):
        self.at = at
        time.sleep(0.4)  # buttons that are down within 0.25 s of the first pose must be released first

    def vanish(self):
        self.at = None
        time.sleep(STALE_S)


class InputTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("input_test")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        cls.left, cls.right = StylusDevice("left"), StylusDevice("right")
        cls.force = Latest("left/body/servo_cf", WrenchStamped)
        cls.call = {name: rospy.ServiceProxy(name, Trigger) for name in ("reset", "pause", "resume")}
        cls.step = rospy.ServiceProxy("step", Step)
        for hand in (cls.left, cls.right):
            hand.wait_heard()

    def setUp(self):
        self.left.frame = "tissue"
        self.left.at = self.right.at = None
        time.sleep(STALE_S)
        self.call["resume"]()
        self.assertTrue(self.call["reset"]().success)
        for hand in (self.left, self.right):
            for button in hand.buttons:
                button.publish(Joy(buttons=[0]))
        time.sleep(0.1)

    def springs_cut(self):
        self.watch.wait_news()
        return self.watch.value("simulation", "springs_cut")

    def force_n(self):
        force = self.force.message.wrench.force
        return math.hypot(force.x, force.y, force.z)

    def last_of(self, topic):
        """Returns the message that none follows for QUIET_S; on a busy machine one takes longer to arrive than a
        tick."""
        count, since = topic.count, time.monotonic()
        deadline = since + LIMIT_S
        while not count or time.monotonic() - since < QUIET_S:
            self.assertLess(time.monotonic(), deadline, "messages of a paused session that end")
            time.sleep(0.05)
            if topic.count != count:
                count, since = topic.count, time.monotonic()
        return topic.message

    def feels(self):
        """Returns whether a force comes within REST_S."""
        end = time.monotonic() + REST_S
        while self.force_n() <= FELT_N and time.monotonic() < end:
            time.sleep(0.02)
        return self.force_n() > FELT_N

    def press_probe_in(self):
        """Presses the probe in. On a busy machine poses may pause on the way in, which correctly ends the contact; then
        it tries again."""
        for _ in range(5):
            self.left.appear(OUTSIDE)
            self.left.go(DEEP, PRESS_S)
            if self.feels():
                break
        self.assertGreater(self.force_n(), FELT_N)
        self.assertLess(self.force.message.wrench.force.y, 0)  # out of the tissue

    def test_button_ends_with_its_stylus(self):
        self.right.appear(LEFT)
        self.right.press(2, True)
        self.right.vanish()
        self.right.appear(LEFT)
        self.right.go(RIGHT, SWEEP_S)
        self.assertEqual(self.springs_cut(), 0)
        self.assertEqual(self.watch.value("right", "button_presses_ignored"), 0)
        self.right.press(2, True)  # never released
        self.right.go(LEFT, SWEEP_S)
        self.assertEqual(self.springs_cut(), 0)
        self.right.press(2, False)
        self.right.press(2, True)
        self.right.go(RIGHT, SWEEP_S)
        self.assertGreater(self.springs_cut(), 0)

    def test_blade_does_not_sweep_over_a_pause(self):
        self.right.appear(LEFT)
        self.right.press(2, True)
        self.assertTrue(self.call["pause"]().success)
        self.right.at = RIGHT
        time.sleep(0.5)
        self.assertTrue(self.call["resume"]().success)
        time.sleep(0.5)
        self.assertEqual(self.springs_cut(), 0)

    def test_gap_at_depth_gives_no_force_until_the_tip_was_outside(self):
        self.press_probe_in()
        self.left.vanish()
        self.assertEqual(self.force_n(), 0)
        time.sleep(REST_S)
        self.left.appear(DEEP)
        for _ in range(20):
            self.assertEqual(self.force_n(), 0)
            time.sleep(0.05)
        self.watch.wait_news()
        self.assertIn("appeared inside", self.watch.status("left").message)
        self.left.go(OUTSIDE, PRESS_S)
        time.sleep(0.2)
        self.left.go(DEEP, PRESS_S)
        self.assertTrue(self.feels())
        self.assertLess(self.force.message.wrench.force.y, 0)

    def test_reset_at_depth_gives_no_force(self):
        self.press_probe_in()
        self.assertTrue(self.call["reset"]().success)
        time.sleep(0.5)
        self.assertEqual(self.force_n(), 0)

    def test_steps_of_a_paused_session_send_no_force(self):
        self.press_probe_in()
        self.assertTrue(self.call["pause"]().success)
        time.sleep(0.2)
        forces = []
        watch = Latest("left/body/servo_cf", WrenchStamped, lambda m: forces.append(m.wrench.force.y)).connect()
        time.sleep(0.3)
        self.assertTrue(self.step(ticks=50).success)
        time.sleep(0.2)
        watch.stop()
        self.assertGreater(len(forces), 10)
        self.assertEqual(set(forces), {0})

    def test_steps_that_say_where_the_tools_are_end_in_one_hash(self):
        def episode(delay_s):
            self.assertTrue(self.call["reset"]().success)
            answers = []
            for y in (OUTSIDE[1], -0.09, -0.08, -0.07, -0.06, DEEP[1]):
                state = StylusState(stylus="left")
                state.pose.position.y, state.pose.position.z = y, DEEP[2]
                state.pose.orientation.w = 1
                answers.append(self.step(ticks=20, styluses=[state]))
                self.assertTrue(answers[-1].success, answers[-1].message)
                time.sleep(delay_s)
            return answers

        self.assertTrue(self.call["pause"]().success)
        first, second = episode(0), episode(0.1)
        self.assertEqual([a.state_hash for a in first], [a.state_hash for a in second])
        self.assertEqual(len(first[-1].reactions), 2)
        self.assertLess(first[-1].reactions[0].force.y, -FELT_N)
        self.assertEqual(first[-1].reactions, second[-1].reactions)
        self.assertEqual(self.force_n(), 0)

    def test_steps_to_where_nothing_can_be_are_refused(self):
        self.assertTrue(self.call["pause"]().success)
        unknown, nowhere, twice = StylusState(stylus="unknown"), StylusState(stylus="left"), StylusState(stylus="left")
        unknown.pose.orientation.w = twice.pose.orientation.w = 1
        for states, word in (([unknown], "unknown"), ([nowhere], "quaternion"), ([twice, twice], "twice")):
            answer = self.step(ticks=1, styluses=states)
            self.assertFalse(answer.success)
            self.assertIn(word, answer.message)

    def test_viewer_that_comes_in_a_pause_is_served(self):
        self.assertTrue(self.call["pause"]().success)
        time.sleep(0.2)
        topics = (("surface_marker", Marker), ("surface", SurfaceVertices), ("camera/image_raw", Image))
        views = [Latest(topic, kind) for topic, kind in topics]
        for view, (topic, _) in zip(views, topics):
            wait_until(lambda view=view: view.count, LIMIT_S, topic + " in a pause")
            view.stop()

    def test_reset_in_a_pause_is_shown(self):
        marker = Latest("surface_marker", Marker)
        self.press_probe_in()
        self.assertTrue(self.call["pause"]().success)
        dented = self.last_of(marker).points
        count = marker.count
        self.assertTrue(self.call["reset"]().success)
        wait_until(lambda: marker.count > count, LIMIT_S, "marker after a reset")
        largest = max(math.dist((a.x, a.y, a.z), (b.x, b.y, b.z)) for a, b in zip(dented, self.last_of(marker).points))
        self.assertGreater(largest, 0.005)
        marker.stop()

    def test_dead_tf_broadcaster_ends_the_force(self):
        frames = rospy.Publisher("/tf", TFMessage, queue_size=1)
        alive = threading.Event()

        def broadcast():
            while not alive.is_set():
                frame = TransformStamped()
                frame.header.frame_id, frame.child_frame_id = "tissue", "tracker"
                frame.header.stamp = rospy.Time.now()
                frame.transform.rotation.w = 1
                frames.publish(TFMessage([frame]))
                time.sleep(0.02)

        thread = threading.Thread(target=broadcast, daemon=True)
        thread.start()
        wait_until(frames.get_num_connections, LIMIT_S, "listener of tf")
        time.sleep(0.3)
        self.left.frame = "tracker"
        self.press_probe_in()
        alive.set()
        thread.join()
        wait_until(lambda: self.force_n() == 0, 2, "end of the force")
        self.watch.wait_news()
        self.assertGreater(self.watch.value("left", "dropped_old_transform"), 0)


if __name__ == "__main__":
    rostest.rosrun("viscera", "input_test", InputTest, sys.argv)
