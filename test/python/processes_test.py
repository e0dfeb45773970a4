#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sessions beside signal handlers, and in processes that were forked."""
import faulthandler
import glob
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import time
import traceback
import unittest

import viscera

SMALL = {
    "name": "small",
    "bodies": [{"name": "block", "source": "box", "box_size_m": [0.06, 0.06, 0.03], "spacing_m": 0.01,
                "fixed": [{"shape": "box", "min_m": [-1, -1, -1], "max_m": [1, 1, -0.014]}]}],
    "styluses": [{"name": "left", "probe": {"radius_m": 0.012}}, {"name": "right"}],
    "solver": {"backend": "cpu", "threads": 2},
}
PRESSED = viscera.Stylus([0, 0, 0.02])
LONGEST_S = 60  # of what takes less than one; a hang otherwise
KEPT = None  # what a child finds


def small(**options):
    return viscera.Session(viscera.Scene(SMALL), **options)


def stepped_hash(ticks=20):
    with small() as session:
        session.step(n=ticks)
        return session.hash


def use_kept(_):
    return KEPT.tick


class Guarded(unittest.TestCase):
    def setUp(self):
        faulthandler.dump_traceback_later(3 * LONGEST_S, exit=True)

    def tearDown(self):
        faulthandler.cancel_dump_traceback_later()


class SignalTest(Guarded):
    def interrupted(self, handler, step):
        """Runs a step during which a handler is called several times."""
        before = signal.signal(signal.SIGALRM, handler)
        signal.setitimer(signal.ITIMER_REAL, 0.02, 0.02)
        try:
            step()
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)

    def test_handlers_use_the_session(self):
        session, seen = small(), []

        def handler(*_):
            seen.append((session.tick, session.hash, session.positions_m.shape, session.diagnostics["ticks"], repr(session)))
        ticks = 2000
        self.interrupted(handler, lambda: session.step([PRESSED], n=ticks))
        while not seen:  # on a machine that is faster than this
            ticks *= 4
            session.reset()
            self.interrupted(handler, lambda: session.step([PRESSED], n=ticks))
        self.assertGreater(seen[0][0], 0)
        other = small()
        other.step([PRESSED], n=ticks)
        self.assertEqual(session.hash, other.hash)
        self.assertEqual((session.positions_m != other.positions_m).sum(), (session.positions_m != session.positions_m).sum())

    def test_handlers_may_close_it(self):
        session = small()
        with self.assertRaisesRegex(viscera.Error, "closed during"):
            self.interrupted(lambda *_: session.close(), lambda: session.step(n=10 ** 8))
        self.assertTrue(session.closed)

    def test_handlers_use_a_vector(self):
        vector, seen = viscera.VectorSession(viscera.Scene(SMALL), 3), []

        def handler(*_):
            if len(seen) < 3:
                seen.append((vector.ticks, vector[1].hash))
            else:
                vector.close()
        with self.assertRaisesRegex(viscera.Error, "closed during"):
            self.interrupted(handler, lambda: vector.step(n=10 ** 8))

    def test_what_handlers_raise_ends_the_step(self):
        session, raised = small(), []

        def handler(*_):
            if not raised:
                raised.append(session.tick)
                raise KeyError
        with self.assertRaises(KeyError):
            self.interrupted(handler, lambda: session.step(n=10 ** 8))
        session.step()


class ForkTest(Guarded):
    def in_child(self, work):
        """Exit status of a forked process in which this is done; -1: it hangs."""
        child = os.fork()
        if child == 0:
            status = 1
            try:
                work()
                status = 0
            except BaseException:
                traceback.print_exc()
            finally:
                os._exit(status)
        end = time.monotonic() + LONGEST_S
        while time.monotonic() < end:
            pid, status = os.waitpid(child, os.WNOHANG)
            if pid:
                return status
            time.sleep(0.01)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        return -1

    def test_a_child_lets_go_of_what_is_not_its_own(self):
        expected, kept = stepped_hash(), {"session": small(), "vector": viscera.VectorSession(viscera.Scene(SMALL), 3, threads=2)}
        one = kept["vector"][0]
        for session in (kept["session"], kept["vector"]):
            session.step(n=3)

        def child():
            for use in (lambda: kept["session"].tick, kept["session"].step, lambda: kept["vector"].ticks, kept["vector"].step,
                        lambda: one.tick, lambda: kept["vector"][0]):
                try:
                    use()
                    raise AssertionError("it was used")
                except viscera.Error as error:
                    assert "spawn" in str(error) and str(os.getppid()) in str(error), error
            assert "spawn" in repr(kept["session"])
            kept["session"].close()
            kept["vector"] = None
            kept["session"] = small()
            kept["session"].step(n=20)
            assert kept["session"].hash == expected
        self.assertEqual(self.in_child(child), 0)
        self.assertEqual(kept["session"].tick, 3)
        kept["session"].step()

    def test_pools_that_fork_say_so(self):
        global KEPT
        KEPT = small()
        with multiprocessing.get_context("fork").Pool(1) as pool:
            with self.assertRaisesRegex(viscera.Error, "spawn"):
                pool.map_async(use_kept, [0]).get(LONGEST_S)
            self.assertEqual(pool.apply_async(stepped_hash).get(LONGEST_S), stepped_hash())
        KEPT = None

    def test_opengl_is_of_one_process(self):
        text = f"""
import os, viscera
scene = viscera.Scene({SMALL!r}, "solver.integrator=leapfrog")
session = viscera.Session(scene, backend="gpu")
session.step()
child = os.fork()
if child == 0:
    try:
        viscera.Session(scene, backend="gpu")
    except viscera.GpuError as error:
        assert "spawn" in str(error), error
        session.close()
        session = viscera.Session(scene, backend="cpu")
        session.step()
        os._exit(0)
    os._exit(1)
assert os.waitpid(child, 0)[1] == 0
session.step()
"""
        subprocess.run([sys.executable, "-c", text], check=True, timeout=3 * LONGEST_S)


class StateTest(Guarded):
    def test_states_leave_no_files(self):
        """Also where a process is killed."""
        def files():
            return set(glob.glob("/dev/shm/viscera*") + glob.glob("/tmp/viscera-*"))
        before = files()
        text = f"import viscera\nsession = viscera.Session(viscera.Scene({SMALL!r}))\nprint('made', flush=True)\n" \
               "while True:\n    session.restore(session.state())\n"
        for _ in range(3):
            process = subprocess.Popen([sys.executable, "-c", text], stdout=subprocess.PIPE)
            process.stdout.readline()
            time.sleep(0.1)
            process.kill()
            process.wait()
            process.stdout.close()
        self.assertEqual(files() - before, set())

    def test_errors_are_those_of_the_package(self):
        error = pickle.loads(pickle.dumps(viscera.SceneError("text")))
        self.assertIs(type(error), viscera.SceneError)
        self.assertEqual((viscera.Error.__module__, str(error)), ("viscera", "text"))


if __name__ == "__main__":
    unittest.main()
