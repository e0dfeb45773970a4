# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A simulator and a stylus that is pressed into its tissue, for tests of the last force that the stylus receives."""
import itertools
import json
import os
import signal
import socket
import subprocess
import sys
import time
import unittest

import roslib.packages
from simulator_watch import wait_until
from tries import Late, in_one_of_several_tries

END_LIMIT_S = 30
ZERO_LIMIT_S = 0.05     # from the ending to the first zero, measured from outside
FELT_S = 0.4            # time after an ending in which late forces are recorded: eight times ZERO_LIMIT_S
FORCED_END_S = 1.2      # a second, and the time for this process to notice
TIMEOUT = "_timeout_s:=0.03"  # option of watchdogs
SUPPORT = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "support")
SCENE = "_scene:=" + os.path.join(SUPPORT, "front_wall.yaml")
TISSUE = "_overrides:=bodies[0].position_m=[0,-0.018,-0.02]"  # where the stylus receives 0.3 N
# The heart, for a test of its pictures.
HEART = ("_scene:=heart", "_overrides:=bodies[0].spacing_m=0.008;bodies[0].material.young_modulus_pa=20000;"
         "environment.gravity_m_per_s2=[0,0,0];styluses[0].probe.radius_m=0.012")
serial = itertools.count()


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


class Session:
    """A simulator and a stylus, optionally with a master of their own.
    kind: kind of the stylus's driver, a class of drivers.py with options for the simulator
    job: nodes are in process groups of their own, like a shell's jobs, so that signals of a terminal stop them"""

    def __init__(self, own_master=False, wrenches="left/body/servo_cf", kind=None, options=(), scene=(SCENE, TISSUE), job=False):
        self.job = job
        self.environment = dict(os.environ, ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
        self.processes = []
        self.master = None
        if own_master:
            port = free_port()
            self.environment["ROS_MASTER_URI"] = "http://localhost:%d" % port
            self.master = self.start(["rosmaster", "--core", "-p", str(port)])
        self.space = "/force_endings_%d" % next(serial)
        self.environment["ROS_NAMESPACE"] = self.space
        self.simulator = self.node("simulator", *scene, *options)
        # its interpreter starts while the tissue is created; it waits outside until then
        self.hand = self.start([sys.executable, os.path.join(SUPPORT, "stylus_device.py"), wrenches] + ([kind] if kind else []),
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        wait_ready(self.simulator)
        self.hand.stdin.write("press\n")
        self.hand.stdin.flush()

    def start(self, command, **how):
        process = subprocess.Popen(command, env=self.environment, **how)
        self.processes.append(process)
        return process

    def node(self, name, *arguments):
        path = roslib.packages.find_node("viscera", name)[0]
        return self.start([path] + list(arguments), text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          preexec_fn=os.setpgrp if self.job else None)

    def freeze_master(self, seconds=0):
        """From now on, the master keeps its connections and answers nothing."""
        self.master.send_signal(signal.SIGSTOP)
        time.sleep(seconds)

    def thaw_master(self):
        self.master.send_signal(signal.SIGCONT)

    def stop_by_terminal(self, process):
        """Sends SIGTSTP, as by Ctrl-Z. Returns after the process has stopped."""
        process.send_signal(signal.SIGTSTP)
        wait_until(lambda: state_of(process) == "T", END_LIMIT_S, "process that stands")

    def wait_touch(self):
        line = self.hand.stdout.readline()
        assert line == "touching\n", line

    def wait_let_go(self):
        line = self.hand.stdout.readline()
        assert line == "let go\n", line

    def felt(self, seconds):
        """Returns the forces that the stylus receives in the next `seconds`."""
        time.sleep(seconds)
        return json.loads(self.hand.communicate(timeout=END_LIMIT_S)[0].splitlines()[-1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.processes:
            if process.poll() is None:
                process.kill()
            process.wait(END_LIMIT_S)


def watched_session(**how):
    """Returns a session with a watchdog between its simulator and its stylus."""
    session = Session(wrenches="watched", **how)
    return session, session.node("wrench_watchdog", "wrench_in:=left/body/servo_cf", "wrench_out:=watched", TIMEOUT)


def state_of(process):
    """Returns the state of a process; T: stopped."""
    with open("/proc/%d/stat" % process.pid) as file:
        return file.read().rsplit(")", 1)[1].split()[0]


def wait_ready(process):
    for line in process.stdout:
        if "ready" in line:
            return
    raise AssertionError("the simulator ended before it was ready")


class ForceCase(unittest.TestCase):
    def __init_subclass__(cls):
        for name, test in list(vars(cls).items()):
            if name.startswith("test_"):
                setattr(cls, name, in_one_of_several_tries(test))

    def assertInTime(self, took_s, limit_s, name):
        if took_s >= limit_s:
            raise Late("%s: after %.4f s, wanted %.4f s" % (name, took_s, limit_s))

    def assertZeroSoon(self, name, felt, ended, until=None, limit_s=ZERO_LIMIT_S):
        """Asserts that there were forces before, and only zeros from limit_s after the ending on."""
        before = [n for t, n, _, _ in felt if t < ended]
        self.assertGreater(before[-1], 0, name)
        later = [(t, n, m) for t, n, m, _ in felt if t >= ended and (until is None or t < until)]
        pushes = [t - ended for t, n, m in later if n > 0 or m > 0]
        zeros = [t - ended for t, n, m in later if n == 0 and m == 0]
        self.assertTrue(zeros, name + ": no zero was sent")
        first = min(z for z in zeros if not pushes or z > max(pushes)) if not pushes or max(zeros) > max(pushes) else None
        self.assertIsNotNone(first, name + ": the last wrench is not zero")
        print("%-28s last wrench before %.3f N, zero after %4.1f ms" % (name, before[-1], 1e3 * first), flush=True)
        self.assertInTime(first, limit_s, name)
