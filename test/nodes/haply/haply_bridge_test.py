#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""haply_bridge with a simulated service: poses and buttons in, forces out, and what ends or spoils either. How a
simulator feels such a device is tested with the other drivers (rostest_devices)."""
import json
import signal
import sys
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from haply_service import HaplyService
from program import Program, node
from sensor_msgs.msg import Joy
from simulator_watch import Latest, SimulatorWatch, wait_until
from std_msgs.msg import Bool

LIMIT_S = 20
TURNED = (0.0, 0.0, 0.70710678, 0.70710678)  # a grip that is turned by a quarter about z: its x is y of the base
ROUNDING = 1e-6                              # of a turn by quaternions with eight digits
STOPS_S = 0.5                                # until a device without wrenches gets no force; the time-out is 0.05 s
AGAIN_S = 10                                 # until a service that is back is used; tries are a second apart


class HaplyBridgeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("haply_bridge_test")
        cls.pose = Latest("inverse3/measured_cp", PoseStamped)
        cls.speed = Latest("inverse3/measured_cv", TwistStamped)
        cls.joys = []
        cls.joy = Latest("inverse3/buttons", Joy, lambda m: cls.joys.append(list(m.buttons)), queue_size=10)
        cls.wrench = rospy.Publisher("inverse3/body/servo_cf", WrenchStamped, queue_size=1, tcp_nodelay=True)
        cls.absolute = rospy.Publisher("inverse3/body/set_cf_orientation_absolute", Bool, queue_size=1, latch=True)
        cls.watch = SimulatorWatch("haply_bridge")

    def begin(self, *arguments, **options):
        del self.joys[:]
        self.service = HaplyService(**options)
        self.bridge = Program([node("haply_bridge"), "_port:=%d" % self.service.port, "_rate_hz:=200", *arguments])
        self.bridge.said("connected: ")
        wait_until(lambda: self.wrench.get_num_connections() and self.absolute.get_num_connections(), LIMIT_S, "bridge")

    def tearDown(self):
        self.bridge.end()
        rospy.delete_param("/haply_bridge")  # of the arguments, which the next start would use
        self.service.stop()

    def push(self, *force, until, what):
        """Sends a wrench until the device has the force."""
        message = WrenchStamped()
        message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = force

        def check():
            for _ in range(10):  # as often as a simulator does: the device has a force for 0.05 s
                self.wrench.publish(message)
                time.sleep(0.01)
                if until(self.service.force):
                    return True
            return False
        wait_until(check, LIMIT_S, "%s: %s" % (what, self.service.force))

    def has(self, *force):
        return lambda got: got and max(abs(a - b) for a, b in zip(got, force)) < ROUNDING

    def wait_pose(self, at):
        wait_until(lambda: self.pose.message and abs(self.pose.message.pose.position.x - at) < ROUNDING, LIMIT_S, "pose at %g" % at)

    def dropped(self, count):
        return lambda: self.watch.value("inverse3", "dropped") == count

    def test_poses_buttons_and_forces(self):
        self.begin()
        service = self.service
        service.at, service.speed, service.grip = (0.01, -0.13, 0.16), (0.1, 0.2, 0.3), TURNED
        self.wait_pose(0.01)
        wait_until(lambda: self.pose.message.pose.orientation.z > 0.7, LIMIT_S, "turned grip")
        self.assertEqual(self.pose.message.header.frame_id, "inverse3_base")
        self.assertLess((rospy.Time.now() - self.pose.message.header.stamp).to_sec(), 1)
        wait_until(lambda: self.speed.message.twist.linear.z == 0.3, LIMIT_S, "speed")
        self.assertEqual(self.joys, [[0, 0, 0]])
        service.buttons[1] = True
        wait_until(lambda: self.joys[-1] == [0, 1, 0], LIMIT_S, "button b")
        self.assertEqual(service.sessions, [{"configure": {"profile": {"name": "viscera:haply_bridge"}}}], "with the first message alone")
        self.absolute.publish(False)
        self.push(1, 0, 0.5, until=self.has(0, 1, 0.5), what="a force in the frame of the grip, as CRTK has it")
        self.absolute.publish(True)
        self.push(1, 0, 0.5, until=self.has(1, 0, 0.5), what="a force in the frame of the poses")
        self.push(0, 30, 40, until=self.has(0, 2.4, 3.2), what="a force within ~max_force_n")
        self.push(0, 0, float("nan"), until=lambda got: got == (0, 0, 0), what="no force for NaN")
        wait_until(lambda: (self.watch.value("inverse3", "dropped") or 0) > 0, LIMIT_S, "count of the wrench that is none")

    def test_an_older_service_and_a_device_without_a_grip(self):
        self.begin("_grip:=none", "_device:=right", version=3.1)
        self.bridge.said("connected: 049D, right-handed")
        self.service.at = (0.02, 0, 0.1)
        self.wait_pose(0.02)
        self.assertLess(self.pose.message.pose.orientation.x, -0.7, "it points down")
        self.assertEqual(self.service.sessions, [])
        self.absolute.publish(True)
        self.push(0, 0, 1, until=self.has(0, 0, 1), what="a force as `values`")

    def test_force_ends_with_wrenches_and_with_the_bridge(self):
        self.begin()
        self.absolute.publish(True)
        for end in ("silence", signal.SIGTSTP, signal.SIGINT):
            self.push(0, 0, 1, until=self.has(0, 0, 1), what="force before " + str(end))
            if end != "silence":
                self.bridge.process.send_signal(end)
            wait_until(lambda: self.service.force == (0, 0, 0), STOPS_S + 1, "end of the force by %s" % end)
            if end == signal.SIGTSTP:
                self.bridge.process.send_signal(signal.SIGCONT)
        self.assertEqual(self.bridge.process.wait(LIMIT_S), 0)

    def test_bad_messages_are_dropped_and_counted(self):
        self.begin("_grip:=61548")  # roscpp makes it an integer
        state = self.service.state()
        spoilt = []
        for change in (lambda s: s["inverse3"].clear(), lambda s: s["wireless_verse_grip"].clear(),
                       lambda s: s["inverse3"][0]["state"]["cursor_position"].pop("y"),
                       lambda s: s["inverse3"][0]["state"].update(cursor_position=[1, 2, 3]),
                       lambda s: s["wireless_verse_grip"][0]["state"]["orientation"].update(w=3),
                       lambda s: s.update(inverse3="none")):
            copy = json.loads(json.dumps(state))
            change(copy)
            spoilt.append(json.dumps(copy))
        spoilt += ["", "[", "3", "{" * 5000, json.dumps(state).replace("-0.12", "1e999"), json.dumps(state).replace("-0.12", "NaN")]
        before = self.pose.count
        self.service.instead += spoilt
        wait_until(lambda: not self.service.instead, LIMIT_S, "all spoilt messages")
        wait_until(self.dropped(len(spoilt)), LIMIT_S, "%d dropped messages: %s" % (len(spoilt), self.watch.value("inverse3", "dropped")))
        self.bridge.said("messages were dropped so far; the last: ")
        wait_until(lambda: self.pose.count > before + len(spoilt), LIMIT_S, "poses afterwards")
        self.assertEqual(self.watch.value("inverse3", "connections"), 1)
        self.service.calibrated = False
        wait_until(lambda: "not calibrated" in self.watch.status("inverse3").message, LIMIT_S, "a device that is not calibrated")
        self.service.has_grip = False
        wait_until(lambda: "no pose in the last second; the last message dropped: a state lacks the grip 61548" in
                   self.watch.status("inverse3").message, LIMIT_S, "a grip that has gone")

    def test_it_connects_again(self):
        self.begin()
        self.wait_pose(0)
        self.service.stop()
        self.bridge.said("no connection to the Haply Inverse Service at 127.0.0.1 port %d (" % self.service.port)
        wait_until(lambda: "no connection" in self.watch.status("inverse3").message, LIMIT_S, "diagnostics")
        self.service.force, self.service.at = None, (0.03, 0, 0.1)
        self.service.start()
        wait_until(lambda: self.service.force == (0, 0, 0), AGAIN_S, "a command without force")
        self.wait_pose(0.03)
        self.service.mute = True  # a service that hangs
        self.bridge.said("no connection", count=2)
        self.service.mute, self.service.has_grip = False, False
        self.service.at = (0.04, 0, 0.1)
        self.bridge.said("without a grip")
        self.wait_pose(0.04)
        time.sleep(2)  # the diagnostics are sent once a second
        connections = self.watch.value("inverse3", "connections")
        self.service.grip, self.service.has_grip = TURNED, True
        self.bridge.said("a grip has come: 049D, right-handed, grip 61548")
        wait_until(lambda: self.pose.message.pose.orientation.z > 0.7, LIMIT_S, "orientation of the grip")
        time.sleep(2)
        self.assertEqual(self.watch.value("inverse3", "connections"), connections, "a new connection would leave a force on the motors")

    def test_a_device_that_is_not_there_is_named(self):
        self.begin()
        lost = Program([node("haply_bridge"), "__name:=other", "_port:=%d" % HaplyService().port, "_device:=left"])
        lost.said("no Inverse3 'left' (~device); it has 049D (right)")
        lost.end()
        for parameter, words in (("_port:=0", "~port"), ("_rate_hz:=9", "~rate_hz"), ("_grp:=none", "~grp")):
            wrong = Program([node("haply_bridge"), "__name:=wrong", parameter])
            self.assertEqual(wrong.process.wait(LIMIT_S), 1, parameter)
            wrong.said(words)
            rospy.delete_param("/wrong")


if __name__ == "__main__":
    rostest.rosrun("viscera", "haply_bridge", HaplyBridgeTest, sys.argv)
