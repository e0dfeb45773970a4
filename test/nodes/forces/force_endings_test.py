#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""However a session ends or hangs, the last force sent to a device is zero, and it is sent soon. Each ending is caused
from outside. A simulated stylus (stylus_device.py) is pressed into the tissue and records the forces that it receives."""
import os
import resource
import signal
import subprocess
import sys
import time
import unittest

import roslib.packages
import rostest
from force_session import END_LIMIT_S, FELT_S, FORCED_END_S, SCENE, TISSUE, ForceCase, Session


SILENT_MASTER_S = 6.0   # master_watch.cpp waits 5 s
AGAIN_S = 1.0           # time in which the loss of a master is noticed
# Signals that one table of end_watch.cpp handles alike: the long form sends each of them.
LONG = unittest.skipUnless("VISCERA_EVERY_SIGNAL" in os.environ, "a signal of the same kind is sent by another test")


class ForceEndingsTest(ForceCase):
    def signal_ends(self, number, status):
        with Session() as session:
            session.wait_touch()
            resource.prlimit(session.simulator.pid, resource.RLIMIT_CORE, (0, 0))  # this crash is intended
            ended = time.monotonic()
            session.simulator.send_signal(number)
            felt = session.felt(FELT_S)
            self.assertZeroSoon(number.name, felt, ended)
            session.simulator.stdout.read()
            self.assertEqual(session.simulator.wait(END_LIMIT_S), status)

    def test_interrupt(self):
        self.signal_ends(signal.SIGINT, 0)

    @LONG
    def test_termination(self):
        self.signal_ends(signal.SIGTERM, 0)

    @LONG
    def test_hang_up(self):
        self.signal_ends(signal.SIGHUP, 0)

    def test_stopped_by_the_terminal_and_continued(self):
        """Stopped for longer than a master may be silent: the session continues."""
        with Session(job=True) as session:
            session.wait_touch()
            stopped = time.monotonic()
            session.stop_by_terminal(session.simulator)
            time.sleep(SILENT_MASTER_S)
            continued = time.monotonic()
            session.simulator.send_signal(signal.SIGCONT)
            felt = session.felt(FELT_S)
            self.assertZeroSoon("SIGTSTP", felt, stopped, until=continued)
            time.sleep(AGAIN_S)
            self.assertIsNone(session.simulator.poll())
            session.simulator.send_signal(signal.SIGINT)
            session.simulator.stdout.read()
            self.assertEqual(session.simulator.wait(END_LIMIT_S), 0)

    def test_crash(self):
        self.signal_ends(signal.SIGSEGV, -signal.SIGSEGV)

    @LONG
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
            self.assertZeroSoon("rosnode kill", session.felt(FELT_S), ended)
            session.simulator.stdout.read()
            self.assertEqual(session.simulator.wait(END_LIMIT_S), 0)

    def test_second_node_of_the_same_name(self):
        with Session() as session:
            session.wait_touch()
            second = session.node("simulator", SCENE, TISSUE)
            session.simulator.stdout.read()
            session.simulator.wait(END_LIMIT_S)
            felt = session.felt(0.2)
            # The second may have begun its ticks or not: its stylus is inside the tissue, and feels nothing.
            ended = max(t for t, n, _, _ in felt if n > 0)
            self.assertZeroSoon("second node of that name", felt, ended)
            self.assertIsNone(second.poll())

    def test_lost_master(self):
        with Session(own_master=True) as session:
            session.wait_touch()
            ended = time.monotonic()
            session.master.kill()
            session.master.wait(END_LIMIT_S)
            self.assertZeroSoon("lost master", session.felt(FELT_S), ended)
            session.simulator.stdout.read()
            self.assertEqual(session.simulator.wait(END_LIMIT_S), 1)

    def test_exception_in_a_thread(self):
        """Creating images throws if there is no memory for them."""
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
            self.assertInTime(time.monotonic() - begun, FORCED_END_S, "interrupt while the model is made")
        finally:
            if process.poll() is None:
                process.kill()


if __name__ == "__main__":
    rostest.rosrun("viscera", "force_endings_test", ForceEndingsTest, sys.argv)
