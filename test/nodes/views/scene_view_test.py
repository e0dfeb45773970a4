#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The topics for viewers: a camera_info that is accurate to a fraction of a pixel, topologies, and markers of
everything except tissue."""
import math
import struct
import sys
import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import CameraInfo, Image, PointCloud2, PointField
from simulator_watch import Latest, SimulatorWatch, wait_until
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from viscera.msg import SurfaceTopology, SurfaceTopologyChange, SurfaceVertices, Sutures
from viscera.srv import SetOverlays, SetToolMode

LIMIT_S = 20
TILE_M = (0.08, 0, 0.05)  # of scene_view.yaml: a square of 4 cm that faces the camera, rotated, brighter than the background
TILE_PX = 900             # pixels of it
PIXEL_LIMIT = 0.1         # [px] for its centre: oblique borders cross pixels anywhere; half a pixel is the error to detect
ABOVE_M = -0.05    # over the cloth, out of its reach
CLOTH_M = -0.1
BLUE = (77, 107, 184)  # lower end of the scale, without strain (shaders/surface/strain_scale.glsl)
CLOUD_S = 0.15     # mean of three periods or more: 0.2 each, less a stamp that is up to 0.15 late
AGAIN_S = 5        # between two equal whole topologies
GRAB_M = 0.02      # more than the reach of a tool that grabs, and the motion between two messages


class StylusDevice:
    """Sends poses at 50 Hz until it gets another one, or is stopped."""

    def __init__(self, stylus):
        self.publisher = rospy.Publisher(stylus + "/measured_cp", PoseStamped, queue_size=1)
        self.position = None
        thread = threading.Thread(target=self.main, daemon=True)
        thread.start()

    def main(self):
        while not rospy.is_shutdown():
            if self.position:
                message = PoseStamped()
                message.header.stamp = rospy.Time.now()
                message.header.frame_id = "tissue"
                message.pose.position.x, message.pose.position.y, message.pose.position.z = self.position
                message.pose.orientation.w = 1
                self.publisher.publish(message)
            time.sleep(0.02)

    def move(self, start, end, seconds):
        begun = time.monotonic()
        while time.monotonic() < begun + seconds:
            s = (time.monotonic() - begun) / seconds
            self.position = tuple(a + s * (b - a) for a, b in zip(start, end))
            time.sleep(0.01)
        self.position = end


def isBlue(color):
    """Returns whether an RGBA8 colour is BLUE, to the rounding of its channels."""
    return all(abs((color >> 8 * i & 255) - channel) <= 1 for i, channel in enumerate(BLUE))


def light(value):
    """Returns the linear value of a byte of an sRGB image."""
    return ((value / 255 + 0.055) / 1.055) ** 2.4


def rotated(q, v):
    """Returns v rotated by the quaternion q."""
    u = (q.x, q.y, q.z)

    def cross(a, b):
        return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

    t = tuple(2 * c for c in cross(u, v))
    return tuple(a + q.w * b + c for a, b, c in zip(v, t, cross(u, t)))


class SceneViewTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("scene_view_test")
        cls.watch = SimulatorWatch()
        cls.left, cls.right = StylusDevice("left"), StylusDevice("right")
        cls.frames = {}
        cls.static = Latest("/tf_static", TFMessage, cls.on_tf)
        cls.moving = Latest("/tf", TFMessage, cls.on_tf)
        cls.watch.wait_ready()

    @classmethod
    def on_tf(cls, message):
        for transform in message.transforms:
            cls.frames[transform.child_frame_id] = transform.transform

    def projected(self, info):
        """Returns the centre of the tile from the messages alone, with the centre of the first pixel at (0, 0)."""
        camera = wait_until(lambda: self.frames.get(info.header.frame_id), LIMIT_S, "camera in /tf_static")
        away = tuple(p - getattr(camera.translation, axis) for p, axis in zip(TILE_M, "xyz"))
        back = type(camera.rotation)(-camera.rotation.x, -camera.rotation.y, -camera.rotation.z, camera.rotation.w)
        x, y, z = rotated(back, away)
        return (info.P[0] * x / z + info.P[2], info.P[5] * y / z + info.P[6])

    def test_a_point_projected_through_camera_info_is_found_in_the_image(self):
        image, info = Latest("camera/image_raw", Image), Latest("camera/camera_info", CameraInfo)
        wait_until(lambda: image.count and info.count, LIMIT_S, "image")
        u, v = self.projected(info.message)
        pixels, step = image.message.data, image.message.step
        share = column_sum = row_sum = 0  # covered share of each pixel
        dark = light(pixels[0])
        full = 0.9 * (light(pixels[int(v) * step + 3 * int(u)]) - dark)  # its lower end is slightly darker
        for row in range(int(v) - 30, int(v) + 31):
            for column in range(int(u) - 30, int(u) + 31):
                at = row * step + 3 * column
                part = min(1, (light(pixels[at]) - dark) / full)
                share, column_sum, row_sum = share + part, column_sum + part * column, row_sum + part * row
        image.stop()
        info.stop()
        self.assertAlmostEqual(share, TILE_PX, delta=0.1 * TILE_PX)
        self.assertAlmostEqual(column_sum / share, u, delta=PIXEL_LIMIT)
        self.assertAlmostEqual(row_sum / share, v, delta=PIXEL_LIMIT)

    def test_overlays_are_drawn_when_a_service_asks_and_go_again(self):
        set_overlays = rospy.ServiceProxy("set_overlays", SetOverlays)
        image = Latest("camera/image_raw", Image)
        wait_until(lambda: image.message and not self.legend(image.message), LIMIT_S, "image without a legend")
        answer = set_overlays("camera", ["strain", "lattice"])
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: self.legend(image.message), LIMIT_S, "legend")
        self.assertTrue(set_overlays("", []).success)
        wait_until(lambda: not self.legend(image.message), LIMIT_S, "image without a legend again")
        answer = set_overlays("camera", ["latice"])
        self.assertFalse(answer.success)
        self.assertEqual(answer.message, "overlays: unknown overlay 'latice'; accepted: lattice, forces, wind, "
                                         "springs, normals, strain")
        answer = set_overlays("unknown", [])
        self.assertFalse(answer.success)
        self.assertEqual(answer.message, "camera: the scene has no camera 'unknown'")
        image.stop()

    @staticmethod
    def legend(message):
        """Returns whether the image has the bright yellow at the end of a scale."""
        pixels = message.data
        return any(pixels[i] > 230 and 200 < pixels[i + 1] < 245 and pixels[i + 2] < 80 for i in range(0, len(pixels), 3))

    def test_cloth_is_sent_with_shared_vertices_alone(self):
        topology, surface = Latest("surface_topology", SurfaceTopology), Latest("surface", SurfaceVertices)
        wait_until(lambda: topology.count and surface.count, LIMIT_S, "surface")
        used = set(topology.message.triangles)
        self.assertEqual(used, set(range(topology.message.vertices)))
        self.assertLess(topology.message.vertices, 0.6 * len(topology.message.triangles) / 3)
        self.assertEqual(len(surface.message.positions_m), 3 * topology.message.vertices)
        self.assertEqual(len(surface.message.normals), topology.message.vertices)
        topology.stop()
        surface.stop()

    def test_strain_is_sent_as_colors_to_who_wants_it(self):
        plain, strain = Latest("surface", SurfaceVertices), Latest("surface_strain", SurfaceVertices)
        wait_until(lambda: plain.count and strain.count, LIMIT_S, "surfaces")
        self.assertEqual(len(plain.message.colors), 0)
        rospy.ServiceProxy("reset", Trigger)()
        wait_until(lambda: all(isBlue(color) for color in set(strain.message.colors)), LIMIT_S, "cloth at rest")
        self.assertEqual(3 * len(strain.message.colors), len(strain.message.positions_m))
        self.left.move((0.05, 0, ABOVE_M), (0.05, 0, CLOTH_M - 0.02), 1)
        wait_until(lambda: len(set(strain.message.colors)) > 10, LIMIT_S, "colors of a cloth that is pushed")
        self.left.position = None
        plain.stop()
        strain.stop()

    def test_strain_and_force_are_sent_as_a_cloud(self):
        surface, clouds = Latest("surface", SurfaceVertices), []
        cloud = Latest("tissue_cloud", PointCloud2, lambda m: clouds.append(m.header.stamp.to_sec()))
        wait_until(lambda: surface.count and len(clouds) > 3, LIMIT_S, "clouds")
        message = cloud.message
        self.assertEqual([(f.name, f.offset, f.datatype) for f in message.fields],
                         [(name, 4 * i, PointField.FLOAT32) for i, name in enumerate(("x", "y", "z", "strain", "force"))])
        self.assertEqual((message.header.frame_id, message.point_step, len(message.data)), ("tissue", 20, 20 * message.width))
        points = list(struct.iter_unpack("<5f", message.data))
        self.assertGreater(len(points), 100)
        self.assertTrue(all(math.isfinite(value) for point in points for value in point))
        self.assertTrue(all(strain >= 0 and force >= 0 for _, _, _, strain, force in points))
        self.assertGreater((clouds[-1] - clouds[0]) / (len(clouds) - 1), CLOUD_S, "five times a second at most")
        surface.stop()
        cloud.stop()

    def test_sutures_are_published_node_by_node(self):
        sutures = Latest("sutures", Sutures)
        message = wait_until(lambda: sutures.message, LIMIT_S, "sutures")
        self.assertEqual((message.header.frame_id, message.names), ("tissue", ["suture"]))
        self.assertAlmostEqual(message.radii_m[0], 0.16e-3, delta=1e-9)  # USP 2-0
        self.assertEqual(3 * message.nodes[0], len(message.positions_m))
        for at, way in zip((0, 3 * message.nodes[0] - 3), ((-0.09, 0.15, 0.05), (0.03, 0.15, 0.05))):
            for part, wanted in zip(message.positions_m[at:at + 3], way):
                self.assertAlmostEqual(part, wanted, delta=1e-6)
        sutures.stop()

    def test_a_cut_renews_the_topology_for_those_who_want_nothing_else(self):
        topology = Latest("surface_topology", SurfaceTopology)
        wait_until(lambda: topology.count, LIMIT_S, "topology")
        whole = topology.message
        self.right.move((0, -0.15, CLOTH_M - 0.05), (0, 0, CLOTH_M - 0.05), 1.5)
        cut = wait_until(lambda: topology.message.version != whole.version and topology.message, LIMIT_S,
                         "new topology after a cut")
        self.right.position = None
        self.assertNotEqual(cut.triangles, whole.triangles)
        wait_until(lambda: self.watch.value("right", "input_age_s") > 0.5, LIMIT_S, "stylus without poses")
        rospy.ServiceProxy("reset", Trigger)()
        wait_until(lambda: topology.message.triangles == whole.triangles, LIMIT_S, "whole topology after a reset")
        self.watch.wait_news()
        topology.stop()

    def test_changes_make_of_the_first_topology_the_last_one(self):
        changes = []
        topology = Latest("surface_topology", SurfaceTopology)
        change = Latest("surface_topology_change", SurfaceTopologyChange, changes.append, queue_size=None).connect()
        wait_until(lambda: topology.count and self.watch.wait_news() is None, LIMIT_S, "topology")
        start = topology.message
        self.right.move((0.03, -0.15, CLOTH_M - 0.05), (0.03, 0, CLOTH_M - 0.05), 1.5)
        self.right.position = None
        wait_until(lambda: self.watch.value("right", "input_age_s") > 0.5, LIMIT_S, "stylus without poses")
        wait_until(lambda: changes and topology.message.version == changes[-1].version, LIMIT_S, "whole topology")
        triangles = list(start.triangles)
        for message in [c for c in changes if c.version > start.version]:
            after, at, added = [], 0, 0
            for kept, removed, more in zip(message.kept, message.removed, message.added):
                after += triangles[3 * at:3 * (at + kept)] + list(message.triangles[3 * added:3 * (added + more)])
                at, added = at + kept + removed, added + more
            triangles = after + triangles[3 * at:]
        self.assertEqual([c.version for c in changes if c.version > start.version],
                         list(range(start.version + 1, topology.message.version + 1)))
        self.assertGreater(topology.message.version, start.version)
        self.assertEqual(triangles, list(topology.message.triangles))
        self.assertEqual(changes[-1].body_triangles, topology.message.body_triangles)
        change.stop()
        topology.stop()
        rospy.ServiceProxy("reset", Trigger)()

    @staticmethod
    def note(message, seen):
        """Records the visible markers by namespace and id."""
        for marker in message.markers:
            if marker.action == Marker.ADD:
                seen.setdefault(marker.ns, {})[marker.id] = marker
            else:
                seen.get(marker.ns, {}).pop(marker.id, None)

    def test_markers_show_tools_obstacles_forces_and_names(self):
        seen = {}
        markers = Latest("scene_markers", MarkerArray, lambda message: self.note(message, seen))
        wait_until(lambda: "obstacles" in seen, LIMIT_S, "markers")
        tile = list(seen["obstacles"].values())[0]
        self.assertEqual((tile.header.frame_id, tile.pose.position.x, tile.pose.position.z), ("tissue", 0.08, 0.05))
        self.assertFalse(seen.get("tools"))
        self.left.move((-0.05, 0, ABOVE_M), (-0.05, 0, CLOTH_M - 0.02), 1)
        wait_until(lambda: seen.get("tools") and seen.get("forces"), LIMIT_S, "tool and force")
        tool, force = list(seen["tools"].values())[0], list(seen["forces"].values())[0]
        self.assertEqual((tool.header.frame_id, tool.frame_locked, tool.pose.position.x), ("left_tool", True, 0))
        tip = wait_until(lambda: self.frames.get("left_tool"), LIMIT_S, "frame of the tool")
        self.assertAlmostEqual(tip.translation.x, -0.05, delta=1e-6)
        self.assertGreater(force.points[1].z, force.points[0].z)  # the cloth pushes up
        self.assertEqual({marker.text for marker in seen["names"].values()}, {"tile", "camera", "left"})
        self.left.position = None
        wait_until(lambda: not seen["tools"] and not seen["forces"], LIMIT_S, "end of the tool")
        markers.stop()

    def test_marks_on_the_cloth_are_lines_that_move_with_it(self):
        for service in ("pause", "reset"):  # the cloth is at rest until it is resumed
            self.assertTrue(rospy.ServiceProxy(service, Trigger)().success)
        seen = {}
        markers = Latest("scene_markers", MarkerArray, lambda message: self.note(message, seen))
        line = list(wait_until(lambda: seen.get("marks"), LIMIT_S, "mark").values())[0]
        self.assertEqual((line.type, line.header.frame_id), (Marker.LINE_LIST, "tissue"))
        self.assertAlmostEqual(line.scale.x, 0.002, delta=1e-6)
        self.assertAlmostEqual(line.colors[0].b, 0.91, delta=1e-6)
        for axis, low, high in (("x", -0.06, -0.02), ("y", 0.05, 0.05)):
            places = [getattr(point, axis) for point in line.points]
            self.assertAlmostEqual(min(places), low, delta=1e-4)
            self.assertAlmostEqual(max(places), high, delta=1e-4)
        self.assertTrue(rospy.ServiceProxy("resume", Trigger)().success)
        self.left.move((-0.04, 0.05, ABOVE_M), (-0.04, 0.05, CLOTH_M), 1)
        wait_until(lambda: min(point.z for point in list(seen["marks"].values())[0].points) < CLOTH_M - 0.01, LIMIT_S,
                   "mark on a cloth that is pushed")
        self.left.position = None
        markers.stop()

    def test_meshes_of_tools_are_sent_once_and_to_each_who_comes(self):
        arrays = []
        markers = Latest("scene_markers", MarkerArray, arrays.append, queue_size=1000)
        self.left.move((-0.05, 0, ABOVE_M), (-0.02, 0, ABOVE_M), 0.5)

        def drawn(array):
            return [m for m in array.markers if m.ns == "tools" and m.action == Marker.ADD and m.points]
        wait_until(lambda: any(drawn(array) for array in arrays), LIMIT_S, "tool")
        del arrays[:]
        self.left.move((-0.02, 0, ABOVE_M), (-0.05, 0, ABOVE_M), 3)
        with_tools = sum(1 for array in arrays if drawn(array))
        self.assertGreater(len(arrays), 20)
        self.assertLess(with_tools, 0.2 * len(arrays))  # when its shape changes, every 5 s, and if a busy machine lost tracking
        late = []
        markers.stop()  # subscribers of one process share a connection
        time.sleep(0.5)
        another = Latest("scene_markers", MarkerArray, late.append, queue_size=1000)
        # a regular one may come first
        wait_until(lambda: any(drawn(array) for array in late), 0.7 * AGAIN_S, "tool for who comes")
        self.left.position = None
        another.stop()

    def test_the_whole_topology_is_sent_again_for_bags_that_are_split(self):
        came = []
        topology = Latest("surface_topology", SurfaceTopology, lambda it: came.append((time.monotonic(), it)), queue_size=10)
        wait_until(lambda: len(came) >= 3, 3 * AGAIN_S, "topology again and again")
        first, again = came[1][1], came[2][1]
        self.assertEqual((first.version, first.triangles), (again.version, again.triangles))
        self.assertGreater(came[2][0] - came[1][0], 0.8 * AGAIN_S)
        topology.stop()

    def test_markers_show_nodes_that_are_held(self):
        seen = {}
        markers = Latest("scene_markers", MarkerArray, lambda message: self.note(message, seen))
        set_tool_mode = rospy.ServiceProxy("set_tool_mode", SetToolMode)
        self.assertTrue(set_tool_mode("left", "idle", "none").success)  # a probe would push the cloth away
        self.left.position = (-0.05, 0, CLOTH_M)
        wait_until(lambda: seen.get("tools"), LIMIT_S, "tool")
        self.assertFalse(seen.get("held"))
        self.assertTrue(set_tool_mode("left", "idle", "grab").success)
        held = list(wait_until(lambda: seen.get("held"), LIMIT_S, "nodes that are held").values())[0]
        tool = list(seen["tools"].values())[0]
        self.assertEqual(tool.header.frame_id, "left_tool")
        self.assertAlmostEqual(held.pose.position.x, -0.05, delta=1e-6)
        wait_until(lambda: self.watch.value("left", "nodes_held") == len(held.points), LIMIT_S, "as many as are held")
        for point in held.points:
            self.assertLess(math.hypot(point.x, point.y, point.z), GRAB_M)
        self.assertTrue(set_tool_mode("left", "idle", "probe").success)
        wait_until(lambda: not seen["held"], LIMIT_S, "nodes that are let go")
        self.left.position = None
        wait_until(lambda: not seen["tools"], LIMIT_S, "end of the tool")
        markers.stop()


if __name__ == "__main__":
    rostest.rosrun("viscera", "scene_view_test", SceneViewTest, sys.argv)
