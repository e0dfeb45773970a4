#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Sessions with OpenGL, several of them in one thread and one of them in several."""
import ctypes
import ctypes.util
import threading
import unittest

import numpy as np

import viscera

SMALL = {
    "name": "small",
    "bodies": [{"name": "block", "source": "box", "box_size_m": [0.04, 0.04, 0.03], "spacing_m": 0.01,
                "fixed": [{"shape": "box", "min_m": [-1, -1, -1], "max_m": [1, 1, -0.014]}]}],
    "styluses": [{"name": "left", "probe": {"radius_m": 0.012}}],
    "cameras": [{"name": "camera", "position_m": [0, -0.1, 0.1], "target_m": [0, 0, 0], "width_px": 48, "height_px": 32}],
    "solver": {"threads": 1, "integrator": "leapfrog"},
}
TICKS = 30
EGL = ctypes.CDLL(ctypes.util.find_library("EGL") or "libEGL.so.1")
EGL.eglGetCurrentContext.restype = ctypes.c_void_p


def made(**options):
    return viscera.Session(viscera.Scene(SMALL), **options)


def press(session, ticks=TICKS):
    for tick in range(ticks):
        session.step([viscera.Stylus([0, 0, 0.03 - 0.01 * (tick + 1) / TICKS])])


class ContextsTest(unittest.TestCase):
    def tearDown(self):
        self.assertIsNone(EGL.eglGetCurrentContext(), "a call has left a context behind")

    def test_what_one_does_the_others_do_not_see(self):
        alone = made(backend="gpu")
        press(alone)
        hashed = alone.hash
        alone.close()
        still, pressed, shown = made(backend="gpu"), made(backend="gpu"), made(backend="cpu", pictures=True)
        rest, picture = still.hash, shown.picture()
        press(pressed)
        self.assertEqual((still.hash, pressed.hash), (rest, hashed))
        self.assertFalse(still.displacement_m.any())
        self.assertTrue(pressed.displacement_m.any())
        np.testing.assert_array_equal(shown.picture(), picture)
        state = pressed.state()
        pressed.close()
        still.restore(state)
        self.assertEqual(still.hash, hashed)
        still.skin()
        still.reset()
        self.assertEqual(still.hash, rest)

    def test_a_name_bound_anew(self):
        hashes = set()
        for _ in range(3):
            session = made(backend="gpu")
            press(session, 5)
            hashes.add(session.hash)
        self.assertEqual(len(hashes), 1)

    def test_any_thread(self):
        for options in ({"backend": "gpu"}, {"backend": "cpu", "pictures": True}):
            one, other = made(**options), made(**options)
            press(one)
            look = other.picture if "pictures" in options else other.skin
            threads = [threading.Thread(target=press, args=(other,)), threading.Thread(target=look)]
            for thread in threads:
                thread.start()
                thread.join()
            self.assertEqual(one.hash, other.hash)
            closing = threading.Thread(target=other.close)
            closing.start()
            closing.join()
            press(one, 2)


if __name__ == "__main__":
    unittest.main()
