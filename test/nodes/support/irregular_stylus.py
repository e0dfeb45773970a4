# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A stylus with a CRTK device that sends at irregular times."""
import random
import time

import rospy
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState, Joy

SEED = 5
LONGEST_GAP_S = 0.03               # shorter than stale_after_s
TURN = (0.7071067811865476, 0, 0, 0.7071067811865476)   # the tip points along +y, into the tissue


class StylusDevice:
    """Sends poses at irregular times, and buttons between them."""

    def __init__(self, name):
        self.poses = rospy.Publisher(name + "/measured_cp", PoseStamped, queue_size=1, tcp_nodelay=True)
        self.buttons = [rospy.Publisher("%s/button%d" % (name, b), Joy, queue_size=10) for b in (1, 2)]
        self.gripper = rospy.Publisher(name + "/gripper/measured_js", JointState, queue_size=10)
        self.random = random.Random(SEED + len(name))

    def heard(self):
        return all(p.get_num_connections() for p in (self.poses, self.gripper, *self.buttons))

    def send(self, at):
        message = PoseStamped()
        message.header.frame_id = "tissue"
        message.header.stamp = rospy.Time.now()
        p, q = message.pose.position, message.pose.orientation
        p.x, p.y, p.z = at
        q.x, q.y, q.z, q.w = TURN
        self.poses.publish(message)

    def go(self, start, to, seconds):
        begun, way = time.monotonic(), 0
        while way < 1:
            way = min(1.0, (time.monotonic() - begun) / seconds)
            self.send([a + way * (b - a) + self.random.gauss(0, 1e-5) for a, b in zip(start, to)])
            time.sleep(self.random.uniform(0, LONGEST_GAP_S))

    def press(self, button, down):
        self.buttons[button - 1].publish(Joy(buttons=[1 if down else 0]))

    def grip(self, opening_rad):
        self.gripper.publish(JointState(position=[opening_rad]))
