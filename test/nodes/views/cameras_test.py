#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A stereo camera on a tf frame, and one in an endoscope. There are no images while the frame is unknown; later, depths, labels and stereo pairs
agree with tf and camera_info, also while paused. Each is made only for subscribers."""
import array
import math
import sys
import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, TransformStamped
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import CameraInfo, Image
from simulator_watch import Latest, SimulatorWatch, wait_until
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from viscera.msg import Tick
from viscera.srv import Step

FACE_Y_M, HALF_M, BASELINE_M, AWAY_M = -0.02, 0.02, 0.01, 0.2
DEPTH_M = 1e-5  # float32, and a transform in doubles
BODY, BALL = 1, 221


class Carrier:
    """Sends the frame's pose at 50 Hz, as an endoscope's driver does."""

    def __init__(self):
        self.y_m = None
        self.frames = rospy.Publisher("/tf", TFMessage, queue_size=10)
        threading.Thread(target=self.run, daemon=True).start()

    def run(self):
        while not rospy.is_shutdown():
            if self.y_m is not None:
                transform = TransformStamped()
                transform.header.stamp = rospy.Time.now()
                transform.header.frame_id, transform.child_frame_id = "tissue", "scope_link"
                transform.transform.translation.y = self.y_m
                transform.transform.rotation.w = 1
                self.frames.publish([transform])
            time.sleep(0.02)


def pixels(message):
    """Returns all pixels, row by row; of a colour the sum of its three components."""
    values = array.array("f" if message.encoding == "32FC1" else "B", message.data)
    if message.encoding == "rgb8":
        return [sum(values[i:i + 3]) for i in range(0, len(values), 3)]
    return values


def middle(message):
    return pixels(message)[message.height // 2 * message.width + message.width // 2]


def rotated(q, v):
    """Returns a vector rotated by a quaternion."""
    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    u = [q.x, q.y, q.z]
    once = cross(u, v)
    twice = cross(u, once)
    return [v[i] + 2 * q.w * once[i] + 2 * twice[i] for i in range(3)]


class CamerasTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("cameras_test")
        cls.carrier = Carrier()
        cls.optical = {}  # stamp -> transform
        cls.of_scope = {}  # the same of the laparoscope
        cls.frames = Latest("/tf", TFMessage, cls.note_frames, queue_size=100)
        cls.watch = SimulatorWatch()
        cls.watch.wait_ready()

    @classmethod
    def note_frames(cls, message):
        for transform in message.transforms:
            if transform.child_frame_id == "scope_optical_frame":
                cls.optical[transform.header.stamp] = transform
            if transform.child_frame_id == "laparoscope_optical_frame":
                cls.of_scope[transform.header.stamp] = transform

    def pair(self, first, second, types=(Image, Image)):
        """Returns two messages with the same stamp."""
        found = ({}, {})
        topics = [Latest(name, kind, lambda message, to=to: to.setdefault(message.header.stamp, message), queue_size=10)
                  for name, kind, to in zip((first, second), types, found)]
        common = wait_until(lambda: set(found[0]) & set(found[1]), 30, "%s with %s" % (first, second))
        for topic in topics:
            topic.stop()
        return [messages[max(common)] for messages in found]

    def face_y(self, depth, info, frames=None):
        """Returns the height of the face along y, tissue frame, from the centre pixel of the depths, tf and
        camera_info."""
        frames = self.optical if frames is None else frames
        row, column = depth.height // 2, depth.width // 2
        z = middle(depth)
        x, y = (column - info.K[2]) / info.K[0] * z, (row - info.K[5]) / info.K[4] * z
        at = wait_until(lambda: frames.get(depth.header.stamp), 5, "transform at the stamp of a picture")
        self.assertEqual(at.header.frame_id, "tissue")
        at = at.transform
        return rotated(at.rotation, [x, y, z])[1] + at.translation.y

    def test_0_no_picture_before_the_frame_is_known(self):
        image = Latest("scope/image_raw", Image)
        wait_until(lambda: (self.watch.value("cameras", "frames_missed") or 0) > 0, 10, "missed frame")
        wait_until(lambda: "is unknown" in self.watch.status("cameras").message, 10, "warning")
        self.assertEqual(image.count, 0)
        self.carrier.y_m = 0.0
        wait_until(lambda: image.count, 20, "picture")
        self.assertEqual(image.message.header.frame_id, "scope_optical_frame")
        image.stop()

    def test_1_depths_lie_on_the_face_wherever_the_camera_goes(self):
        for away_m in (0.0, -0.1, 0.05):
            self.carrier.y_m = away_m
            expected = AWAY_M - away_m + FACE_Y_M
            depth = Latest("scope/depth/image_raw", Image)
            wait_until(lambda: depth.message and abs(middle(depth.message) - expected) < DEPTH_M, 20,
                       "depth of %g m" % expected)
            depth.stop()
            both = self.pair("scope/depth/image_raw", "scope/depth/camera_info", (Image, CameraInfo))
            self.assertEqual(pixels(both[0])[0], math.inf)
            canonical = self.pair("scope/depth/image", "scope/depth/camera_info", (Image, CameraInfo))[0]
            self.assertEqual((canonical.encoding, canonical.step), (both[0].encoding, both[0].step))
            self.assertAlmostEqual(self.face_y(*both), FACE_Y_M, delta=DEPTH_M)
        self.carrier.y_m = 0.0

    def test_2_labels_tell_the_body_from_the_ball(self):
        labels, depth = self.pair("scope/label/image_raw", "scope/depth/image_raw")
        seen = pixels(labels)
        self.assertEqual(set(seen), {0, BODY, BALL})
        self.assertEqual([math.isinf(z) for z in pixels(depth)], [label == 0 for label in seen])

    def test_3_a_stereo_pair_has_the_disparity_of_its_camera_info(self):
        left, right = self.pair("scope/left/image_raw", "scope/right/image_raw")
        _, info = self.pair("scope/left/camera_info", "scope/right/camera_info", (CameraInfo, CameraInfo))
        self.assertEqual(left.header.frame_id, right.header.frame_id)
        self.assertAlmostEqual(info.P[3], -info.P[0] * BASELINE_M, places=9)

        def column(image):
            """Returns the column of the block's left edge in the middle row."""
            row = pixels(image)[60 * image.width:61 * image.width]
            return next(i for i, value in enumerate(row) if value > row[0] + 20)

        z_m = AWAY_M - HALF_M
        self.assertAlmostEqual(column(left) - column(right), -info.P[3] / z_m, delta=1)

    def test_4_a_camera_goes_on_in_a_pause_and_rests_without_viewers(self):
        pause, resume = rospy.ServiceProxy("pause", Trigger), rospy.ServiceProxy("resume", Trigger)
        self.assertTrue(pause().success)
        depth = Latest("scope/depth/image_raw", Image)
        for away_m in (-0.05, 0.0):
            self.carrier.y_m = away_m
            expected = AWAY_M - away_m + FACE_Y_M
            wait_until(lambda: depth.message and abs(middle(depth.message) - expected) < DEPTH_M, 20, "depth")
        self.assertTrue(resume().success)
        depth.stop()

        def rests():
            before = self.watch.value("simulation", "renders")
            self.watch.wait_news()
            return self.watch.value("simulation", "renders") == before

        wait_until(rests, 20, "end of the drawing")

    def test_5_a_topic_beside_tells_the_tick_of_pictures(self):
        image, tick = self.pair("scope/image_raw", "scope/tick", (Image, Tick))
        self.assertEqual((tick.header.frame_id, tick.time_s), (image.header.frame_id, tick.tick * tick.tick_s))
        self.assertTrue(rospy.ServiceProxy("pause", Trigger)().success)
        images, ticks = {}, {}
        topics = [Latest("scope/depth/image_raw", Image, lambda m: images.setdefault(m.header.stamp, m), queue_size=10),
                  Latest("scope/tick", Tick, lambda m: ticks.setdefault(m.tick, m), queue_size=10)]
        for topic in topics:
            topic.connect()
        for _ in range(3):
            done = rospy.ServiceProxy("step", Step)(ticks=4)
            told = wait_until(lambda: ticks.get(done.tick), 20, "picture of tick %d" % done.tick)
            wait_until(lambda: told.header.stamp in images, 20, "picture of its stamp")
        for topic in topics:
            topic.stop()
        self.assertTrue(rospy.ServiceProxy("resume", Trigger)().success)

    def test_6_an_endoscope_sees_from_the_tip_of_its_stylus(self):
        """Its lens looks down by 30 degrees from a shaft along y, at the front face of the block."""
        poses = rospy.Publisher("endoscope/measured_cp", PoseStamped, queue_size=1, tcp_nodelay=True)
        pose = PoseStamped()
        pose.pose.position.y, pose.pose.position.z = -0.06, 0.02
        pose.pose.orientation.x = pose.pose.orientation.w = math.sqrt(0.5)
        sending = rospy.Timer(rospy.Duration(0.02), lambda _: (
            setattr(pose.header, "stamp", rospy.Time.now()), poses.publish(pose)))

        def there():
            newest = self.of_scope[max(self.of_scope)].transform.translation if self.of_scope else None
            return newest and abs(newest.y + 0.06) < 1e-9 and abs(newest.z - 0.02) < 1e-9

        wait_until(there, 20, "frame of the laparoscope at the tip")
        both = self.pair("laparoscope/depth/image_raw", "laparoscope/depth/camera_info", (Image, CameraInfo))
        sending.shutdown()
        self.assertEqual([message.header.frame_id for message in both], 2 * ["laparoscope_optical_frame"])
        self.assertAlmostEqual(self.face_y(*both, self.of_scope), FACE_Y_M, delta=DEPTH_M)

    def test_7_pictures_that_come_far_too_seldom_are_told_with_ways_out(self):
        told = []
        log = Latest("/rosout", Log, lambda m: told.append(m.msg) if m.level == Log.WARN and "huge" in m.msg else None, 100)
        huge = Latest("huge/image_raw", Image)

        def moves():  # an unchanged image is not drawn again
            self.carrier.y_m += 1e-5
            return told

        wait_until(moves, 30, "warning")
        self.assertIn("width_px", told[0])

        def pace_tells():  # on a busy machine it first reports that everything is slow
            self.carrier.y_m += 1e-5
            return "pictures" in self.watch.status("pace").message

        wait_until(pace_tells, 60, "pace that tells of pictures")
        huge.stop()
        log.stop()


if __name__ == "__main__":
    rostest.rosrun("viscera", "cameras_test", CamerasTest, sys.argv)
