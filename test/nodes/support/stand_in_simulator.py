#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""What rviz receives from a simulator, without tissue: a ball with permanently changing triangles, /diagnostics, and a
service `pause` that does not answer."""
import os
import sys

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from sent_ball import Sender
from std_srvs.srv import Trigger

from viscera.msg import SurfaceTopologyChange

COMMAND = [sys.executable, os.path.abspath(__file__)]
SENT_HZ = 50
TOLD_EVERY = 10  # surfaces per diagnostics message
MOST_GONE = 100  # triangles
BODIES = 100     # of every fourth topology, so that parts, materials and draw calls come and go
RED = 0xff4040b8


class ChangingBall(Sender):
    """Every step has another topology: as a whole, in other bodies, or with some triangles fewer or more."""

    def __init__(self):
        super().__init__()
        self.version = 1
        self.topology(1)

    def step(self):
        self.version += 1
        count, gone = len(self.triangles) // 3, 1 + self.version // 4 % MOST_GONE
        kind = self.version % 4
        if kind == 0:
            self.topology(self.version, bodies=BODIES)
        elif kind == 1:
            self.topology(self.version)
        else:
            there = count - gone if kind == 2 else count
            edit = dict(kept=[there], removed=[gone], added=[0]) if kind == 2 else \
                dict(kept=[count - gone], removed=[0], added=[gone], triangles=self.triangles[-3 * gone:])
            self.change.publish(SurfaceTopologyChange(version=self.version, vertices=len(self.points),
                                                      body_triangles=[there], wound_triangles=[there // 2], **edit))
        colors = [RED] * len(self.points) if self.version % 8 < 4 else []
        self.surface.publish(self.moved(self.version, gone / MOST_GONE, colors=colors))


def main():
    rospy.init_node("stand_in", anonymous=True)

    def pause(_):
        print("asked", flush=True)
        rospy.sleep(1000)

    rospy.Service("pause", Trigger, pause)
    diagnostics = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=1)
    values = [KeyValue("scene", "none"), KeyValue("tick", "0"), KeyValue("paused", "False")]
    ball, rate = ChangingBall(), rospy.Rate(SENT_HZ)
    while not rospy.is_shutdown():
        ball.step()
        if ball.version % TOLD_EVERY == 0:
            status = DiagnosticStatus(name=rospy.get_name()[1:] + ": simulation", message="running", values=values)
            diagnostics.publish(DiagnosticArray(status=[status]))
        rate.sleep()


if __name__ == "__main__":
    main()
