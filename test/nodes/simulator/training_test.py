#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A whole session from outside: replayed strokes dent, pull and cut the heart phantom."""
import math
import subprocess
import sys
import time
import unittest

import roslib.packages
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import CameraInfo, Image
from simulator_watch import Latest, SimulatorWatch, wait_until
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker

PROBED = (0, -0.046, -0.02)  # [m] where probe_pull_cut.yaml touches the phantom
NEAR_M = 0.015               # around that point the surface must follow the tool
FIXED_Z_M = 0.045            # above this height all nodes are fixed
DENT_M = 0.003               # least motion of a dent or a pull; the tool moves 8 mm or more into or out of the surface
STILL_M = 0.001              # largest motion of fixed tissue
FORCE_N = 0.005              # least force that counts as contact; without contact it is exactly zero
MAX_FORCE_N = 5.001          # StylusConfig.max_force_n and rounding
PIXEL_STEP = 24              # of 255: a larger change of a pixel is not noise
LATENCY_MS = 1000            # limit of latencies, for any slow and busy machine
SESSION_LIMIT_S = 60


def points_of(marker):
    return [(p.x, p.y, p.z) for p in marker.points]


class Recorder:
    """Records everything that the simulator sends during the strokes."""

    def __init__(self):
        self.rest = None              # corners of the surface when the strokes begin
        self.inward_m = self.outward_m = self.held_m = 0
        self.force_in_dent = None     # (x, y, z) while the probe holds its dent
        self.peak_force_n = 0
        self.faults = []
        self.frames = set()
        self.latency_ms = {}          # largest of each value
        self.image_stamps, self.info_stamps = set(), set()
        self.first_image = None
        self.changed_px = 0           # largest difference of an image from the first one
        self.skin_points = self.wall_points = 0  # of the newest markers of the surface and of its cut walls
        self.pose = {"left": Latest("left/measured_cp", PoseStamped),
                     "right": Latest("right/measured_cp", PoseStamped)}
        self.marker = Latest("surface_marker", Marker, self.on_marker, queue_size=4)  # surface and cut walls
        self.force = Latest("left/body/servo_cf", WrenchStamped, self.on_force)
        self.image = Latest("camera/image_raw", Image, self.on_image)
        self.info = Latest("camera/camera_info", CameraInfo, lambda m: self.info_stamps.add(m.header.stamp))
        self.diagnostics = Latest("/diagnostics", DiagnosticArray, self.on_diagnostics)
        self.tf = [Latest(topic, TFMessage, self.on_tf) for topic in ("/tf", "/tf_static")]

    def begun(self):
        return self.pose["left"].count > 0

    def on_marker(self, marker):
        points = points_of(marker)
        if marker.action == Marker.DELETE and marker.ns.endswith(" wounds"):
            self.wall_points = 0
            return
        if len(points) % 3 or not points or marker.colors or not all(math.isfinite(x) for p in points for x in p):
            self.faults.append("marker with %d points" % len(points))
        if marker.ns.endswith(" wounds"):
            self.wall_points = len(points)
            return
        self.skin_points = len(points)
        if not self.begun():
            self.rest = points
        elif len(points) == len(self.rest) and not self.pose["right"].count:
            self.compare(points)

    def compare(self, points):
        for before, now in zip(self.rest, points):
            if math.dist(before, PROBED) < NEAR_M:
                self.inward_m = max(self.inward_m, now[1] - before[1])
                self.outward_m = max(self.outward_m, before[1] - now[1])
            if before[2] > FIXED_Z_M:
                self.held_m = max(self.held_m, math.dist(before, now))

    def on_force(self, wrench):
        force = (wrench.wrench.force.x, wrench.wrench.force.y, wrench.wrench.force.z)
        if not all(map(math.isfinite, force)):
            self.faults.append("force %s" % (force,))
        self.peak_force_n = max(self.peak_force_n, math.hypot(*force))
        pose = self.pose["left"].message
        if pose and pose.pose.position.y == -0.05:
            self.force_in_dent = force

    def on_image(self, image):
        self.image_stamps.add(image.header.stamp)
        if not self.begun():
            self.first_image = image
        elif self.first_image:
            self.changed_px = max(self.changed_px, changed_pixels(self.first_image, image))

    def on_diagnostics(self, array):
        for status in array.status:
            if status.name == "simulator: latency":
                for item in status.values:
                    self.latency_ms[item.key] = max(self.latency_ms.get(item.key, 0), float(item.value))

    def on_tf(self, message):
        for transform in message.transforms:
            self.frames.add((transform.header.frame_id, transform.child_frame_id))


def changed_pixels(a, b):
    return sum(abs(x - y) > PIXEL_STEP for x, y in zip(a.data[::3], b.data[::3]))


class TrainingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("training_test")
        cls.watch = SimulatorWatch()
        cls.seen = Recorder()
        cls.watch.wait_ready()
        wait_until(lambda: cls.seen.rest and cls.seen.first_image, SESSION_LIMIT_S, "marker and image at rest")
        replay = roslib.packages.find_node("viscera", "stylus_replay")[0]
        cls.replay_status = subprocess.call([replay, "_strokes:=" + rospy.get_param("~strokes")],
                                            timeout=SESSION_LIMIT_S)
        wait_until(lambda: cls.watch.status("right").message == "the last pose is stale", 10, "end of the tracking")
        time.sleep(2)  # the tissue comes to rest
        cls.watch.wait_news()

    def test_replay_ended_well(self):
        self.assertEqual(self.replay_status, 0)

    def test_skin_moves_where_it_was_probed_and_pulled(self):
        self.assertGreater(self.seen.inward_m, DENT_M)
        self.assertGreater(self.seen.outward_m, DENT_M)

    def test_held_tissue_stays(self):
        self.assertLess(self.seen.held_m, STILL_M)

    def test_hand_feels_the_tissue_push_back(self):
        self.assertIsNotNone(self.seen.force_in_dent)
        self.assertLess(self.seen.force_in_dent[1], -FORCE_N)
        self.assertLess(self.seen.peak_force_n, MAX_FORCE_N)
        self.assertEqual(self.seen.force.message.header.frame_id, "tissue")

    def test_force_ends_with_the_poses(self):
        force = self.seen.force.message.wrench.force
        self.assertEqual((force.x, force.y, force.z), (0, 0, 0))

    def test_cut_severs_springs_splits_the_skin_and_lays_walls_open(self):
        self.assertGreater(self.watch.value("simulation", "springs_cut"), 0)
        self.assertGreater(self.seen.skin_points, len(self.seen.rest))
        self.assertGreater(self.seen.wall_points, 0)

    def test_image_shows_what_was_done(self):
        after = self.seen.image.message
        self.assertEqual(len(after.data), after.step * after.height)
        self.assertGreater(len(set(after.data)), 8)  # several colours
        self.assertGreater(self.seen.changed_px, 0.002 * len(after.data) / 3)
        self.assertEqual(after.header.frame_id, "camera_optical_frame")

    def test_every_image_has_its_camera_info(self):
        common = self.seen.image_stamps & self.seen.info_stamps
        self.assertGreaterEqual(len(common), min(len(self.seen.image_stamps), len(self.seen.info_stamps)) - 2)
        self.assertGreater(self.seen.info.message.K[0], 0)

    def test_frames_join_world_tissue_tools_and_camera(self):
        expected = {("world", "tissue"), ("tissue", "left_tool"), ("tissue", "right_tool"),
                    ("tissue", "camera_optical_frame")}
        self.assertEqual(expected - self.seen.frames, set())

    def test_nothing_sent_was_malformed(self):
        self.assertEqual(self.seen.faults, [])

    def test_diagnostics_find_the_simulation_healthy(self):
        status = self.watch.status("simulation")
        self.assertEqual(status.level, DiagnosticStatus.OK, status.message)
        self.assertEqual(self.watch.value("simulation", "nonfinite_nodes"), 0)
        self.assertLess(self.watch.value("simulation", "dt_s"), self.watch.value("simulation", "dt_limit_s"))
        self.assertGreater(self.watch.value("left", "poses_accepted"), 100)

    def test_delays_from_pose_to_force_surface_and_image_are_told(self):
        for answer in ("force_left", "force_right", "surface", "image_camera"):
            mean_ms, max_ms = (self.seen.latency_ms["pose_to_%s_%s_ms" % (answer, kind)] for kind in ("mean", "max"))
            self.assertGreater(mean_ms, 0, answer)
            self.assertLessEqual(mean_ms, max_ms, answer)
            self.assertLess(max_ms, LATENCY_MS, answer)
        self.watch.wait_news()  # no further poses come
        self.assertEqual(self.watch.value("latency", "pose_to_force_left_max_ms"), 0)

    def test_z_reset_makes_the_skin_whole_again(self):
        self.assertTrue(rospy.ServiceProxy("reset", Trigger)().success)
        wait_until(lambda: self.seen.skin_points == len(self.seen.rest), 20, "whole skin")
        wait_until(lambda: self.seen.wall_points == 0, 20, "no walls")
        self.watch.wait_news()
        self.assertEqual(self.watch.value("simulation", "springs_cut"), 0)


if __name__ == "__main__":
    rostest.rosrun("viscera", "training_test", TrainingTest, sys.argv)
