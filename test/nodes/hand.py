#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A hand with a device, as a process of its own: it presses the probe of `left` into the heart, holds it there, and notes
every wrench that it is told. Prints `touching` once it feels a force, and, when its standard input ends, a JSON list of
[time.monotonic(), force in N, torque in N m, the message's stamp in s]."""
import json
import math
import sys
import threading
import time

import rospy
from geometry_msgs.msg import PoseStamped, WrenchStamped

OUTSIDE_Y_M, DEEP_Y_M = -0.1, -0.05   # before the heart's front wall, and behind it
APPROACH_S = 1.0
RATE_HZ = 200
FELT_N = 0.02


class Hand:
    def __init__(self, wrenches):
        self.felt = []
        self.lock = threading.Lock()
        self.poses = rospy.Publisher("left/measured_cp", PoseStamped, queue_size=1, tcp_nodelay=True)
        self.force = rospy.Subscriber(wrenches, WrenchStamped, self.feel, queue_size=100, tcp_nodelay=True)

    def feel(self, message):
        f, t = message.wrench.force, message.wrench.torque
        with self.lock:
            self.felt.append((time.monotonic(), math.hypot(f.x, f.y, f.z), math.hypot(t.x, t.y, t.z),
                              message.header.stamp.to_sec()))

    def move(self, since_s):
        pose = PoseStamped()
        pose.header.frame_id = "tissue"
        pose.header.stamp = rospy.Time.now()
        way = min(1.0, since_s / APPROACH_S)
        pose.pose.position.y = OUTSIDE_Y_M + way * (DEEP_Y_M - OUTSIDE_Y_M)
        pose.pose.position.z = -0.02
        pose.pose.orientation.w = 1
        self.poses.publish(pose)

    def play(self, stop):
        while not stop.is_set() and not self.poses.get_num_connections():
            time.sleep(0.02)
        begun, told = time.monotonic(), False
        while not stop.is_set():
            since_s = time.monotonic() - begun
            self.move(since_s)
            if not told and since_s > 2 * APPROACH_S and self.felt and self.felt[-1][1] > FELT_N:
                told = True
                print("touching", flush=True)
            time.sleep(1 / RATE_HZ)


def main():
    rospy.init_node("hand", anonymous=True, disable_signals=True)
    stop = threading.Event()
    hand = Hand(sys.argv[1] if len(sys.argv) > 1 and ":=" not in sys.argv[1] else "left/body/servo_cf")
    player = threading.Thread(target=hand.play, args=(stop,), daemon=True)
    player.start()
    sys.stdin.read()
    stop.set()
    player.join()
    with hand.lock:
        print(json.dumps(hand.felt), flush=True)


if __name__ == "__main__":
    main()
