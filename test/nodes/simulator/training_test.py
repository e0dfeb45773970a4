#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A whole session from outside: replayed strokes dent, pull and cut the heart phantom."""
import math
import struct
import subprocess
import sys
import unittest

import numpy
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
LATENCY_MS = 1000            # limit of latencies in the best second, for any slow and busy machine
SESSION_LIMIT_S = 60
DENT_Y_M = -0.05             # where probe_pull_cut.yaml holds the probe in its dent
# Bytes of a serialised marker before its frame and namespace, and between these and its points.
MARKER_BEGIN, MARKER_NUMBERS = struct.calcsize("<3I"), struct.calcsize("<3i10d4f2iB")


class QuickMarker(Marker):
    """A marker whose points are an array [n, 3]: genpy takes a tenth of a second for those of the heart."""

    def deserialize(self, buff):
        begin = MARKER_BEGIN
        for _ in ("frame_id", "ns"):
            begin += 4 + struct.unpack_from("<I", buff, begin)[0]
        begin += MARKER_NUMBERS
        count = struct.unpack_from("<I", buff, begin)[0]
        end = begin + 4 + 24 * count
        super().deserialize(buff[:begin] + bytes(4) + buff[end:])
        self.points = numpy.frombuffer(buff, "<f8", 3 * count, begin + 4).reshape(-1, 3)
        return self


class Recorder:
    """Records everything that the simulator sends during the strokes. What happened when is judged by stamps, since
    messages may arrive seconds late."""

    def __init__(self):
        self.rest = None              # corners of the surface when the strokes begin
        self.strokes_began = False
        self.moved = []               # (stamp, inward, outward and held motion [m]) of every uncut surface
        self.forces = []              # (stamp, (x, y, z))
        self.poses = []               # (stamp, y) of the left stylus
        self.faults = []
        self.frames = set()
        self.latency_ms = {}          # {name: {diagnostics' stamp: value}}
        self.image_stamps, self.info_stamps = set(), set()
        self.first_image = None
        self.changed_px = 0           # largest difference of an image from the first one
        self.skin_points = self.wall_points = 0  # of the newest markers of the surface and of its cut walls
        self.skin_stamp_s = 0
        self.pose = {"left": Latest("left/measured_cp", PoseStamped, self.on_pose, queue_size=10000),
                     "right": Latest("right/measured_cp", PoseStamped)}
        self.marker = Latest("surface_marker", QuickMarker, self.on_marker, queue_size=100)  # surface and cut walls
        self.force = Latest("left/body/servo_cf", WrenchStamped, self.on_force, queue_size=10000)
        self.image = Latest("camera/image_raw", Image, self.on_image)
        self.info = Latest("camera/camera_info", CameraInfo, lambda m: self.info_stamps.add(m.header.stamp))
        self.diagnostics = Latest("/diagnostics", DiagnosticArray, self.on_diagnostics, queue_size=100)
        self.tf = [Latest(topic, TFMessage, self.on_tf) for topic in ("/tf", "/tf_static")]

    def on_marker(self, marker):
        points = marker.points
        if marker.action == Marker.DELETE and marker.ns.endswith(" wounds"):
            self.wall_points = 0
            return
        if len(points) % 3 or not len(points) or marker.colors or not numpy.isfinite(points).all():
            self.faults.append("marker with %d points" % len(points))
        if marker.ns.endswith(" wounds"):
            self.wall_points = len(points)
            return
        self.skin_points = len(points)
        self.skin_stamp_s = marker.header.stamp.to_sec()
        if not self.strokes_began:
            self.rest = points
        elif len(points) == len(self.rest):
            inward = (points - self.rest)[numpy.linalg.norm(self.rest - PROBED, axis=1) < NEAR_M, 1]
            held = numpy.linalg.norm(points - self.rest, axis=1)[self.rest[:, 2] > FIXED_Z_M]
            self.moved.append((self.skin_stamp_s, inward.max(), -inward.min(), held.max()))

    def farthest_m(self):
        """Returns the largest inward, outward and held motion before the right stylus cuts."""
        return numpy.max([motion for stamp_s, *motion in self.moved if stamp_s < self.poses[-1][0]], axis=0)

    def force_in_dent(self):
        """Returns the last force (x, y, z) while the probe holds its dent."""
        dent = [stamp_s for stamp_s, y in self.poses if y == DENT_Y_M]
        return [force for stamp_s, force in self.forces if dent[0] < stamp_s < dent[-1]][-1]

    def on_pose(self, pose):
        self.poses.append((pose.header.stamp.to_sec(), pose.pose.position.y))

    def on_force(self, wrench):
        force = (wrench.wrench.force.x, wrench.wrench.force.y, wrench.wrench.force.z)
        if not all(map(math.isfinite, force)):
            self.faults.append("force %s" % (force,))
        self.forces.append((wrench.header.stamp.to_sec(), force))

    def on_image(self, image):
        self.image_stamps.add(image.header.stamp)
        if not self.strokes_began:
            self.first_image = image
        else:
            self.changed_px = max(self.changed_px, changed_pixels(self.first_image, image))

    def on_diagnostics(self, array):
        for status in array.status:
            if status.name == "simulator: latency":
                for item in status.values:
                    self.latency_ms.setdefault(item.key, {})[array.header.stamp] = float(item.value)

    def on_tf(self, message):
        for transform in message.transforms:
            self.frames.add((transform.header.frame_id, transform.child_frame_id))

    def has_all_until(self, time_s):
        """Returns whether the surface, an image and a force of a moment after time_s have arrived."""
        return (self.skin_stamp_s > time_s and self.image.message.header.stamp.to_sec() > time_s
                and self.forces and self.forces[-1][0] > time_s)


def changed_pixels(a, b):
    return sum(abs(x - y) > PIXEL_STEP for x, y in zip(a.data[::3], b.data[::3]))


class TrainingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("training_test")
        cls.watch = SimulatorWatch()
        cls.seen = Recorder()
        cls.watch.wait_ready()
        wait_until(lambda: cls.seen.rest is not None and cls.seen.first_image, SESSION_LIMIT_S,
                   "marker and image at rest")
        cls.seen.strokes_began = True
        replay = roslib.packages.find_node("viscera", "stylus_replay")[0]
        cls.replay_status = subprocess.call([replay, "_strokes:=" + rospy.get_param("~strokes")],
                                            timeout=SESSION_LIMIT_S)
        wait_until(lambda: cls.watch.status("right").message == "the last pose is stale", 10, "end of the tracking")
        ended_s = rospy.get_time()
        wait_until(lambda: cls.seen.has_all_until(ended_s), SESSION_LIMIT_S, "surface, image and force after the strokes")
        cls.watch.wait_news()

    def test_replay_ended_well(self):
        self.assertEqual(self.replay_status, 0)

    def test_skin_moves_where_it_was_probed_and_pulled(self):
        inward_m, outward_m, _ = self.seen.farthest_m()
        self.assertGreater(inward_m, DENT_M)
        self.assertGreater(outward_m, DENT_M)

    def test_held_tissue_stays(self):
        self.assertLess(self.seen.farthest_m()[2], STILL_M)

    def test_stylus_receives_the_force_of_the_tissue(self):
        self.assertLess(self.seen.force_in_dent()[1], -FORCE_N)
        self.assertLess(max(math.hypot(*force) for _, force in self.seen.forces), MAX_FORCE_N)
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
            means, maxima = (self.seen.latency_ms["pose_to_%s_%s_ms" % (answer, kind)] for kind in ("mean", "max"))
            answered = [stamp for stamp in means if means[stamp] > 0]
            self.assertTrue(all(means[stamp] <= maxima[stamp] for stamp in answered), answer)
            # In the best second: other programs delay an image by more.
            self.assertLess(min(maxima[stamp] for stamp in answered), LATENCY_MS, answer)
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
