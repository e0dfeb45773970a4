#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A watchdog handles endings that the simulator cannot, such as kill -9: drivers of all kinds that keep the last force
receive zero soon."""
import os
import signal
import sys
import time
import unittest

import rostest
from force_session import END_LIMIT_S, FELT_S, TIMEOUT, ZERO_LIMIT_S, ForceCase, Session, watched_session

RESTART_LIMIT_S = 5.0
# profile of the stylus, and the topic to which its driver subscribes
DRIVERS = {"PhantomOmni": ("phantom_omni", "phantom/force_feedback"),
           "Geomagic": ("geomagic", "Geomagic/force_feedback"),
           "BarePose": ("pose", "left/wrench")}


class ForceEndingsWatchdogTest(ForceCase):
    def kill_behind(self, kind):
        """The simulator publishes on a topic of its own, and the watchdog on the driver's."""
        profile, topic = DRIVERS[kind]
        options = ["_devices:=left=" + profile, "_device_options:=left.force.topic=unwatched"]
        with Session(kind=kind, options=options) as session:
            watchdog = session.node("wrench_watchdog", "_device:=" + profile, "wrench_in:=unwatched",
                                    "wrench_out:=" + topic, TIMEOUT)
            session.wait_touch()
            ended = time.monotonic()
            session.simulator.kill()
            self.assertZeroSoon("kill -9, %s, watchdog" % profile, session.felt(FELT_S), ended)
            self.assertIsNone(watchdog.poll())

    def test_killed_simulator(self):
        session, watchdog = watched_session()
        with session:
            session.wait_touch()
            ended = time.monotonic()
            session.simulator.kill()
            self.assertZeroSoon("kill -9, watchdog", session.felt(FELT_S), ended)
            self.assertIsNone(watchdog.poll())

    def test_watchdog_stopped_by_the_terminal_and_continued(self):
        session, watchdog = watched_session(job=True)
        with session:
            session.wait_touch()
            stopped = time.monotonic()
            session.stop_by_terminal(watchdog)
            time.sleep(FELT_S)
            continued = time.monotonic()
            watchdog.send_signal(signal.SIGCONT)
            felt = session.felt(FELT_S)
            self.assertZeroSoon("SIGTSTP, watchdog", felt, stopped, until=continued)
            self.assertGreater(max(n for t, n, _, _ in felt if t > continued), 0, "forces come again")

    def test_killed_simulator_and_omni_feedback(self):
        self.kill_behind("PhantomOmni")

    @unittest.skipUnless("VISCERA_EVERY_DRIVER" in os.environ, "phantom_omni's messages have a force alone too")
    def test_killed_simulator_and_geomagic_feedback(self):
        self.kill_behind("Geomagic")

    def test_killed_simulator_and_bare_wrenches(self):
        self.kill_behind("BarePose")

    def test_killed_watchdog_leaves_the_force_until_it_is_started_again(self):
        session, watchdog = watched_session()
        with session:
            session.wait_touch()
            watchdog.kill()
            watchdog.wait(END_LIMIT_S)
            session.simulator.kill()
            time.sleep(ZERO_LIMIT_S)
            again = time.monotonic()
            session.node("wrench_watchdog", "wrench_in:=left/body/servo_cf", "wrench_out:=watched", TIMEOUT)
            session.wait_let_go()
            self.assertZeroSoon("watchdog started again", session.felt(FELT_S), again, limit_s=RESTART_LIMIT_S)


if __name__ == "__main__":
    rostest.rosrun("viscera", "force_endings_watchdog_test", ForceEndingsWatchdogTest, sys.argv)
