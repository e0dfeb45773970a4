#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A driver of every kind of config/devices, and a simulator with its name: the tool follows the stylus, the tissue
pushes back along the device's own axes, a button holds, and faults are reported in one line."""
import math
import os
import subprocess
import sys
import time
import unittest

import roslib.packages
import rospkg
import rospy
import rostest
import drivers
from program import Program, node
from simulator_watch import Latest, SimulatorWatch, wait_until
from tf2_msgs.msg import TFMessage
from turns import length, plus, rotation, times

LIMIT_S = 20
ABOVE, DEEP = 0.05, 0.012  # heights [m] of the probe's centre over the block, and 6 mm in it (its radius is 8)
SIDE = {"left": (-0.03, 0.01), "right": (0.03, -0.01)}  # x, y [m] of each stylus
PLACE_M, TURN = 2e-5, 2e-4  # a chain of rotations in double, and quaternions of four decimals in profiles
FELT_N = 0.05
ASIDE = 0.2  # share of a force that may be across the block's normal: its lattice is coarse
SCENE = os.path.join(rospkg.RosPack().get_path("viscera"), "test/nodes/input/devices.yaml")
# about an axis that belongs to no frame, to detect mixed-up axes
TURNED = rotation(0.18257419, 0.36514837, 0.54772256, 0.73029674)


def simulator(name, devices, options=(), more=()):
    return Program([node("simulator"), "__name:=" + name, "_scene:=" + SCENE,
                    "_devices:=" + ";".join(devices), "_device_options:=" + ";".join(options)] + list(more))


class DevicesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("devices_test")
        cls.tools = {}
        cls.tf = Latest("/tf", TFMessage, cls.on_tf)

    @classmethod
    def on_tf(cls, message):
        for transform in message.transforms:
            if transform.child_frame_id.endswith("_tool"):
                cls.tools[transform.child_frame_id[:-5]] = transform.transform

    def tool_is(self, stylus, at, turned):
        tool = self.tools.get(stylus)
        if not tool:
            return False
        place, turn = drivers.vector(tool.translation), tool.rotation
        off = [a - b for ra, rb in zip(rotation(turn.x, turn.y, turn.z, turn.w), turned) for a, b in zip(ra, rb)]
        return length(plus(place, at, -1)) < PLACE_M and length(off) < TURN

    def go(self, driver, height, seconds=0.5):
        start, begun = driver.at, time.monotonic()
        goal = SIDE[driver.stylus] + (height,)
        while driver.at != goal:
            way = min(1.0, (time.monotonic() - begun) / seconds)
            driver.at = goal if way == 1 else plus(start, plus(goal, start, -1), way)
            time.sleep(0.01)

    def drive(self, name, kinds):
        self.tools.clear()
        hands = [kind(stylus) for kind, stylus in zip(kinds, ("left", "right"))]
        options = ["%s.%s" % (device.stylus, option) for device in hands for option in device.options]
        program = simulator(name, [device.device() for device in hands], options)
        try:
            program.said("ready:")
            watch = SimulatorWatch(name)
            for device in hands:
                self.check(device, watch, program)
        finally:
            for device in hands:
                device.end()
            program.end()

    def check(self, device, watch, program):
        what = type(device).__name__
        device.turned = TURNED
        device.at = SIDE[device.stylus] + (ABOVE,)
        wait_until(lambda: self.tool_is(device.stylus, device.at, device.turned), LIMIT_S,
                   "tool of %s at %s: %s; %s" % (what, device.at, self.tools.get(device.stylus), program.output))
        time.sleep(0.3)  # initially outside of tissue, and its buttons are received as released
        device.press(1, False)
        self.go(device, DEEP)
        if device.feels:
            def felt():
                force = device.force_n
                return force and force[2] > FELT_N and math.hypot(force[0], force[1]) < ASIDE * force[2]
            wait_until(felt, LIMIT_S, "force of %s upwards: %s" % (what, device.force_n))
        wait_until(lambda: (watch.value(device.stylus, "nodes_touched") or 0) > 0, LIMIT_S, what + " touching")
        device.press(1, True)
        wait_until(lambda: (watch.value(device.stylus, "nodes_held") or 0) > 0, LIMIT_S, what + " holding")
        device.press(1, False)
        wait_until(lambda: watch.value(device.stylus, "nodes_held") == 0, LIMIT_S, what + " letting go")
        self.assertNotIn("dropped", program.output, what)
        self.go(device, ABOVE)

    def test_crtk_and_crtk_before_2022(self):
        self.drive("now_and_then", [drivers.Crtk, drivers.Crtk2021])

    def test_haptic_drivers_of_omni_common_and_ros_geomagic(self):
        self.drive("touches", [drivers.PhantomOmni, drivers.Geomagic])

    def test_trackers_in_tf(self):
        self.drive("trackers", [drivers.Polhemus, drivers.TfTracker])

    def test_motion_capture(self):
        self.drive("capture", [drivers.Vicon, drivers.OptiTrack])

    def test_bare_poses_and_a_dvrk_master(self):
        self.drive("bare", [drivers.BarePose, drivers.DvrkMaster])

    @unittest.skipUnless(roslib.packages.find_node("viscera", "haply_bridge"), "a build without Boost.Beast")
    def test_a_haply_inverse3(self):
        self.drive("haply", [drivers.HaplyInverse3])

    def test_what_a_clutch_a_moved_base_and_millimetres_do(self):
        self.tools.clear()
        device = drivers.DvrkMaster("left")
        other = drivers.TfTracker("right")
        program = simulator("odd", [device.device(), other.device()], ["right." + o for o in other.options])
        try:
            program.said("ready:")
            device.at, other.at = (0, 0, 0.1), (0.05, 0, 0.1)
            wait_until(lambda: self.tool_is("left", device.at, device.turned), LIMIT_S, "tool")
            device.clutch.publish(drivers.Joy(buttons=[1]))
            watch = SimulatorWatch("odd")
            wait_until(lambda: watch.value("left", "clutched") == "True", LIMIT_S, "clutch")
            device.at = (0.08, 0, 0.1)
            time.sleep(0.5)
            self.assertTrue(self.tool_is("left", (0, 0, 0.1), device.turned))
            device.clutch.publish(drivers.Joy(buttons=[0]))
            wait_until(lambda: watch.value("left", "clutched") == "False", LIMIT_S, "clutch let go")
            device.at = (0.08, 0.02, 0.1)
            wait_until(lambda: self.tool_is("left", (0, 0.02, 0.1), device.turned), LIMIT_S, "tool that goes on")
            wait_until(lambda: self.tool_is("right", other.at, other.turned), LIMIT_S, "tracked tool")
            other.camera = (0.2, 0.15, 0.4)  # the camera is moved aside; the stylus has not moved
            program.said("the frame 'camera' was moved")
            wait_until(lambda: watch.value("right", "base_moves") == 1, LIMIT_S, "moved base")
            other.camera_turned = rotation(0, 0, 0.25881905, 0.96592583)  # or rotated in place, by 30 degrees
            wait_until(lambda: watch.value("right", "base_moves") == 2, LIMIT_S, "turned base")
            wait_until(lambda: self.tool_is("right", other.at, other.turned), LIMIT_S, "tool that was not moved")
            self.assertEqual(watch.value("left", "base_moves"), 0)
        finally:
            device.end(), other.end()
            program.end()

    def test_millimetres_taken_for_metres_are_told(self):
        device = drivers.Geomagic("left")
        program = simulator("units", [device.device()], ["left.pose.unit_m=1"])
        try:
            device.at = (0, 0, 0.1)
            program.said("set pose.unit_m: 0.001 in its profile")
        finally:
            device.end()
            program.end()

    def test_wrong_choices_end_the_node_with_a_line(self):
        refused = []
        for number, (arguments, line) in enumerate((
            (["_devices:=left=no_such"], "no file"),
            (["_devices:=middle=crtk"], "no stylus 'middle'; it has left right"),
            (["_devices:=left"], "does not have the form left=polhemus:2"),
            (["_device_options:=left.pose.unit_m=0"], "'pose.unit_m' must be a number, 1e-06 .. 10 m; found '0'"),
            (["_device_options:=left.pose.axes=x y -z"], "must not mirror"),
            (["_devices:=left=tf", "_device_options:=left.button3.topic=a"], "unknown key 'button3'"),
            (["_registrations:=left=/nowhere.yaml"], "/nowhere.yaml: cannot be read"),
        )):
            refused.append((arguments, line, subprocess.Popen(
                [node("simulator"), "__name:=wrong%d" % number, "_scene:=" + SCENE] + arguments, text=True,
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)))
        for arguments, line, program in refused:
            said = program.communicate(timeout=60)[0]
            self.assertNotEqual(program.returncode, 0, arguments)
            self.assertIn(line, said, arguments)


if __name__ == "__main__":
    rostest.rosrun("viscera", "devices", DevicesTest, sys.argv)
