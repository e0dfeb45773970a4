#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""stylus_device.py [WRENCHES [KIND]]: a stylus with a device, as a separate process. After a line on its standard input it
presses the probe of `left` into the tissue, tries again if there was no force, holds it there, and records every wrench
that it receives.

It prints `touching` once it has a lasting force, and `let go` at the first zero after that. When its input ends, it
prints a JSON list of [time.monotonic(), force in N, torque in N m, the message's stamp in s]. KIND is a class of
drivers.py with its driver's topics; by default it uses CRTK and subscribes to WRENCHES."""
import itertools
import json
import math
import sys
import threading
import time

import drivers
import rospy
from geometry_msgs.msg import PoseStamped, WrenchStamped

OUTSIDE_Y_M, DEEP_Y_M = -0.1, -0.05   # in front of the tissue's front wall, and behind it
APPROACH_S = 0.3
LASTS_S = 0.3       # without a break; there may be some while the simulator makes its first images
RATE_HZ = 200
FELT_N = 0.02
AGAIN_S = 3         # without contact: poses paused while the probe went in, and one that appears inside pushes nothing


class StylusDevice:
    def begin(self):
        self.felt = []
        self.lock = threading.Lock()
        self.told, self.let_go = False, False

    def __init__(self, wrenches):
        self.begin()
        self.poses = rospy.Publisher("left/measured_cp", PoseStamped, queue_size=1, tcp_nodelay=True)
        self.force = rospy.Subscriber(wrenches, WrenchStamped, self.feel, queue_size=100, tcp_nodelay=True)

    def feel(self, message):
        f, t = message.wrench.force, message.wrench.torque
        self.keep(math.hypot(f.x, f.y, f.z), math.hypot(t.x, t.y, t.z), message.header.stamp.to_sec())

    def keep(self, force_n, torque_nm, stamp_s):
        with self.lock:
            self.felt.append((time.monotonic(), force_n, torque_nm, stamp_s))
        if self.told and not self.let_go and force_n == 0:
            self.let_go = True
            print("let go", flush=True)

    def touches(self, begun):
        """Returns whether there is a force now, and was at all times in LASTS_S, all of them after `begun`."""
        now = time.monotonic()
        with self.lock:
            lately = list(itertools.takewhile(lambda felt: felt[0] > now - LASTS_S, reversed(self.felt)))
        return now > begun + LASTS_S and bool(lately) and all(n > FELT_N for _, n, _, _ in lately)

    def connected(self):
        return self.poses.get_num_connections() > 0

    def move(self, tip):
        pose = PoseStamped()
        pose.header.frame_id = "tissue"
        pose.header.stamp = rospy.Time.now()
        pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = tip
        pose.pose.orientation.w = 1
        self.poses.publish(pose)

    def play(self, stop):
        while not stop.is_set() and not self.connected():
            time.sleep(0.02)
        begun = time.monotonic()
        while not stop.is_set():
            if not self.told and time.monotonic() > begun + AGAIN_S:
                begun = time.monotonic()  # out, and in again
            since_s = time.monotonic() - begun
            way = min(1.0, since_s / APPROACH_S)
            self.move((0, OUTSIDE_Y_M + way * (DEEP_Y_M - OUTSIDE_Y_M), -0.02))
            if not self.told and self.touches(begun + APPROACH_S):
                print("touching", flush=True)
                self.told = True
            time.sleep(1 / RATE_HZ)


class DriverStylus(StylusDevice):
    """For a driver with messages that have a force only."""

    def __init__(self, kind):
        self.begin()
        self.driver = kind("left")
        self.driver.feel = self.note

    def note(self, force):
        self.keep(math.hypot(*force), 0.0, 0.0)

    def connected(self):
        return self.driver.poses.get_num_connections() > 0

    def move(self, tip):
        self.driver.at = tip


def main():
    rospy.init_node("stylus_device", anonymous=True, disable_signals=True)
    stop = threading.Event()
    arguments = [a for a in sys.argv[1:] if ":=" not in a]
    device = (DriverStylus(getattr(drivers, arguments[1])) if len(arguments) > 1 else
            StylusDevice(arguments[0] if arguments else "left/body/servo_cf"))
    player = threading.Thread(target=device.play, args=(stop,), daemon=True)
    sys.stdin.readline()
    player.start()
    sys.stdin.read()
    stop.set()
    player.join()
    with device.lock:
        print(json.dumps(device.felt), flush=True)


if __name__ == "__main__":
    main()
