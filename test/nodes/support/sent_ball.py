# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A ball, sent in the same messages as a simulator's surface."""
import io
import math

import numpy
import rospy

from viscera.msg import SurfaceTopology, SurfaceTopologyChange, SurfaceVertices

RADIUS_M = 0.05


def ball(rings, steps):
    """Returns vertices, which are outward normals too, and triangles from the upper pole down."""
    points, triangles = [], []
    for ring in range(rings + 1):
        for step in range(steps):
            polar, turn = math.pi * ring / rings, 2 * math.pi * step / steps
            points.append((math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn), math.cos(polar)))
            if ring < rings:
                a, b = ring * steps + step, ring * steps + (step + 1) % steps
                triangles += [a, a + steps, b, b, a + steps, b + steps]
    return points, triangles


def packed(normal):
    return sum((round(511 * x) & 1023) << (10 * i) for i, x in enumerate(normal))


def filled(triangles):
    """Returns rings and steps of a ball with at least this many triangles."""
    return math.ceil(math.sqrt(triangles / 2))


class Made(SurfaceVertices):
    """A message with precomputed bytes."""

    def serialize(self, buff):
        buff.write(self.bytes)


class Sender:
    """The upper half is the surface; the lower half represents cut walls."""

    def __init__(self, rings=24, steps=48):
        self.whole = rospy.Publisher("surface_topology", SurfaceTopology, queue_size=1, latch=True)
        self.change = rospy.Publisher("surface_topology_change", SurfaceTopologyChange, queue_size=10)
        self.surface = rospy.Publisher("surface", SurfaceVertices, queue_size=1, latch=True)
        self.points, self.triangles = ball(rings, steps)
        self.positions_m = [RADIUS_M * x for point in self.points for x in point]
        self.normals = [packed(point) for point in self.points]

    def topology(self, version, triangles=None, bodies=1, **other):
        triangles = self.triangles if triangles is None else triangles
        of_each = len(triangles) // 3 // bodies
        of_bodies = [of_each] * (bodies - 1) + [len(triangles) // 3 - of_each * (bodies - 1)]
        message = SurfaceTopology(version=version, vertices=len(self.points),
                                  bodies=["ball %d" % b for b in range(bodies)], body_triangles=of_bodies,
                                  wound_triangles=[count // 2 for count in of_bodies], triangles=triangles, **other)
        message.header.frame_id, message.header.stamp = "tissue", rospy.Time.now()
        self.whole.publish(message)

    def message(self, version):
        message = SurfaceVertices(topology_version=version, positions_m=self.positions_m, normals=self.normals)
        message.header.frame_id, message.header.stamp = "tissue", rospy.Time.now()
        return message

    def moved(self, version, share, **other):
        """Returns the ball stretched slightly along x, as bytes: creating a message of 100,000 vertices takes longer
        than drawing it."""
        message = self.message(version)
        stretched = numpy.array(self.positions_m).reshape(-1, 3) * (1 + 0.1 * share, 1, 1)
        message.positions_m = stretched.ravel().tolist()
        for key, value in other.items():
            setattr(message, key, value)
        made = Made()
        made.header = message.header
        buffer = io.BytesIO()
        message.serialize(buffer)
        made.bytes = buffer.getvalue()
        return made

    def vertices(self, version, **other):
        message = self.message(version)
        for key, value in other.items():
            setattr(message, key, value)
        self.surface.publish(message)
