#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Vectors of sessions. Usage: vector_test.py, or vector_test.py --rate for a table of ticks per second."""
import random
import sys
import threading
import time
import unittest

import numpy as np

import viscera

SMALL = {
    "name": "small",
    "bodies": [{"name": "block", "source": "box", "box_size_m": [0.06, 0.06, 0.03], "spacing_m": 0.01,
                "fixed": [{"shape": "box", "min_m": [-1, -1, -1], "max_m": [1, 1, -0.014]}]}],
    "styluses": [{"name": "left", "probe": {"radius_m": 0.012}}, {"name": "right"}],
    "solver": {"backend": "cpu", "threads": 1},
}
SESSIONS = 5
TICKS = 60


def poses(tick, sessions=SESSIONS):
    """Of each session other ones: the left tip goes down above the block, the right is far off."""
    out = np.zeros((sessions, 2, 3))
    out[:, 0, 0] = 0.004 * np.arange(sessions)
    out[:, 0, 2] = 0.03 - 0.01 * (tick + 1) / TICKS
    out[:, 1] = 0.5
    return out


def pressed(**options):
    vector = viscera.VectorSession(viscera.Scene(SMALL), SESSIONS, **options)
    for tick in range(TICKS):
        vector.step(poses(tick))
    return vector


class VectorTest(unittest.TestCase):
    def test_each_is_as_alone(self):
        vector = pressed()
        self.assertEqual(len(set(vector.hashes)), SESSIONS)
        for s in range(SESSIONS):
            with viscera.Session(viscera.Scene(SMALL)) as alone:
                for tick in range(TICKS):
                    alone.step([viscera.Stylus(place) for place in poses(tick)[s]])
                self.assertEqual(alone.hash, vector.hashes[s])
                for name in ("wrenches", "positions_m", "displacement_m", "velocity_m_per_s"):
                    np.testing.assert_array_equal(getattr(alone, name), getattr(vector, name)[s])
                self.assertEqual([c["touched"] for c in alone.contacts], vector.touched[s].tolist())
        self.assertTrue((vector.wrenches[:, 0, 2] > 0).all())
        self.assertFalse(vector.rollbacks.any() or vector.held.any())

    def test_threads_change_nothing(self):
        self.assertEqual(pressed(threads=1).hashes, pressed(threads=3).hashes)

    def test_one_of_them(self):
        vector = viscera.VectorSession(viscera.Scene(SMALL), 3)
        vector[1].step(n=4)
        self.assertEqual(vector.ticks.tolist(), [0, 4, 0])
        vector.step(n=np.array([1, 2, 0]))
        self.assertEqual(vector.ticks.tolist(), [1, 6, 0])
        last = vector[-1]
        last.close()
        self.assertEqual(vector[-1].tick, 0)
        for wrong in (3, -4):
            with self.assertRaises(IndexError):
                vector[wrong]
        self.assertEqual(len(list(vector)), 3)

    def test_resets_its_own(self):
        vector = pressed()
        before, rest = vector.hashes, viscera.Session(viscera.Scene(SMALL)).hash
        which = np.array([False, True, False, False, True])
        vector.reset(which)
        self.assertEqual(vector.hashes, [rest if w else h for w, h in zip(which, before)])
        self.assertFalse(vector.wrenches[which].any())
        state = vector[0].state()
        vector.restore(state, which)
        self.assertEqual(vector.hashes, [before[0] if w else h for w, h in zip(which, before)])
        with self.assertRaisesRegex(viscera.Error, "session 0: "):
            vector.restore(state[:-1], np.array([True, False, False, False, False]))

    def test_buttons_and_absence(self):
        vector = viscera.VectorSession(viscera.Scene(SMALL, {"styluses[0].grab.radius_m": 0.012}), 3)
        places = np.zeros((3, 2, 7))
        places[..., 6] = 1
        places[:, 0, 2] = 0.015
        buttons = np.zeros((3, 2, 2), bool)
        buttons[1:, 0, 0] = True
        present = np.array([[True, False], [True, False], [False, False]])
        vector.step(places, buttons, present)
        self.assertEqual((vector.held[:, 0] > 0).tolist(), [False, True, False])

    def test_misuse(self):
        vector, nan = viscera.VectorSession(viscera.Scene(SMALL), 2), float("nan")
        before = vector.hashes
        for wrong in (np.zeros((2, 2)), np.zeros((2, 1, 3)), np.zeros((3, 2, 3)), np.full((2, 2, 3), nan),
                      np.zeros((2, 2, 7)), np.full((2, 2, 3), 1e9), []):
            with self.assertRaises(ValueError):
                vector.step(wrong)
        good = np.zeros((2, 2, 3))
        for wrong in ("x", object(), {}):
            with self.assertRaises(TypeError):
                vector.step(wrong)
        for options in ({"buttons": np.zeros((2, 2, 2), bool), "poses": None}, {"buttons": np.zeros((2, 2), bool)},
                        {"present": np.ones(2, bool)}, {"n": -1}, {"n": 10 ** 12}, {"n": np.array([1])}, {"n": np.array([1, -1])}):
            with self.assertRaises(ValueError):
                vector.step(**{"poses": good, **options})
        for options in ({"buttons": np.zeros((2, 2, 2))}, {"present": "x"}, {"n": 1.5}, {"n": None}):
            with self.assertRaises(TypeError):
                vector.step(good, **options)
        for wrong in (0, -1, 10 ** 6):
            with self.assertRaises(ValueError):
                viscera.VectorSession(viscera.Scene(SMALL), wrong)
        self.assertEqual(vector.hashes, before)
        one = vector[0]
        vector.close()
        for call in (vector.step, vector.reset, lambda: vector.hashes, lambda: vector[0], lambda: len(vector),
                     lambda: vector.restore(b""), lambda: vector.wrenches):
            with self.assertRaisesRegex(viscera.Error, "closed"):
                call()
        one.step()

    def test_fuzz(self):
        """Whatever is called with whatever: an exception of ours or of Python's, or a result."""
        rng, vector = random.Random(11), viscera.VectorSession(viscera.Scene(SMALL), 2)
        values = [None, 0, 1, -1, 10 ** 30, 2.5, float("nan"), "", b"", b"x" * 99, [], [True, False], [[True] * 2] * 2, {},
                  object(), np.zeros((2, 2, 3)), np.ones((2, 2, 7)), np.zeros((2, 2, 2), bool), np.zeros(3), np.array([1, 2]),
                  np.zeros((2, 2, 3), "O"), np.zeros((0, 2, 3)), vector, vector[0].state()]
        calls = [vector.step, vector.step, vector.reset, vector.restore, vector.__getitem__, lambda *a: vector.wrenches,
                 lambda *a: vector.positions_m, lambda *a: viscera.VectorSession(viscera.Scene(SMALL), *a)]
        raised = 0
        for _ in range(1400):
            try:
                rng.choice(calls)(*[rng.choice(values) for _ in range(rng.randrange(4))])
            except (viscera.Error, TypeError, ValueError, OverflowError, IndexError):
                raised += 1
        self.assertGreater(raised, 300)
        vector.reset()
        vector.step(n=5)
        self.assertEqual(vector.hashes, [viscera_hash(5)] * 2)

    def test_threads_and_close(self):
        vector = viscera.VectorSession(viscera.Scene(SMALL), 3)
        threads = [threading.Thread(target=lambda: [vector.step() for _ in range(50)]) for _ in range(3)]
        threads += [threading.Thread(target=lambda: [vector[1].step() for _ in range(50)])]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(vector.ticks.tolist(), [150, 200, 150])
        thread = threading.Thread(target=lambda: vector.step(n=3000))
        thread.start()
        time.sleep(0.01)
        vector.close()
        thread.join()


def viscera_hash(ticks):
    session = viscera.Session(viscera.Scene(SMALL))
    session.step(n=ticks)
    return session.hash


def rates():
    """Ticks per second of all sessions together: with Python between the ticks, and of the loop in C++ alone."""
    print("| sessions | nodes | step(poses), ticks/s | C++, ticks/s | of it |\n|---|---|---|---|---|")
    for spacing in (0.01, 0.004):
        for sessions in (1, 2, 4, 8):
            vector = viscera.VectorSession(viscera.Scene(SMALL, {"bodies[0].spacing_m": spacing}), sessions)
            for tick in range(TICKS):
                vector.step(poses(tick, sessions))
            held, ticks = poses(TICKS - 1, sessions), max(1, int((60 if spacing > 0.005 else 20) * 8 / sessions))
            each, together = [], []
            for _ in range(7):
                start = time.perf_counter()
                for _ in range(ticks):
                    vector.step(held)
                each.append(time.perf_counter() - start)
                start = time.perf_counter()
                vector.step(held, n=ticks)
                together.append(time.perf_counter() - start)
            of = np.median(together) / np.median(each)
            print(f"| {sessions} | {len(vector[0].nodes)} | {sessions * ticks / np.median(each):.0f} | "
                  f"{sessions * ticks / np.median(together):.0f} | {of:.2f} |", flush=True)


if __name__ == "__main__":
    if sys.argv[1:] == ["--rate"]:
        rates()
    else:
        unittest.main()
