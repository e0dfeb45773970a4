#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Styluses without a device: a marker of rviz pushes the tissue, and a gamepad drives a tip."""
import array
import math
import re
import subprocess
import sys
import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import Joy
from program import Program, node
from simulator_watch import Latest, SimulatorWatch, wait_until
from turns import rotation
from viscera.msg import SurfaceVertices
from viscera.srv import SetToolMode
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit, Marker

LIMIT_S = 20
SPEED_M_PER_S = 0.1                # default of both nodes
BUSY = 1.5                         # factor for stamps of a busy machine: a step may be sent late
JOY_HZ = 50
FELT_N = 0.02
START = (0, -0.1, -0.02)           # of steering.test: the blade is along y
PLACE_M = 1e-6
EDGE_M = 0.01                      # of the surface's triangles: no corner is further from the nearest point
DEAD_RVIZ_S = 3                    # time after which the node releases the button


class Path:
    """Poses of a stylus, as (stamp, position)."""

    def __init__(self, stylus):
        self.places = []
        self.last_sent = (0, 0)  # stamp and number of the newest pose
        self.topic = Latest(stylus + "/measured_cp", PoseStamped, self.note, queue_size=1000)

    def note(self, message):
        p = message.pose.position
        self.last_sent = (message.header.stamp.to_sec(), message.header.seq)
        self.places.append((message.header.stamp.to_sec(), (p.x, p.y, p.z)))

    def at(self):
        return self.places[-1][1]

    def fastest(self, window_s=0.2):
        """Returns the largest speed, over windows that are long relative to the jitter of a busy machine."""
        fastest, first = 0, 0
        for stamp, place in self.places:
            while stamp - self.places[first][0] > window_s:
                fastest = max(fastest, math.dist(place, self.places[first][1]) / (stamp - self.places[first][0]))
                first += 1
        return fastest


class Gamepad:
    def __init__(self):
        self.publisher = rospy.Publisher("joy", Joy, queue_size=1)
        self.message = None
        threading.Thread(target=self.play, daemon=True).start()

    def play(self):
        while not rospy.is_shutdown():
            if self.message:
                self.publisher.publish(self.message)
            time.sleep(1 / JOY_HZ)


class SteeringTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("steering_test")
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()
        cls.left, cls.right = Path("left"), Path("right")
        cls.buttons = {name: Latest(name, Joy) for name in ("left/button1", "left/button2", "right/button1", "right/button2")}
        cls.feedback = rospy.Publisher("left/marker/feedback", InteractiveMarkerFeedback, queue_size=10)
        wait_until(lambda: cls.feedback.get_num_connections() and cls.left.places, LIMIT_S, "stylus_marker")

    def down(self, name):
        message = self.buttons[name].message
        return bool(message and message.buttons[0])

    def mouse(self, event, control="grip"):
        """Sends MOUSE_DOWN, MOUSE_UP, BUTTON_CLICK or KEEP_ALIVE, as rviz does."""
        self.feedback.publish(InteractiveMarkerFeedback(marker_name="stylus", client_id="test", control_name=control,
                                                        event_type=getattr(InteractiveMarkerFeedback, event)))

    def drag(self, at, frame="tissue", control="grip"):
        message = InteractiveMarkerFeedback(marker_name="stylus", client_id="test", control_name=control,
                                            event_type=InteractiveMarkerFeedback.POSE_UPDATE)
        message.header.frame_id = frame
        p = message.pose.position
        p.x, p.y, p.z = at
        message.pose.orientation.x = message.pose.orientation.w = math.sqrt(0.5)
        self.feedback.publish(message)

    def marker(self, topic="left/marker/update_full"):
        """Returns the marker as rviz currently has it."""
        shown = Latest(topic, InteractiveMarkerInit)
        wait_until(lambda: shown.message and shown.message.markers, LIMIT_S, "marker")
        shown.stop()
        return shown.message.markers[0]

    def titles(self):
        return [e.title for e in self.marker().menu_entries]

    def choose(self, title):
        """Chooses an entry of the menu, as rviz would."""
        entry = next(e.id for e in self.marker().menu_entries if title in e.title)
        self.feedback.publish(InteractiveMarkerFeedback(marker_name="stylus", client_id="test", menu_entry_id=entry,
                                                        event_type=InteractiveMarkerFeedback.MENU_SELECT))

    def check(self, title):
        """Chooses an entry with a check box, and waits until it shows the other state."""
        before = next(t for t in self.titles() if title in t)
        self.choose(title)
        wait_until(lambda: before not in self.titles(), LIMIT_S, "box of " + title)

    def wait_at(self, at):
        wait_until(lambda: math.dist(self.left.at(), at) < PLACE_M, LIMIT_S, "tip at %s" % (at,))

    def test_1_marker_pushes_the_tissue_at_a_limited_speed(self):
        force = Latest("left/body/servo_cf", WrenchStamped)
        self.drag((0, -0.05, -0.02))               # the mouse jumps by 5 cm
        wait_until(lambda: math.dist(self.left.at(), (0, -0.05, -0.02)) < 1e-9, LIMIT_S, "tip at the marker")
        self.assertLess(self.left.fastest(), BUSY * SPEED_M_PER_S)
        wait_until(lambda: force.message and force.message.wrench.force.y < -FELT_N, LIMIT_S, "force out of the tissue")
        self.drag((0, 0, 0), "camera_optical_frame")   # another frame: dropped
        self.drag((math.nan, 0, 0))
        time.sleep(0.3)
        self.assertLess(math.dist(self.left.at(), (0, -0.05, -0.02)), 1e-9)
        self.choose("Back to the start")
        wait_until(lambda: math.dist(self.left.at(), (0, -0.1, -0.02)) < 1e-9, LIMIT_S, "tip at the start")

    def test_2_menu_presses_the_buttons_by_the_names_of_what_they_do(self):
        wait_until(lambda: any("Grab (button 1)" in t for t in self.titles()), LIMIT_S, "names of modes")
        for number, title in ((1, "Grab"), (2, "Cut")):
            name = "left/button%d" % number
            self.check(title)
            wait_until(lambda: self.down(name), LIMIT_S, name)
            self.check(title)
            wait_until(lambda: not self.down(name), LIMIT_S, name)
        change = rospy.ServiceProxy("set_tool_mode", SetToolMode)
        self.assertTrue(change("left", "button2", "suction").success)
        wait_until(lambda: any("Suction (button 2)" in t for t in self.titles()), LIMIT_S, "new name")
        self.assertTrue(change("left", "button2", "cut").success)
        wait_until(lambda: any("Cut (button 2)" in t for t in self.titles()), LIMIT_S, "old name")

    def test_2b_handles_press_while_they_are_dragged(self):
        to = (0, -0.1, -0.01)
        for number in (1, 2):
            name, handle = "left/button%d" % number, "press button %d" % number
            self.assertIn(handle, [c.name for c in self.marker().controls])
            self.mouse("MOUSE_DOWN", handle)
            wait_until(lambda: self.down(name), LIMIT_S, name)
            self.drag(to, control=handle)
            self.wait_at(to)
            self.assertTrue(self.down(name))
            self.mouse("MOUSE_UP", handle)
            wait_until(lambda: not self.down(name), LIMIT_S, "button let go")
        self.mouse("MOUSE_DOWN", "press button 1")
        wait_until(lambda: self.down("left/button1"), LIMIT_S, "button 1")
        end = time.monotonic() + DEAD_RVIZ_S + 0.5
        while time.monotonic() < end:
            self.mouse("KEEP_ALIVE", "press button 1")    # rviz sends it while the mouse does not move
            time.sleep(0.25)
        self.assertTrue(self.down("left/button1"))
        wait_until(lambda: not self.down("left/button1"), LIMIT_S, "button of an rviz that is gone")
        self.choose("Back to the start")
        self.wait_at(START)

    def test_2c_steps_are_coarse_or_fine(self):
        self.mouse("BUTTON_CLICK", "forward")
        self.drag(START, control="forward")        # rviz sends it after a click
        self.wait_at((0, START[1] + 0.005, START[2]))
        self.mouse("BUTTON_CLICK", "back")
        self.wait_at(START)
        self.check("Fine: steps of 0.5 mm instead of 5 mm")
        self.mouse("BUTTON_CLICK", "forward")
        self.wait_at((0, START[1] + 0.0005, START[2]))
        self.mouse("BUTTON_CLICK", "back")
        self.mouse("MOUSE_DOWN")
        for way in (0.005, 0.02):
            self.drag((way, START[1], START[2]))
        self.wait_at((0.002, START[1], START[2]))
        self.mouse("MOUSE_UP")                     # the ball moves to the tip
        wait_until(lambda: abs(self.marker().pose.position.x - 0.002) < PLACE_M, LIMIT_S, "marker at the tip")
        self.check("Fine")
        self.choose("Back to the start")
        self.wait_at(START)

    def test_2d_distance_from_the_skin_is_told(self):
        text = Latest("left/marker/text", Marker)
        surface = Latest("surface", SurfaceVertices)
        wait_until(lambda: surface.message and text.message and " mm from the skin" in text.message.text, LIMIT_S, "distance")
        corners = array.array("f", surface.message.positions_m)
        away = min(math.dist(START, corners[i:i + 3]) for i in range(0, len(corners), 3))
        told = 1e-3 * float(re.search(r"^probe, ([0-9.]+) mm from the skin$", text.message.text).group(1))
        self.assertLess(told, away + 1e-4)
        self.assertGreater(told, away - EDGE_M)
        change = rospy.ServiceProxy("set_tool_mode", SetToolMode)
        self.assertTrue(change("left", "idle", "none").success)   # a probe would push the surface ahead of it
        depths = iter(range(20))

        def goes_in():
            self.drag((0, START[1] + 0.03 + 0.002 * next(depths), START[2]))
            time.sleep(0.3)
            return re.search("^none, [0-9.]+ mm under the skin$", text.message.text)
        wait_until(goes_in, LIMIT_S, "tip in the organ's wall")
        self.mouse("MOUSE_UP")
        self.choose("Back to the start")
        self.wait_at(START)
        self.assertTrue(change("left", "idle", "probe").success)
        text.stop()
        surface.stop()

    def test_2e_it_begins_in_front_of_the_organ_and_points_at_it(self):
        names = ["left/%s:=waiting/%s" % (name, name) for name in
                 ("measured_cp", "button1", "button2", "marker/update", "marker/update_full", "marker/feedback", "marker/text")]
        other = Program([node("stylus_marker"), "__name:=waiting", "_stylus:=left"] + names)
        try:
            pose = Latest("waiting/measured_cp", PoseStamped)
            surface = Latest("surface", SurfaceVertices)
            wait_until(lambda: pose.message and surface.message, LIMIT_S, "start")
            corners = array.array("f", surface.message.positions_m)
            lows, highs = ([f(corners[axis::3]) for axis in range(3)] for f in (min, max))
            middle = [(low + high) / 2 for low, high in zip(lows, highs)]
            p, q = pose.message.pose.position, pose.message.pose.orientation
            away = [a - b for a, b in zip((p.x, p.y, p.z), middle)]
            shaft = [row[2] for row in rotation(q.x, q.y, q.z, q.w)]
            far = math.hypot(*away)
            self.assertGreater(sum(a * b for a, b in zip(shaft, away)) / far, 0.999)   # the tip points at the centre
            self.assertLess(away[1], 0)                                              # rviz looks from there
            self.assertGreater(min(math.dist((p.x, p.y, p.z), corners[i:i + 3]) for i in range(0, len(corners), 3)), 0.01)
            self.assertLess(far, math.dist(middle, highs) + 0.02)
            self.assertLess(self.marker("waiting/marker/update_full").pose.position.y, middle[1])
        finally:
            other.end()

    def test_3_poses_come_steadily_while_nothing_moves(self):
        # Counted by the sender's numbers: rospy is late on a busy machine.
        begun_s, first = self.left.last_sent
        wait_until(lambda: self.left.last_sent[0] > begun_s + 1, LIMIT_S, "a second of poses")
        ended_s, last = self.left.last_sent
        self.assertGreater((last - first) / (ended_s - begun_s), 50)   # half of ~rate_hz
        self.assertFalse(self.watch.status("left").message.startswith("stale"))

    def test_4_gamepad_drives_the_tip(self):
        self.assertFalse(self.right.places)        # no stylus before there is a gamepad
        pad = Gamepad()
        pad.message = Joy(axes=[0, 0.05], buttons=[0, 0])   # within the dead zone
        wait_until(lambda: len(self.right.places) > 20, LIMIT_S, "poses")
        self.assertEqual(self.right.at(), (0.1, 0, 0))
        pad.message = Joy(axes=[0, -1], buttons=[0, 1])
        wait_until(lambda: self.right.at()[0] < 0.08, LIMIT_S, "way of 2 cm")
        self.assertLess(self.right.fastest(), BUSY * SPEED_M_PER_S)
        wait_until(lambda: self.down("right/button2") and not self.down("right/button1"), LIMIT_S, "button 2")
        wait_until(lambda: self.right.at()[0] < 0.0501, LIMIT_S, "end of its reach")
        time.sleep(0.3)
        self.assertAlmostEqual(self.right.at()[0], 0.05)
        pad.message = Joy(axes=[0.55, 0], buttons=[0, 1])
        wait_until(lambda: self.right.topic.message.pose.orientation.x < -0.1, LIMIT_S, "turn")
        pad.message = None                         # unplugged
        wait_until(lambda: not self.down("right/button2"), LIMIT_S, "button let go")
        stands, count = self.right.topic.message.pose.orientation.x, len(self.right.places)
        wait_until(lambda: len(self.right.places) > count + 20, LIMIT_S, "poses of a stylus at rest")
        self.assertEqual(self.right.topic.message.pose.orientation.x, stands)

    def test_5_bad_parameters_are_refused(self):
        refused = []
        for number, (name, argument, words) in enumerate((("stylus_joy", "_axes:=0 1 2", "~axes: must be six words"),
                                                          ("stylus_marker", "_start:=0 0 1", "~start: must be 6 numbers"),
                                                          ("stylus_marker", "_axes:=none", "~axes: unknown"),
                                                          ("stylus_marker", "_fine_step_m:=0.01", "~fine_step_m: must not be more"),
                                                          ("stylus_joy", "_dead_zone:=2", "~dead_zone: must be a number, 0..0.9"))):
            refused.append((words, subprocess.Popen([node(name), "__name:=refused%d" % number, argument], text=True,
                                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT)))
        for words, program in refused:
            said = program.communicate(timeout=LIMIT_S)[0]
            self.assertEqual(program.returncode, 1, said)
            self.assertIn(words, said)


if __name__ == "__main__":
    rostest.rosrun("viscera", "steering_test", SteeringTest, sys.argv)
