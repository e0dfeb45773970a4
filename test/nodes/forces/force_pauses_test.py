#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A stall or pause of the simulation removes the force from the stylus at once."""
import ctypes
import os
import sys
import time

import rospy
import rostest
from force_session import END_LIMIT_S, FELT_S, HEART, ForceCase, Session
from sensor_msgs.msg import Image
from simulator_watch import Latest, wait_until
from std_srvs.srv import Trigger

STALL_S = 1.0   # twenty times the limit after which the force must be zero
BACK_S = 1.0    # time in which the force returns
STALL_LIMIT_S = 3 / 60 + 0.01  # for a stall: no tick for three of 1/60 s, then zero within 10 ms (docs/ros_api.md)
PAUSE_LIMIT_S = 2.5 / 60  # a tick, the slew, and less than the time to detect a stall of three ticks
PTRACE_SEIZE, PTRACE_INTERRUPT, PTRACE_DETACH = 0x4206, 0x4207, 17


def stop_thread(pid, name, seconds):
    """Stops the oldest thread of that name for a while, as a debugger does, and continues it. Younger threads have the
    name of the thread that started them."""
    libc = ctypes.CDLL(None, use_errno=True)
    libc.ptrace.argtypes = [ctypes.c_ulong, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]

    def ask(request, tid):
        if libc.ptrace(request, tid, None, None) != 0:
            raise OSError(ctypes.get_errno(), "ptrace")

    tids = [int(t) for t in os.listdir("/proc/%d/task" % pid)
            if open("/proc/%d/task/%s/comm" % (pid, t)).read().strip() == name]
    tid = min(tids)
    ask(PTRACE_SEIZE, tid)
    begun = time.monotonic()
    ask(PTRACE_INTERRUPT, tid)
    os.waitpid(tid, 0x40000000)  # __WALL: threads too
    time.sleep(seconds)
    ask(PTRACE_DETACH, tid)
    return begun


class ForcePausesTest(ForceCase):
    def test_stall(self):
        with Session() as session:
            session.wait_touch()
            begun = stop_thread(session.simulator.pid, "simulation", STALL_S)
            ended = time.monotonic()
            felt = session.felt(BACK_S)
            self.assertZeroSoon("stall of %g s" % STALL_S, felt, begun, until=ended, limit_s=STALL_LIMIT_S)
            self.assertGreater(felt[-1][1], 0)  # and the force returns
            rises = [(a, b) for a, b in zip(felt, felt[1:]) if b[1] > a[1] and a[0] > ended]
            self.assertGreater(len(rises), 0)

    def test_pause_releases_before_a_picture_is_drawn(self):
        """While paused, a viewer receives an image of the current state, which takes long to draw here."""
        rospy.init_node("force_pauses_test", anonymous=True, disable_signals=True)
        with Session(scene=(HEART[0], HEART[1] + ";cameras[0].width_px=2048;cameras[0].height_px=1536")) as session:
            session.wait_touch()
            pictures = Latest(session.space + "/camera/image_raw", Image)
            wait_until(lambda: pictures.count >= 2, END_LIMIT_S, "pictures")
            pause = rospy.ServiceProxy(session.space + "/pause", Trigger, persistent=True)
            pause.wait_for_service(END_LIMIT_S)
            ended = time.monotonic()
            self.assertTrue(pause().success)
            self.assertZeroSoon("pause, slow pictures", session.felt(FELT_S), ended, limit_s=PAUSE_LIMIT_S)
            pictures.stop()


if __name__ == "__main__":
    rostest.rosrun("viscera", "force_pauses_test", ForcePausesTest, sys.argv)
