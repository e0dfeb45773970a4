#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Prints the latency and the dropped poses for a driver of every kind in the demo's scene: the table of
docs/devices.md. Requires a roscore and the environment of the build: `. build/devel/setup.sh;
test/nodes/support/device_table.py`."""
import math
import sys
import time

import drivers
import rospy
from program import Program
from simulator_watch import SimulatorWatch

SECONDS = 5
CENTRE = {"left": (-0.02, -0.058, -0.02), "right": (0.02, -0.058, -0.02)}  # of the probes: in the front wall of the heart
RADIUS_M, TURNS_HZ = 0.008, 0.5
REASONS = ("stamp_zero", "not_finite", "bad_quaternion", "no_transform", "old_transform", "repeated_stamp", "delayed",
           "outside_workspace", "no_buttons", "button_value", "jaw_angle", "joint_count")
LATENCIES = ("p50", "p99", "max")


class Arm(drivers.Crtk):
    """A client of a tool that is an arm, at 200 Hz."""
    rate_hz = 200

    def device(self):
        return self.stylus + "=crtk_arm"

    def open(self):
        self.poses = rospy.Publisher(self.stylus + "/servo_cp", self.message, queue_size=1, tcp_nodelay=True)
        rospy.Subscriber(self.stylus + "/measured_cf", drivers.WrenchStamped,
                         lambda m: self.feel(drivers.vector(m.wrench.force)))

    def tell(self, position, rotation):
        super().tell(position, drivers.times(rotation, drivers.JAWS))


def circle(device, begun):
    angle = 2 * math.pi * TURNS_HZ * (time.monotonic() - begun)
    x, y, z = CENTRE[device.stylus]
    return x + RADIUS_M * math.cos(angle), y, z + RADIUS_M * math.sin(angle)


def rows(kinds):
    hands = [kind(stylus) for kind, stylus in zip(kinds, ("left", "right"))]
    arguments = ["device_%s:=%s" % tuple(device.device().split("=")) for device in hands]
    options = ";".join("%s.%s" % (device.stylus, option) for device in hands for option in device.options)
    name = "table_" + "_".join(type(device).__name__ for device in hands).lower()
    program = Program(["roslaunch", "viscera", "training.launch", "name:=" + name, "spacing:=0.006"] + arguments +
                      (["device_options:=" + options] if options else []))
    try:
        program.said("ready:")
        watch = SimulatorWatch(name)
        begun, worst = time.monotonic(), {}
        while time.monotonic() - begun < SECONDS + 2:
            for device in hands:
                device.at = circle(device, begun)
                for part in LATENCIES:
                    value = watch.value("latency", "pose_to_force_%s_%s_ms" % (device.stylus, part)) or 0
                    worst.setdefault((device, part), []).append(value)
            time.sleep(0.005)
        watch.wait_news()
        for device in hands:
            accepted = watch.value(device.stylus, "poses_accepted")
            dropped = sum(watch.value(device.stylus, "dropped_" + reason) or 0 for reason in REASONS)
            told = sorted(set(round(v, 2) for v in worst[(device, "p50")] if v > 0))
            ms = ["%.2f" % sorted(v)[len(v) // 2] if told else "no forces" for v in
                  ([x for x in worst[(device, part)] if x > 0] for part in LATENCIES)]
            print("| `%s` | %d | %d | %d | %s |" % (device.profile if not isinstance(device, Arm) else "crtk_arm", device.rate_hz,
                                                    accepted, dropped, " | ".join(ms)), flush=True)
    finally:
        for device in hands:
            device.end()
        program.end()


def main():
    rospy.init_node("device_table", anonymous=True)
    print("| profile | poses sent per second | taken | dropped | median ms | p99 ms | longest ms |\n|---|---|---|---|---|---|---|")
    kinds = drivers.KINDS + [Arm]
    for first in range(0, len(kinds), 2):
        pair = kinds[first:first + 2]
        rows(pair if len(pair) == 2 else pair + [drivers.Crtk])


if __name__ == "__main__":
    sys.exit(main())
