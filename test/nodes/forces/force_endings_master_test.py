#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A master that hangs delays neither zeros nor the end: roscpp waits for its answers without limit."""
import signal
import sys
import time

import rostest
from force_session import END_LIMIT_S, FORCED_END_S, ForceCase, Session, watched_session

FROZEN_S = 1.5          # time since the master stopped answering: a query is in progress
PATIENCE_S = 8.0        # time after which a master that does not answer counts as lost


class ForceEndingsMasterTest(ForceCase):
    def test_interrupt_with_a_frozen_master(self):
        with Session(own_master=True) as session:
            session.wait_touch()
            session.freeze_master(FROZEN_S)
            ended = time.monotonic()
            session.simulator.send_signal(signal.SIGINT)
            session.simulator.stdout.read()
            self.assertEqual(session.simulator.wait(END_LIMIT_S), 0)
            took_s = time.monotonic() - ended
            session.thaw_master()
            self.assertZeroSoon("frozen master, interrupt", session.felt(0.1), ended)
            self.assertInTime(took_s, FORCED_END_S, "frozen master, interrupt")

    def test_killed_simulator_with_a_frozen_master(self):
        session, watchdog = watched_session(own_master=True)
        with session:
            session.wait_touch()
            session.freeze_master(FROZEN_S)
            ended = time.monotonic()
            session.simulator.kill()
            time.sleep(1)
            session.thaw_master()
            self.assertZeroSoon("frozen master, kill -9, watchdog", session.felt(0.1), ended)
            self.assertIsNone(watchdog.poll())

    def test_interrupted_watchdog_with_a_frozen_master(self):
        session, watchdog = watched_session(own_master=True)
        with session:
            session.wait_touch()
            session.freeze_master(FROZEN_S)
            ended = time.monotonic()
            watchdog.send_signal(signal.SIGINT)
            self.assertEqual(watchdog.wait(END_LIMIT_S), 0)
            session.thaw_master()
            self.assertZeroSoon("frozen master, interrupted watchdog", session.felt(0.1), ended)

    def test_master_that_stays_frozen_ends_simulator_and_watchdog(self):
        session, watchdog = watched_session(own_master=True)
        with session:
            session.wait_touch()
            session.freeze_master()
            begun = time.monotonic()
            said = [node.communicate(timeout=END_LIMIT_S)[0] for node in (session.simulator, watchdog)]
            self.assertInTime(time.monotonic() - begun, PATIENCE_S, "frozen master")
            session.thaw_master()
            felt = session.felt(0.1)
            ended = max(t for t, n, _, _ in felt if n > 0)  # the first of the two, by its own clock
            self.assertGreater(ended, begun)
            self.assertZeroSoon("frozen master", felt, ended)
            for node, text in zip((session.simulator, watchdog), said):
                self.assertEqual(node.returncode, 1, text)
                self.assertEqual(text.count("master is lost"), 1, text)


if __name__ == "__main__":
    rostest.rosrun("viscera", "force_endings_master_test", ForceEndingsMasterTest, sys.argv)
