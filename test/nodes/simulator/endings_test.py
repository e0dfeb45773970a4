#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""How the nodes end: a wrong start is refused with a reason, a lost master is noticed, an interrupt is obeyed."""
import itertools
import os
import signal
import socket
import subprocess
import sys
import unittest

import rosgraph
import roslib.packages
import rospy
import rostest
from sensor_msgs.msg import Image
from simulator_watch import Latest, wait_until
from std_srvs.srv import Trigger
from viscera.msg import SurfaceVertices

REFUSAL_LIMIT_S = 20
END_LIMIT_S = 30
serial = itertools.count()
SCENE = "_scene:=" + os.path.join(roslib.packages.get_pkg_dir("viscera"), "test/nodes/support/front_wall.yaml")


NO_EGL = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/dev/null"}


def start(node, arguments, master_uri=None, more={}):
    environment = dict(os.environ, ROSCONSOLE_STDOUT_LINE_BUFFERED="1", **more)
    if master_uri:
        environment["ROS_MASTER_URI"] = master_uri
    path = roslib.packages.find_node("viscera", node)[0]
    name = "__name:=ending_%d" % next(serial)  # private parameters outlive a node: no name is used twice
    return subprocess.Popen([path, name] + arguments, env=environment, text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT)


def wait_ready(process):
    """Returns the simulator's output until it was ready."""
    said = ""
    for line in process.stdout:
        said += line
        if "ready" in line:
            return said
    raise AssertionError("the simulator ended before it was ready")


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


class EndingsTest(unittest.TestCase):
    def assertRefused(self, node, arguments, *words, more={}):
        """Asserts that the node ends by itself, with a status and one line that names the fault."""
        process = start(node, arguments, more=more)
        output = process.communicate(timeout=REFUSAL_LIMIT_S)[0]
        self.assertEqual(process.returncode, 1, output)
        fatal = [line for line in output.splitlines() if "FATAL" in line]
        self.assertEqual(len(fatal), 1, output)
        for word in words:
            self.assertIn(word, output)

    def test_unknown_scene_key_is_refused(self):
        self.assertRefused("simulator", ["_overrides:=bodies[0].spacing_mm=4"], "spacing_mm")

    def test_scene_value_out_of_range_is_refused(self):
        self.assertRefused("simulator", ["_overrides:=bodies[0].spacing_m=-1"], "spacing_m")

    def test_parameter_of_the_wrong_type_is_refused(self):
        self.assertRefused("simulator", ["_surface_rate_hz:=fast"], "~surface_rate_hz")
        self.assertRefused("stylus_replay", ["_loop:=maybe"], "~loop")
        self.assertRefused("simulator", ["_frame_prefix:=/left"], "~frame_prefix")  # as tf2 would refuse it

    def test_unknown_parameter_is_refused(self):
        self.assertRefused("simulator", ["_sceen:=heart"], "~sceen")

    def test_missing_files_are_refused(self):
        self.assertRefused("simulator", ["_scene:=nowhere"], "~scene", "nowhere")
        self.assertRefused("simulator", ["_mesh:=/nowhere.obj"], "~mesh", "/nowhere.obj")
        self.assertRefused("stylus_replay", ["_strokes:=nowhere"], "~strokes", "nowhere")

    def test_interrupt_ends_the_simulator_well(self):
        process = start("simulator", [SCENE])
        wait_ready(process)
        process.send_signal(signal.SIGINT)
        output = process.communicate(timeout=END_LIMIT_S)[0]
        self.assertEqual(process.returncode, 0, output)

    def test_without_egl_the_processor_steps_and_there_are_no_pictures(self):
        rospy.init_node("endings_test", disable_signals=True)
        process = start("simulator", [SCENE], more=NO_EGL)
        try:
            said = wait_ready(process)
            surface, picture = Latest("surface", SurfaceVertices), Latest("camera/image_raw", Image)
            shown = Latest("surface_strain", SurfaceVertices)
            wait_until(lambda: surface.count > 20, END_LIMIT_S, "surface")
            self.assertEqual((picture.count, shown.count), (0, 0))
            for name in ("pause", "reset", "resume"):
                answer = rospy.ServiceProxy(name, Trigger)()
                self.assertTrue(answer.success, answer.message)
        finally:
            process.send_signal(signal.SIGINT)
            output = said + process.communicate(timeout=END_LIMIT_S)[0]
        self.assertEqual(process.returncode, 0, output)
        warnings = [line for line in output.splitlines() if "WARN" in line]
        busy = "slower than", "no tick arrived in time"  # what else the machine does
        self.assertEqual([line for line in warnings if "no EGL device" not in line and not any(b in line for b in busy)], [])
        self.assertEqual(len([line for line in warnings if "no EGL device" in line]), 1, output)

    def test_without_egl_a_scene_that_asks_for_the_gpu_is_refused(self):
        self.assertRefused("simulator", [SCENE, "_overrides:=solver.backend=gpu"], "no EGL device", "solver.backend: auto", more=NO_EGL)

    def test_lost_master_ends_the_simulator_with_an_error(self):
        port = free_port()
        master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL)
        process = start("simulator", [SCENE], "http://localhost:%d" % port)
        try:
            wait_ready(process)
            view = rosgraph.Master("/endings_test", "http://localhost:%d" % port)
            wait_until(lambda: "/left/measured_cp" in dict(view.getSystemState()[1]), END_LIMIT_S, "subscription")
            master.terminate()
            master.wait(END_LIMIT_S)
            output = process.communicate(timeout=END_LIMIT_S)[0]
            self.assertEqual(process.returncode, 1, output)
            self.assertIn("master is lost", output)
        finally:
            for leftover in (master, process):
                if leftover.poll() is None:
                    leftover.kill()


if __name__ == "__main__":
    rostest.rosrun("viscera", "endings_test", EndingsTest, sys.argv)
