#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""`rosrun viscera status`: its output for a running session, and for one that does not exist."""
import os
import re
import subprocess
import sys
import tempfile
import threading
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from program import Program, node
from sensor_msgs.msg import Image
from simulator_watch import Latest, SimulatorWatch, wait_until

LIMIT_S = 20
NO_MASTER = "http://localhost:1"  # no master answers here


def status(*arguments, uri=None):
    environment = dict(os.environ, ROS_MASTER_URI=uri) if uri else None
    return subprocess.run([node("status")] + list(arguments), check=False, capture_output=True,
                          text=True, timeout=LIMIT_S, env=environment)


class StatusTest(unittest.TestCase):
    plain = {key: value for key, value in os.environ.items() if key != "ROSCONSOLE_STDOUT_LINE_BUFFERED"}

    @classmethod
    def setUpClass(cls):
        rospy.init_node("status_test")
        SimulatorWatch().wait_ready()

    def test_one_screen_of_a_session(self):
        told = status("_once:=true")
        self.assertEqual(told.returncode, 0, told)
        for words in ("simulator, heard", "running, tick", "of real time", "no device: no poses arrive",
                      "pictures of camera 0 /s"):
            self.assertIn(words, told.stdout)

    def test_no_simulator_and_no_master_are_told(self):
        other = status("_once:=true", "_simulator:=unknown")
        self.assertEqual(other.returncode, 1, other)
        self.assertIn("no simulator 'unknown'", other.stdout)
        self.assertIn("nodes that send /diagnostics: simulator", other.stdout)
        alone = status(uri=NO_MASTER)
        self.assertEqual(alone.returncode, 1, alone)
        self.assertIn("no ROS master answers at " + NO_MASTER, alone.stdout)
        wrong = status("_onec:=true")
        self.assertEqual(wrong.returncode, 1, wrong)
        self.assertIn("onec", wrong.stdout + wrong.stderr)

    def test_a_stylus_that_the_scene_has_not_is_an_error(self):
        with tempfile.TemporaryFile("w+") as log:  # lines must not wait for a full buffer
            wrong = [subprocess.Popen([node(name), "_stylus:=middle", "__name:=wrong_" + name],
                                      stdout=log, stderr=subprocess.PIPE, text=True, env=self.plain)
                     for name in ("stylus_marker", "stylus_joy")]
            try:
                wait_until(lambda: "rviz: add" in self.text_of(log), LIMIT_S, "line in the file")
                self.assertIsNone(wrong[0].poll())
                for program in wrong:
                    _, said = program.communicate(timeout=LIMIT_S)
                    self.assertEqual(program.returncode, 1)
                    self.assertIn("parameter ~stylus: the scene has no stylus 'middle'; it has left right", said)
            finally:
                for program in wrong:
                    program.kill()

    @staticmethod
    def text_of(file):
        return os.pread(file.fileno(), 10000, 0).decode()

    def test_screens_follow_pictures_and_dropped_poses(self):
        picture = Latest("camera/image_raw", Image)
        lost = rospy.Publisher("left/measured_cp", PoseStamped, queue_size=1)
        wait_until(lambda: picture.count and lost.get_num_connections(), LIMIT_S, "pictures")
        ended = threading.Event()
        thread = threading.Thread(target=self.send, args=(lost, ended), daemon=True)
        thread.start()
        shown = Program([node("status")])
        try:
            shown.said("no_transform: tf does not connect")
            shown.said("left: messages are dropped")
            shown.said("no pose yet, although a device is connected")
            rates = lambda: re.findall(r"pictures of camera ([0-9.]+) /s", shown.output)
            wait_until(lambda: any(float(rate) > 0 for rate in rates()), LIMIT_S, "rate of pictures")
        finally:
            ended.set()
            thread.join()
            shown.end()

    @staticmethod
    def send(publisher, ended):
        while not ended.wait(0.02):
            message = PoseStamped()
            message.header.frame_id = "nowhere"
            message.header.stamp = rospy.Time.now()
            message.pose.orientation.w = 1
            publisher.publish(message)


if __name__ == "__main__":
    rostest.rosrun("viscera", "status_test", StatusTest, sys.argv)
