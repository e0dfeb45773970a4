#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A simulation that is slower than real time reports it once. Strokes wait for a viewer, follow simulated time, and
reset between rounds."""
import os
import sys
import time
import unittest

import roslib.packages
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from program import Program
from simulator_watch import Latest, SimulatorWatch, wait_until
from visualization_msgs.msg import Marker

from viscera.msg import Tick

FOLDER = os.path.join(roslib.packages.get_pkg_dir("viscera"), "test/nodes")
TOO_MUCH = "solver.tick_hz=500;solver.substeps=2000"  # a million substeps per second are more than any machine can run
LIMIT_S = 20
ROUND_LIMIT_S = 90
STROKE_S = 0.3      # of short_stroke.yaml
SHARE = 0.8         # of the stroke that must pass in simulated time between first and last pose: ticks come after poses
UNWATCHED_S = 0.5     # without a viewer


class SlowReplayTest(unittest.TestCase):
    def test_all(self):
        rospy.init_node("slow_replay_test")
        launched = Program(["roslaunch", "viscera", "training.launch", "scene:=" + FOLDER + "/views/scene_view.yaml",
                            "overrides:=" + TOO_MUCH, "strokes:=" + FOLDER + "/input/short_stroke.yaml",
                            "strokes_delay_s:=0", "loop:=true", "wait_for_viewer:=true"])
        self.addCleanup(launched.end)
        watch = SimulatorWatch()
        tick = Latest("tick", Tick)
        poses = []
        device = Latest("left/measured_cp", PoseStamped,
                      lambda m: poses.append((m.pose.position.z, tick.message.time_s, time.monotonic())))
        watch.wait_ready()

        wait_until(lambda: tick.count, LIMIT_S, "tick")
        self.assertFalse(tick.message.viewed)
        time.sleep(UNWATCHED_S)
        self.assertEqual(device.count, 0)

        marker = Latest("surface_marker", Marker)
        wait_until(lambda: device.count, LIMIT_S, "pose once someone looks")
        wait_until(lambda: tick.message.viewed, LIMIT_S, "tick that says so")  # the pose may overtake it

        # The stylus moves down once, the simulation is reset, and the stylus moves down again.
        wait_until(lambda: any(a[0] < b[0] - 0.05 for a, b in zip(poses, poses[1:])), ROUND_LIMIT_S, "second round")
        second = next(i + 1 for i, (a, b) in enumerate(zip(poses, poses[1:])) if a[0] < b[0] - 0.05)
        first_round, last = poses[:second], poses[second - 1]
        simulated_s = last[1] - first_round[0][1]
        self.assertGreater(simulated_s, SHARE * STROKE_S)
        self.assertGreater(last[2] - first_round[0][2], 2 * STROKE_S)  # the machine is slower than real time
        wait_until(lambda: tick.message.time_s < simulated_s / 2, LIMIT_S, "reset between two rounds")

        slow = [line for line in launched.output.splitlines() if "slower than real time" in line]
        self.assertEqual(len(slow), 1, launched.output)
        for word in ("spacing_m", "dt_fraction", "integrator", "rate_hz"):
            self.assertIn(word, slow[0])
        marker.stop()


if __name__ == "__main__":
    rostest.rosrun("viscera", "slow_replay_test", SlowReplayTest, sys.argv)
