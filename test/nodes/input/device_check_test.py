#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""`rosrun viscera device_check` with a simulated operator, who follows its prompts with a driver of config/devices.
Correct properties are confirmed, faults are named, and the profile that it writes corrects them."""
import math
import os
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import rospy
import rostest
from drivers import Crtk, Geomagic, PhantomOmni
from simulator_watch import SimulatorWatch, wait_until
from devices_test import simulator
from turns import IDENTITY, plus, times

LIMIT_S = 30
WINDOW_S = 0.5
SETTLE_S = 0.15
FRONT = (0, -0.09, 0.05)  # initial position of the stylus, tissue frame
WAY_M, TURN = 0.1, 0.8


def about(axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    return {"x": ((1, 0, 0), (0, c, -s), (0, s, c)), "y": ((c, 0, s), (0, 1, 0), (-s, 0, c)),
            "z": ((c, -s, 0), (s, c, 0), (0, 0, 1))}[axis]


MOVES = {"45 degrees to the right": lambda share: ((0, 0, 0), about("y", TURN * share)),
         "to the right": lambda share: ((WAY_M * share, 0, 0), IDENTITY),
         " up ... ": lambda share: ((0, 0, WAY_M * share), IDENTITY),
         "towards you": lambda share: ((0, -WAY_M * share, 0), IDENTITY),
         "counter-clockwise": lambda share: ((0, 0, 0), about("z", TURN * share)),
         "away from you": lambda share: ((0, 0, 0), about("x", -TURN * share)),
         "move it about": lambda share: ((0.05 * math.sin(6 * share), 0, 0), IDENTITY)}


class Operator:
    """Reads the prompts, presses Enter, and follows them with the driver."""

    def __init__(self, driver, *arguments, answers=()):
        self.driver, self.answers = driver, list(answers)
        driver.at = FRONT
        self.said = ""
        self.program = subprocess.Popen(["rosrun", "viscera", "device_check", "_window_s:=%g" % WINDOW_S] + list(arguments),
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.status = None
        thread = threading.Thread(target=self.work, daemon=True)
        thread.start()
        thread.join(2 * LIMIT_S)
        self.program.kill()

    def work(self):
        for line in self.program.stdout:
            self.said += line
            if "Enter" in line and "continues" not in line and "WRONG" not in line:
                self.type(next((answer for words, answer in self.answers if words in line), ""))
            elif " ... " in line:
                self.do(line)
        self.status = self.program.wait(LIMIT_S)

    def type(self, text):
        self.program.stdin.write(text + "\n")
        self.program.stdin.flush()

    def do(self, line):
        move = next((move for words, move in MOVES.items() if words in line), None)
        if move:
            for step in range(21):
                way, turn = move(step / 20)
                self.driver.at, self.driver.turned = plus(FRONT, way), turn
                time.sleep(0.5 * WINDOW_S / 20)
            time.sleep(0.6 * WINDOW_S)
            self.driver.at, self.driver.turned = FRONT, IDENTITY
            time.sleep(SETTLE_S)  # all poses of the motion must arrive before Enter begins the next step
        elif "press and let go" in line:
            button = 1 if "first button" in self.said.rsplit("Enter, then press", 1)[-1] else 2
            for down in (True, False):
                time.sleep(0.2 * WINDOW_S)
                self.driver.press(button, down)
        elif "touch the tissue" in line:
            self.touch()

    def touch(self):
        for height in (0.05, 0.03, 0.02, 0.016, 0.014, 0.012, 0.012, 0.012, 0.05):
            self.driver.at = (-0.03, 0.01, height)
            time.sleep(0.4)

    def judged(self, words):
        """Returns the judgement of these words, such as `right` or `WRONG`."""
        lines = [line.split() for line in self.said.splitlines() if words in line]
        return lines[-1][0] if lines else None


class MillimetreCrtk(Crtk):
    """A driver with every fault: millimetres, y up, another button, an unknown frame."""

    def open(self):
        super().open()
        self.pedals = self.joy("foot/pedals")

    def tell(self, position, rotation):
        up = ((1, 0, 0), (0, 0, 1), (0, -1, 0))
        from geometry_msgs.msg import PoseStamped
        from drivers import fill
        message = PoseStamped()
        message.header.stamp = rospy.Time.now()
        message.header.frame_id = "unknown_frame"
        fill(message.pose, [1000 * x for x in times(up, position)], times(up, rotation))
        self.poses.publish(message)

    def press(self, button, down):
        from sensor_msgs.msg import Joy
        self.pedals.publish(Joy(buttons=[0, int(down and button == 1), int(down and button == 2)]))


class MirroredCrtk(Crtk):
    """Left-handed axes: no profile with three axes corrects them."""

    def tell(self, position, rotation):
        super().tell((-position[0], position[1], position[2]), rotation)


class DeviceCheckTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("device_check_test")
        cls.folder = tempfile.mkdtemp()

    def check_all_right(self, seen):
        self.assertEqual(seen.status, 0, seen.said)
        for words in ("right: right, by", "up: right, by", "towards you: right, by", "turn to the left: right", "rate:",
                      "tilt to the right: right", "tilt away from you: right", "button1: seen on", "button2: seen on"):
            self.assertEqual(seen.judged(words), "right", (words, seen.said))
        self.assertIn("\n0 wrong", seen.said)

    def test_1_what_is_wrong_is_named_and_the_profile_that_is_written_is_right(self):
        driver = MillimetreCrtk("left")
        try:
            file = os.path.join(self.folder, "mended.yaml")
            seen = Operator(driver, "device_left:=crtk", "--write", file)
            self.assertEqual(seen.status, 0, seen.said)
            for words, verdict in (("right: right, by", "right"), ("up: axes are swapped, the tool goes away from you", "WRONG"),
                                   ("towards you: axes are swapped, the tool goes up", "WRONG"),
                                   ("turn to the left: axes are swapped, the tool tilts to the right", "WRONG"),
                                   ("the device sends millimetres", "WRONG"),
                                   ("but on /foot/pedals, number 1", "WRONG"), ("but on /foot/pedals, number 2", "WRONG"),
                                   ("tf does not connect 'unknown_frame' to 'tissue'", "note")):
                self.assertEqual(seen.judged(words), verdict, (words, seen.said))
            self.assertIn("roslaunch viscera training.launch device_left:=" + file, seen.said)
            again = Operator(driver, "device_left:=" + file)
            self.check_all_right(again)
            self.assertIn("the profile is right as it is", again.said)
            self.follows(driver, file)
        finally:
            driver.end()

    def follows(self, driver, file):
        """A simulator with the profile has the tool in front of the organ while the stylus has not moved."""
        running = simulator("mended", ["left=" + file])
        try:
            watch = SimulatorWatch("mended")
            watch.wait_ready()
            driver.at = FRONT
            wait_until(lambda: (watch.value("left", "poses_accepted") or 0) > 100, LIMIT_S, "poses")
            self.assertEqual(watch.value("left", "dropped_outside_workspace"), 0)
            self.assertEqual(watch.value("left", "dropped_no_transform"), 0)
        finally:
            running.end()

    def test_2_profiles_of_drivers_are_right_and_forces_are_felt(self):
        driver = PhantomOmni("left")
        try:
            self.check_all_right(Operator(driver, "device_left:=phantom_omni"))
        finally:
            driver.end()
        driver = Crtk("left")
        driver.at = FRONT
        running = simulator("felt", [])
        try:
            SimulatorWatch("felt").wait_ready()
            seen = Operator(driver, "device_left:=crtk", answers=[("To feel them type yes", "yes"), ("Did you feel", "y")])
            self.check_all_right(seen)
            self.assertEqual(seen.judged("against the motion, out of the tissue"), "right", seen.said)
            self.assertEqual(seen.judged("felt out of the tissue"), "right", seen.said)
        finally:
            running.end()
            driver.end()

    def test_3_without_a_profile_what_moves_is_found(self):
        driver = Geomagic("left")
        still = Crtk("other")
        still.at = FRONT
        try:
            seen = Operator(driver)
            self.assertIn("/Geomagic/pose", seen.said)
            self.assertIn("it moves: profile geomagic:/Geomagic", seen.said)
            self.assertIn("/other/measured_cp: ", seen.said)
            self.check_all_right(seen)
        finally:
            driver.end()
            still.end()

    def test_3b_where_no_profile_helps_none_is_written(self):
        driver = MirroredCrtk("left")
        file = os.path.join(self.folder, "mirrored.yaml")
        try:
            seen = Operator(driver, "device_left:=crtk", "--write", file)
            self.assertEqual(seen.status, 1, seen.said)
            self.assertEqual(seen.judged("places: a mirror image"), "WRONG", seen.said)
            self.assertIn("No profile is written", seen.said)
            self.assertFalse(os.path.exists(file))
        finally:
            driver.end()

    def test_4_wrong_arguments_and_a_device_that_is_silent(self):
        there = os.path.join(self.folder, "there.yaml")
        open(there, "w").close()
        refused = []
        for number, (arguments, words) in enumerate((
                (["device_left:=nosuch"], "device_left"),
                (["device_left:=crtk", "--write", there], "already exists and is not overwritten"),
                (["device_left:=crtk", "_wirte:=x"], "wirte"),
                (["device_options:=a.b=1"], "_device_options"),
                (["device_left:=crtk_arm:PSM1"], "nothing to check"))):
            refused.append((words, subprocess.Popen(
                ["rosrun", "viscera", "device_check", "__name:=refused%d" % number] + arguments, stdin=subprocess.DEVNULL,
                text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)))
        for words, program in refused:
            said = program.communicate(timeout=LIMIT_S)[0]
            self.assertEqual(program.returncode, 1, said)
            self.assertIn(words, said)
        silent = Crtk("silent")
        try:
            seen = Operator(silent, "device_left:=crtk:unknown")
            self.assertEqual(seen.status, 1, seen.said)
            self.assertEqual(seen.judged("no pose arrived"), "WRONG", seen.said)
            self.assertIn("found /silent/measured_cp, which fits profile crtk:/silent", seen.said)
        finally:
            silent.end()


if __name__ == "__main__":
    rostest.rosrun("viscera", "device_check", DeviceCheckTest, sys.argv)
