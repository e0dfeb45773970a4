#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""However a session ends or hangs, the last thing that a device is told is zero, and soon. Each ending is brought about
from outside, with a hand (hand.py) pressed into the tissue that notes what it is told."""
import ctypes
import itertools
import json
import os
import resource
import signal
import socket
import subprocess
import sys
import time
import unittest

import roslib.packages
import rostest
from simulator_watch import wait_until

START_LIMIT_S = 60
END_LIMIT_S = 30
ZERO_LIMIT_S = 0.05     # from the ending to the first zero, seen from outside
STALL_LIMIT_S = 3 / 60 + 0.01  # of a stall: no tick for three of 1/60 s, then zero within 10 ms (docs/ros_api.md)
SCENE = ("_overrides:=bodies[0].spacing_m=0.008;bodies[0].material.young_modulus_pa=20000;"
         "environment.gravity_m_per_s2=[0,0,0];styluses[0].probe.radius_m=0.012")
HERE = os.path.dirname(os.path.abspath(__file__))
PTRACE_SEIZE, PTRACE_INTERRUPT, PTRACE_DETACH = 0x4206, 0x4207, 17
serial = itertools.count()


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def stop_thread(pid, name, seconds):
    """Stops the oldest thread of that name for a while, as a debugger does, and lets it go on. Younger ones have the name
    of the one that started them."""
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


class Session:
    """A simulator and a hand, with a master of their own where one is asked for."""

    def __init__(self, own_master=False, wrenches="left/body/servo_cf", master_arguments=()):
        self.environment = dict(os.environ, ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
        self.processes = []
        self.master = None
        if own_master:
            port = free_port()
            self.environment["ROS_MASTER_URI"] = "http://localhost:%d" % port
            self.master = self.start(["rosmaster", "--core", "-p", str(port)])
        self.space = "/force_endings_%d" % next(serial)
        self.environment["ROS_NAMESPACE"] = self.space
        self.simulator = self.node("simulator", SCENE)
        wait_ready(self.simulator)
        self.hand = self.start([sys.executable, os.path.join(HERE, "hand.py"), wrenches], stdin=subprocess.PIPE,
                               stdout=subprocess.PIPE, text=True)

    def start(self, command, **how):
        process = subprocess.Popen(command, env=self.environment, **how)
        self.processes.append(process)
        return process

    def node(self, name, *arguments):
        path = roslib.packages.find_node("viscera", name)[0]
        return self.start([path] + list(arguments), text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def wait_touch(self):
        line = self.hand.stdout.readline()
        assert line == "touching\n", line

    def felt(self, seconds):
        """What the hand was told until so many seconds from now."""
        time.sleep(seconds)
        return json.loads(self.hand.communicate(timeout=END_LIMIT_S)[0])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.processes:
            if process.poll() is None:
                process.kill()
            process.wait(END_LIMIT_S)


def wait_ready(process):
    for line in process.stdout:
        if "ready" in line:
            return
    raise AssertionError("the simulator ended before it was ready")


class ForceEndingsTest(unittest.TestCase):
    def assertZeroSoon(self, name, felt, ended, until=None, limit_s=ZERO_LIMIT_S):
        """Forces were there before, and nothing but zero from limit_s after the ending on."""
        before = [n for t, n, _, _ in felt if t < ended]
        self.assertGreater(before[-1], 0, name)
        later = [(t, n, m) for t, n, m, _ in felt if t >= ended and (until is None or t < until)]
        pushes = [t - ended for t, n, m in later if n > 0 or m > 0]
        zeros = [t - ended for t, n, m in later if n == 0 and m == 0]
        self.assertTrue(zeros, name + ": no zero was sent")
        first = min(z for z in zeros if not pushes or z > max(pushes)) if not pushes or max(zeros) > max(pushes) else None
        self.assertIsNotNone(first, name + ": the last wrench is not zero")
        print("%-28s last wrench before %.3f N, zero after %4.1f ms" % (name, before[-1], 1e3 * first), flush=True)
        self.assertLess(first, limit_s, name)

    def signal_ends(self, number, status):
        with Session() as session:
            session.wait_touch()
            ended = time.monotonic()
            session.simulator.send_signal(number)
            felt = session.felt(1)
            self.assertZeroSoon(number.name, felt, ended)
            session.simulator.stdout.read()
            self.assertEqual(session.simulator.wait(END_LIMIT_S), status)

    def test_interrupt(self):
        self.signal_ends(signal.SIGINT, 0)

    def test_termination(self):
        self.signal_ends(signal.SIGTERM, 0)

    def test_hang_up(self):
        self.signal_ends(signal.SIGHUP, 0)

    def test_crash(self):
        self.signal_ends(signal.SIGSEGV, -signal.SIGSEGV)

    def test_abort(self):
        self.signal_ends(signal.SIGABRT, -signal.SIGABRT)

    def test_rosnode_kill(self):
        with Session() as session:
            session.wait_touch()
            ended = time.monotonic()
            import rosgraph
            from xmlrpc.client import ServerProxy
            uri = rosgraph.Master("/force_endings").lookupNode(session.space + "/simulator")
            ServerProxy(uri).shutdown("/force_endings", "test")
            self.assertZeroSoon("rosnode kill", session.felt(1), ended)
            session.simulator.stdout.read()
            self.assertEqual(session.simulator.wait(END_LIMIT_S), 0)

    def test_second_node_of_the_same_name(self):
        with Session() as session:
            session.wait_touch()
            second = session.node("simulator", SCENE)
            session.simulator.stdout.read()
            session.simulator.wait(END_LIMIT_S)
            felt = session.felt(0.2)
            # The second has not begun its ticks, or has: its hand is inside the tissue, and feels nothing.
            ended = max(t for t, n, _, _ in felt if n > 0)
            self.assertZeroSoon("second node of that name", felt, ended)
            self.assertIsNone(second.poll())

    def test_lost_master(self):
        with Session(own_master=True) as session:
            session.wait_touch()
            ended = time.monotonic()
            session.master.kill()
            session.master.wait(END_LIMIT_S)
            self.assertZeroSoon("lost master", session.felt(1), ended)
            session.simulator.stdout.read()
            self.assertEqual(session.simulator.wait(END_LIMIT_S), 1)

    def test_exception_in_a_thread(self):
        """Where there is no memory for pictures, whoever makes them throws."""
        with Session() as session:
            session.wait_touch()
            in_use = int(open("/proc/%d/statm" % session.simulator.pid).read().split()[0]) * resource.getpagesize()
            resource.prlimit(session.simulator.pid, resource.RLIMIT_AS, (in_use, in_use))
            begun = time.monotonic()
            session.start(["rostopic", "echo", "-n1", session.space + "/surface_marker"], stdout=subprocess.DEVNULL)
            output = session.simulator.stdout.read()
            status = session.simulator.wait(END_LIMIT_S)
            felt = session.felt(0)
            ended = max(t for t, n, _, _ in felt if n > 0)
            self.assertGreater(ended, begun)
            self.assertZeroSoon("exception in a thread", felt, ended)
            self.assertNotEqual(status, 0, output)

    def test_stall_of_three_seconds(self):
        with Session() as session:
            session.wait_touch()
            begun = stop_thread(session.simulator.pid, "simulation", 3)
            ended = time.monotonic()
            felt = session.felt(2)
            self.assertZeroSoon("stall of 3 s", felt, begun, until=ended, limit_s=STALL_LIMIT_S)
            self.assertGreater(felt[-1][1], 0)  # and the force comes back
            rises = [(a, b) for a, b in zip(felt, felt[1:]) if b[1] > a[1] and a[0] > ended]
            self.assertGreater(len(rises), 0)

    def test_killed_simulator_behind_a_watchdog(self):
        with Session(wrenches="watched") as session:
            watchdog = session.node("wrench_watchdog", "wrench_in:=left/body/servo_cf", "wrench_out:=watched",
                                    "_timeout_s:=0.03")
            session.wait_touch()
            ended = time.monotonic()
            session.simulator.kill()
            self.assertZeroSoon("kill -9, with watchdog", session.felt(1), ended)
            self.assertIsNone(watchdog.poll())

    def test_interrupt_while_the_model_is_made_ends_within_a_second(self):
        environment = dict(os.environ, ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
        path = roslib.packages.find_node("viscera", "simulator")[0]
        process = subprocess.Popen([path, "__name:=building", "_overrides:=bodies[0].spacing_m=0.0012"],
                                   env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        try:
            for line in process.stdout:
                if "preparing" in line:
                    break
            begun = time.monotonic()
            process.send_signal(signal.SIGINT)
            process.stdout.read()
            self.assertEqual(process.wait(END_LIMIT_S), 0)
            self.assertLess(time.monotonic() - begun, 1.2)  # a second, and what this process needs to see it
        finally:
            if process.poll() is None:
                process.kill()


if __name__ == "__main__":
    rostest.rosrun("viscera", "force_endings_test", ForceEndingsTest, sys.argv)
