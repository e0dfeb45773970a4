#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A simulated device presses a block over ROS: forces come at the device's rate, the device comes to rest, and its user
never receives more energy from the tissue than they have given."""
import math
import statistics
import struct
import sys
import time
import unittest

import genpy.dynamic
import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from simulator_watch import SimulatorWatch, wait_until
from std_msgs.msg import Float64

LIMIT_S = 60
TOP_M, RADIUS_M = 0.02, 0.008
INTENDED_M = 0.022            # height of the tip in haptics.yaml that the user intends while holding
HAND_N_PER_M = 300            # default of sim_device
HELD_M = 0.001                # least depth of the tip while held
SETTLE_S, LOOK_S = 3.0, 3.0   # of the hold, which takes 8 s
QUIET_N, QUIET_M = 0.05, 1e-4  # below the threshold of a fingertip; half of peak to peak of the middle nine tenths
RATE_HZ = (700, 1300)         # 1000 nominally, by counting: the machine may be busy
PERIOD_S = (0.0005, 0.0015)   # median
ACTIVE_J = -1e-3
BALANCE = 0.1                 # relative force: that of the grip's spring, minus its damper


def half_range(values):
    ordered = sorted(values)
    rest = len(ordered) // 20
    return 0.5 * (ordered[-1 - rest] - ordered[rest])


class HapticsTest(unittest.TestCase):
    def setUp(self):
        rospy.init_node("haptics_test")
        self.wrenches, self.heights, self.energies, self.impedances = [], [], [], []
        rospy.Subscriber("left/body/servo_cf", WrenchStamped, self.on_wrench, queue_size=1000, tcp_nodelay=True)
        rospy.Subscriber("left/measured_cp", PoseStamped, self.on_pose, queue_size=1000, tcp_nodelay=True)
        rospy.Subscriber("left/energy", Float64, lambda m: self.energies.append(m.data), queue_size=100)
        rospy.Subscriber("left/servo_ci", rospy.AnyMsg, self.on_impedance, queue_size=1000, tcp_nodelay=True)
        self.watch = SimulatorWatch()

    def on_wrench(self, message):
        self.wrenches.append((message.header.stamp.to_sec(), message.wrench.force.z, message.header.seq))

    def on_pose(self, message):
        self.heights.append((message.header.stamp.to_sec(), message.pose.position.z))

    def on_impedance(self, message):
        seconds, nanoseconds = struct.unpack_from("<II", message._buff, 4)  # the header's stamp, after its number
        self.impedances.append((seconds + 1e-9 * nanoseconds, message))

    def wait_received(self, until_s):
        """Waits for every message sent before until_s: rospy may be seconds late at this rate."""
        def received():
            return all(messages and messages[-1][0] >= until_s
                       for messages in (self.wrenches, self.heights, self.impedances))
        wait_until(received, LIMIT_S, "messages up to the end of the measurement")

    def assert_same_as_impedance(self, message, force_n, height_m):
        """crtk_msgs/CartesianImpedance, which this machine knows only from the simulator, gives the same force."""
        header = message._connection_header
        self.assertEqual(header["type"], "crtk_msgs/CartesianImpedance")
        kinds = genpy.dynamic.generate_dynamic(header["type"], header["message_definition"])
        kind = kinds[header["type"]]
        self.assertEqual(kind._md5sum, header["md5sum"])  # of the definition's text, as in rosmsg
        impedance = kind().deserialize(message._buff)
        self.assertEqual(impedance.header.frame_id, "tissue")
        turn = impedance.force_orientation
        self.assertGreater(turn.w, 0.99)  # z is the normal: upwards
        below_m = height_m - impedance.force_position.z
        self.assertLess(below_m, 0)
        given_n = impedance.position_negative.p.z * below_m
        self.assertLess(abs(given_n - force_n), BALANCE * force_n)
        self.assertLess(impedance.position_negative.d.z, 0)
        self.assertEqual(impedance.position_positive.p.z, 0)

    def test_a_device_settles_in_tissue(self):
        wait_until(lambda: self.heights and self.heights[-1][1] < TOP_M + RADIUS_M - HELD_M, LIMIT_S, "contact")
        rospy.sleep(SETTLE_S)
        begun = rospy.get_time()
        time.sleep(LOOK_S)
        ended = rospy.get_time()
        self.wait_received(ended)
        held = [wrench for wrench in self.wrenches if begun <= wrench[0] < ended]
        forces = [force for _, force, _ in held]
        heights = [z for t, z in self.heights if begun <= t < ended]
        # Counted by the sender's numbers: rospy may drop messages at this rate.
        spans = [b[0] - a[0] for a, b in zip(held, held[1:]) if b[2] == a[2] + 1]
        rate_hz = (held[-1][2] - held[0][2]) / (held[-1][0] - held[0][0])
        force_n, height_m = statistics.median(forces), statistics.median(heights)
        print("%.0f wrenches a second, %.0f of them received, median period %.2f ms, %.3f N +- %.4f, %.2f mm +- %.4f" % (
            rate_hz, len(held) / (ended - begun), 1e3 * statistics.median(spans), force_n, half_range(forces), 1e3 * height_m,
            1e3 * half_range(heights)), flush=True)
        self.assertTrue(RATE_HZ[0] < rate_hz < RATE_HZ[1], rate_hz)
        self.assertTrue(PERIOD_S[0] < statistics.median(spans) < PERIOD_S[1], statistics.median(spans))
        self.assertLess(half_range(forces), QUIET_N)
        self.assertLess(half_range(heights), QUIET_M)
        # the tissue's force balances the grip's spring
        hand_n = HAND_N_PER_M * (height_m - INTENDED_M)
        self.assertGreater(force_n, 0.2)
        self.assertLess(abs(force_n - hand_n), BALANCE * hand_n)

        impedance = [message for t, message in self.impedances if begun <= t < ended][-1]
        self.assert_same_as_impedance(impedance, force_n, height_m)
        wait_until(lambda: self.heights[-1][1] > TOP_M + 2 * RADIUS_M, LIMIT_S, "a stylus that goes away")
        self.watch.wait_news()
        self.assertEqual(self.wrenches[-1][1], 0)
        print("energy %.3f mJ, least %.3f mJ, p99 of pose to force %s ms, %s" % (
            1e3 * self.watch.value("left", "energy_j"), 1e3 * self.watch.value("left", "least_energy_j"),
            self.watch.value("latency", "pose_to_force_left_p99_ms"), self.watch.value("pace", "haptic_scheduling")),
            flush=True)
        self.assertGreaterEqual(self.watch.value("left", "least_energy_j"), ACTIVE_J)
        self.assertGreaterEqual(min(self.energies), ACTIVE_J)
        self.assertFalse(math.isnan(self.energies[-1]))


if __name__ == "__main__":
    rostest.rosrun("viscera", "haptics", HapticsTest, sys.argv)
