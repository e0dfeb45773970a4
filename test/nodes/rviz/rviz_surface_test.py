#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The display viscera/Surface in rviz: what it draws for topologies, their changes and vertices, valid and invalid
ones."""
import os
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from rviz_screen import IMAGE, MOUSE_SIGN, VIEW, Screen, alone, drawn_hz, rviz
from sent_ball import Sender, packed
from simulator_watch import wait_until

from viscera.msg import SurfaceTopologyChange, SurfaceVertices

CONFIG = os.path.join(subprocess.check_output(["rospack", "find", "viscera"], text=True).strip(),
                      "config", "viscera_plugin.rviz")
LIMIT_S = 60      # software rendering on a busy machine
SCENE_COLOR = 0xffc08040
MIDDLE = slice(335, 355), slice(225, 245)  # rows and columns of VIEW, in the middle of the disc
LEAST_LIGHT, MOST_LIGHT = 0.6, 1.1
FEW, MANY = 300, 10000  # pixels: frames' axes are red too; a ball of 5 cm is 200 pixels wide


def blue(picture):
    """Returns the blue pixels."""
    return int(((picture[:, :, 2] > 2 * picture[:, :, 0]) & (picture[:, :, 2] > 60)).sum())


class RvizSurfaceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.screen = Screen()
        cls.rviz = rviz(CONFIG, lambda: cls.screen.find(MOUSE_SIGN))
        cls.sender = Sender()  # rviz subscribes several times as it starts, and messages before may be lost

    @classmethod
    def tearDownClass(cls):
        cls.rviz.end()
        cls.screen.end()

    def pixels(self):
        """Returns the numbers of pixels of the surface and of cut walls: red, bright and dark."""
        self.assertIsNone(self.rviz.process.poll(), "rviz has ended: " + self.rviz.output)
        red, green, blue = (self.screen.picture(VIEW)[:, :, i] for i in range(3))
        skin = (red > 1.5 * green) & (green > 1.05 * blue - 3) & (red > 40) & (green > 0.25 * red)
        walls = (red > 3 * green) & (red > 3 * blue) & (red > 30) & (red < 140)
        return int(skin.sum()), int(walls.sum())

    def expect(self, condition, what):
        wait_until(lambda: condition(*self.pixels()), LIMIT_S, what)

    def test_a_surface_its_changes_and_wrong_messages(self):
        sender = self.sender
        wait_until(lambda: sender.surface.get_num_connections() and sender.change.get_num_connections(), LIMIT_S,
                   "subscription of rviz in: " + self.rviz.output)
        self.assertIn("with --disable-anti-aliasing", self.rviz.output)
        sender.topology(1, [0, 1, 10**9] * 4)  # no such vertex
        sender.vertices(1)
        sender.vertices(1, positions_m=[float("nan")] * 3 * len(sender.points))
        time.sleep(2)
        skin, walls = self.pixels()
        self.assertLess(skin, FEW)
        self.assertLess(walls, FEW)

        sender.topology(2)
        sender.vertices(2)
        self.expect(lambda skin, walls: skin > MANY and walls > MANY, "ball with skin and walls")

        sender.vertices(2, normals=[0])  # fewer than vertices: the previous surface stays
        sender.change.publish(SurfaceTopologyChange(version=3, kept=[10**6], removed=[1], added=[0]))
        time.sleep(2)
        self.expect(lambda skin, walls: skin > MANY and walls > MANY, "ball after wrong messages")

        skin_triangles = len(sender.triangles) // 6
        sender.change.publish(SurfaceTopologyChange(version=3, vertices=len(sender.points),
                                                    body_triangles=[skin_triangles], wound_triangles=[0],
                                                    kept=[skin_triangles], removed=[skin_triangles], added=[0]))
        sender.vertices(3)
        self.expect(lambda skin, walls: skin > MANY and walls < FEW, "ball without its walls")

        colors = [0xffd02020] * len(sender.points)
        sender.vertices(3, colors=colors[1:])  # fewer than vertices
        sender.vertices(3, colors=colors)
        self.expect(lambda skin, walls: skin < FEW and blue(self.screen.picture(VIEW)) > MANY, "ball with colors of its vertices")
        self.screen.keep("colors.ppm")
        sender.vertices(3)
        self.expect(lambda skin, walls: skin > MANY and blue(self.screen.picture(VIEW)) < FEW, "ball with the color of its body")

        # In the colours of the scene, and flat: its top is seen from the side.
        sender.topology(4, body_colors=[SCENE_COLOR], wound_colors=[SCENE_COLOR])
        flat = [0 if i % 3 == 2 else x for i, x in enumerate(sender.positions_m)]
        sender.vertices(4, positions_m=flat, normals=[packed((0, 0, 1))] * len(sender.points))
        scene_color = [SCENE_COLOR >> shift & 0xff for shift in (0, 8, 16)]

        def is_seen():
            shares = self.screen.picture(VIEW)[MIDDLE].mean(axis=(0, 1)) / scene_color
            return min(shares) > LEAST_LIGHT and max(shares) < MOST_LIGHT
        wait_until(is_seen, LIMIT_S, "flat disc in the color of the scene")
        self.screen.keep("flat.ppm")

        sender.topology(1)  # like a restarted simulator
        sender.vertices(1)
        self.expect(lambda skin, walls: skin > MANY and walls > MANY, "ball of the other simulator")

        self.rviz.process.send_signal(2)
        self.assertEqual(self.rviz.process.wait(LIMIT_S), 0, self.rviz.output)


class RvizStrainTest(unittest.TestCase):
    def test_strain_is_another_topic(self):
        screen, sender = Screen(), Sender()
        strain = rospy.Publisher("surface_strain", SurfaceVertices, queue_size=1)
        program = alone(screen, 30, "--disable-anti-aliasing", color_by="strain")
        try:
            wait_until(strain.get_num_connections, LIMIT_S, "subscription of rviz")
            self.assertEqual(sender.surface.get_num_connections(), 0)

            def seen():
                sender.topology(1)  # repeatedly: rviz subscribes more than once while it starts
                strain.publish(sender.moved(1, 0, colors=[0xffd02020] * len(sender.points)))
                return blue(screen.picture()) > MANY
            wait_until(seen, LIMIT_S, "ball with colors of strain in: " + program.output)
            self.assertNotIn("with --disable-anti-aliasing", program.output)
        finally:
            program.end()
            screen.end()


class RvizWindowTest(unittest.TestCase):
    def test_a_window_that_the_x_server_gets_late(self):
        self.draws_although_late("1")

    def test_the_window_of_an_image_that_the_x_server_gets_late(self):
        self.draws_although_late("2", IMAGE)

    def draws_although_late(self, which, others=""):
        screen, sender = Screen(640, 480), Sender()
        late = {"LD_PRELOAD": os.environ["VISCERA_LATE_WINDOW"], "VISCERA_LATE": which}
        os.environ.update(late)
        program = alone(screen, 30, "--disable-anti-aliasing", others=others)
        for name in late:
            del os.environ[name]
        try:
            def drawn():
                self.assertIsNone(program.process.poll(), "rviz has ended: " + program.output)
                sender.topology(1)
                sender.vertices(1)
                return drawn_hz(program.output)
            wait_until(drawn, LIMIT_S, "ball that is drawn in: " + program.output)
            program.said("a window came late")
        finally:
            program.end()
            screen.end()


if __name__ == "__main__":
    rospy.init_node("rviz_surface_test")
    rostest.rosrun("viscera", "rviz_surface", "__main__", sys.argv)
