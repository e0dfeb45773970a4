#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The Python package as users have it. Usage: module_test.py [VISCERA], the command that hashes are compared with."""
import contextlib
import gc
import io
import json
import os
import random
import subprocess
import sys
import threading
import time
import unittest
import weakref

import numpy as np

import viscera

COMMAND = sys.argv.pop(1) if len(sys.argv) > 1 and not sys.argv[1].startswith("-") else None
SMALL = {
    "name": "small",
    "bodies": [{"name": "block", "source": "box", "box_size_m": [0.06, 0.06, 0.03], "spacing_m": 0.01,
                "fixed": [{"shape": "box", "min_m": [-1, -1, -1], "max_m": [1, 1, -0.014]}]}],
    "styluses": [{"name": "left", "probe": {"radius_m": 0.012}}, {"name": "right"}],
    "solver": {"backend": "cpu", "threads": 1},
}
PRESSED = viscera.Stylus([0, 0, 0.02])


def small(**options):
    return viscera.Session(viscera.Scene(SMALL), **options)


def press(session, ticks):
    for tick in range(ticks):
        session.step([viscera.Stylus([0, 0, 0.03 - 0.01 * (tick + 1) / ticks])])


class SceneTest(unittest.TestCase):
    def test_text_dict_and_file_are_one(self):
        keys = viscera.Scene(SMALL).keys
        self.assertEqual(keys, viscera.Scene(json.dumps(SMALL) + "\n").keys)

    def test_shipped(self):
        scene = viscera.Scene("cloth_on_points", {"solver.threads": 1})
        self.assertIn("solver.threads=1", scene.keys)
        self.assertTrue(os.path.exists(scene.file))

    def test_errors_name_file_and_key(self):
        for source, said in (({"bodys": []}, "bodys"), ("name: x\nbodys: []\n", "bodys"), ("no_such", "no_such"),
                             ({"a": float("nan")}, "dict"), ({"a": object()}, "dict"), ("/no/such.yaml", "/no/such.yaml")):
            with self.assertRaisesRegex(viscera.SceneError, said):
                viscera.Scene(source)
        with self.assertRaisesRegex(viscera.Error, "solver.tick_hz"):
            viscera.Scene(SMALL, ["solver.tick_hz=-1"])
        with self.assertRaises(TypeError):
            viscera.Scene(5)

    @unittest.skipUnless(COMMAND, "no command given")
    def test_same_error_as_the_command_line(self):
        run = subprocess.run([COMMAND, "run", "heart", "--no-view", "--set", "solver.tick_hz=-1"], capture_output=True, text=True)
        with self.assertRaises(viscera.SceneError) as caught:
            viscera.Scene("heart", "solver.tick_hz=-1")
        self.assertIn(str(caught.exception).split(": ", 1)[1], run.stderr)


    def test_what_is_printed(self):
        self.assertRegex(viscera.__version__, r"^\d+\.\d+\.\d+$")
        stylus = viscera.Stylus([0, 0.25, -1], [0, 0, 1, 0], button2=True, jaw_rad=0.3)
        self.assertEqual(repr(stylus), "viscera.Stylus([0.0, 0.25, -1.0], [0.0, 0.0, 1.0, 0.0], button2=True, jaw_rad=0.3)")
        self.assertEqual(repr(eval(repr(stylus))), repr(stylus))
        with small() as session:
            session.step()
            self.assertRegex(repr(session), rf"^<viscera.Session of 'small', tick 1, {len(session.nodes)} nodes, cpu \(.*\)>$")
        self.assertEqual(repr(session), "<viscera.Session, closed>")
        self.assertEqual(repr(viscera.VectorSession(viscera.Scene(SMALL), 2)), "<viscera.VectorSession of 2 sessions>")
        for each in viscera.__all__:
            if each[0] != "_":
                self.assertEqual(getattr(viscera, each).__module__, "viscera")

    def test_first_example_of_the_docs(self):
        page = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "python.md")
        with open(page, encoding="utf-8") as text:
            lines = text.read().split("    import viscera\n", 1)[1].split("\n\n| call")[0].splitlines()
        space = {"viscera": viscera}
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            exec("\n".join(line[4:] for line in lines), space)
        self.assertGreaterEqual(len(printed.getvalue().splitlines()), 2)
        with viscera.Session(space["scene"]) as session:
            session.restore(space["saved"])
            session.step([viscera.Stylus(space["tip_m"])])
            self.assertGreater(session.contacts[0]["touched"], 0)
            self.assertGreater(session.wrenches[0, 2], 0.05)


class SessionTest(unittest.TestCase):
    @unittest.skipUnless(COMMAND, "no command given")
    def test_same_hash_as_the_command_line(self):
        run = subprocess.run([COMMAND, "run", "cloth_on_points", "--no-view", "--seconds", "0.5"], capture_output=True,
                             text=True, check=True)
        with viscera.Session(viscera.Scene("cloth_on_points")) as session:
            session.step(n=round(0.5 / session.tick_s))
            self.assertEqual(session.hash, json.loads(run.stdout.splitlines()[-1])["state_hash"])

    def test_restored_goes_on_to_the_bit(self):
        one, other = small(), small()
        press(one, 60)
        state = one.state()
        other.restore(state)
        self.assertEqual(other.tick, 60)
        self.assertEqual(one.hash, other.hash)
        for session in (one, other):
            session.step([PRESSED], n=1000)
        self.assertEqual(one.hash, other.hash)
        np.testing.assert_array_equal(one.wrenches, other.wrenches)

    def test_restore_refuses(self):
        session = small()
        session.step(n=3)
        state, before = session.state(), session.hash
        for wrong in (b"", b"x" * 100, state[:-1], state + b"x", state[:200] + b"\x00\x01" + state[202:]):
            with self.assertRaises(viscera.Error):
                session.restore(wrong)
        with self.assertRaisesRegex(viscera.Error, "another scene"):
            viscera.Session(viscera.Scene(SMALL, "solver.tick_hz=500")).restore(state)
        session.restore(state)
        self.assertEqual(session.hash, before)

    def test_reset(self):
        session = small()
        rest = session.hash
        press(session, 20)
        self.assertNotEqual(session.hash, rest)
        session.reset()
        self.assertEqual((session.hash, session.tick, session.time_s), (rest, 0, 0))
        self.assertFalse(session.wrenches.any())

    def test_forces_and_diagnostics(self):
        session = small()
        press(session, 60)
        self.assertEqual(session.wrenches.shape, (2, 6))
        self.assertGreater(session.wrenches[0, 2], 0)  # pushed out, up
        self.assertFalse(session.wrenches[1].any())
        self.assertEqual([c["kind"] for c in session.contacts], ["pushes", "free"])
        self.assertGreater(session.contacts[0]["touched"], 0)
        self.assertEqual(session.diagnostics["ticks"], 60)
        self.assertEqual(session.diagnostics["nonfinite"], 0)

    @unittest.skipUnless(COMMAND, "no command given")
    def test_diagnostics_are_named_as_the_metrics(self):
        """And mean the same."""
        run = subprocess.run([COMMAND, "run", "cloth_on_points", "--no-view", "--seconds", "0.2"], capture_output=True, text=True,
                             check=True)
        metrics = json.loads(run.stdout.splitlines()[-1])
        with viscera.Session(viscera.Scene("cloth_on_points")) as session:
            session.step(n=round(0.2 / session.tick_s))
            found = session.diagnostics
        others = {"ticks", "recovering", "strained", "kinetic_energy_j", "elastic_energy_j", "springs_collapsed", "cells_inverted",
                  "stretch_now", "speed_now_m_per_s"}
        self.assertEqual(set(found) - set(metrics), others)
        same = set(found) & set(metrics)
        self.assertEqual({key: found[key] for key in same}, {key: metrics[key] for key in same})

    def test_diagnostics_after_a_restored_cut(self):
        scene = viscera.Scene(SMALL, ["styluses[0].button2=cut"])
        with viscera.Session(scene) as session, viscera.Session(scene) as other:
            for tick in range(120):
                session.step([viscera.Stylus([-0.06 + 0.001 * tick, 0, 0.005], button2=True)])
            self.assertGreater(session.diagnostics["springs_cut"], 0)
            other.restore(session.state())
            self.assertEqual(other.diagnostics["springs_cut"], session.diagnostics["springs_cut"])

    def test_closed_raises(self):
        session = small()
        skin = session.skin().positions_m
        moved = session.displacement_m
        session.close()
        session.close()
        for call in (session.step, session.reset, session.state, session.skin, session.fields, session.picture,
                     lambda: session.restore(b""), lambda: session.hash, lambda: session.nodes, lambda: session.wrenches):
            with self.assertRaisesRegex(viscera.Error, "closed"):
                call()
        del session
        gc.collect()
        self.assertTrue(np.isfinite(skin).all() and np.isfinite(moved).all())

    def test_gil_is_released(self):
        session, counted, done = small(), [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                time.sleep(0)
        thread = threading.Thread(target=count)
        thread.start()
        # While a call holds the lock nothing is counted. On a busy machine the counter may get no turn in one call.
        during, deadline = 0, time.monotonic() + 30
        while during <= 10 and time.monotonic() < deadline:
            before = counted[0]
            session.step(n=2000)
            during = counted[0] - before
        done.set()
        thread.join()
        self.assertGreater(during, 10)

    def test_threads_wait_for_each_other(self):
        session = small()
        threads = [threading.Thread(target=lambda: [session.step() for _ in range(50)]) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(session.tick, 200)


class ArrayTest(unittest.TestCase):
    def test_skin_is_no_copy(self):
        session = small()
        skin = session.skin()
        for array in (skin.positions_m, skin.triangles, skin.packed_normals):
            self.assertIsInstance(array.base, memoryview)
            self.assertFalse(array.flags.writeable)
            with self.assertRaises(ValueError):
                array.flags.writeable = True
        self.assertEqual(skin.positions_m.ctypes.data, skin.positions_m.ctypes.data)
        self.assertLess(skin.triangles.max(), len(skin.positions_m))
        self.assertEqual(len(skin.wounds), len(skin.triangles))
        self.assertEqual(len(skin.bodies_of_triangles), len(skin.triangles))
        np.testing.assert_allclose(np.linalg.norm(skin.normals, axis=1), 1, atol=1 / 256)

    def test_array_keeps_its_skin_alive(self):
        skin = small().skin()
        alive, array = weakref.ref(skin), skin.positions_m
        del skin
        gc.collect()
        self.assertIsNotNone(alive())
        self.assertTrue(np.isfinite(array[:3]).all())
        del array
        gc.collect()
        self.assertIsNone(alive())

    def test_used_vertices_of_a_sheet(self):
        with viscera.Session(viscera.Scene("cloth_on_points")) as session:
            skin = session.skin()
        np.testing.assert_array_equal(skin.used, np.unique(skin.triangles))
        self.assertLess(len(skin.used), len(skin.positions_m))
        self.assertIn(f"{len(skin.used)} vertices", repr(skin))

    def test_nodes(self):
        session = small()
        press(session, 30)
        nodes = session.nodes
        self.assertEqual(len(nodes), session.diagnostics["nodes"])
        self.assertIs(session.displacement_m.ctypes.data == session.displacement_m.ctypes.data, True)
        np.testing.assert_allclose(session.positions_m[nodes], (session.rest_m + session.displacement_m)[nodes])
        self.assertTrue(np.isnan(np.delete(session.rest_m, nodes, axis=0)).all())
        self.assertEqual(session.velocity_m_per_s.shape, session.displacement_m.shape)
        before = session.displacement_m
        kept = before.copy()
        session.step(n=10)
        np.testing.assert_array_equal(before, kept)

    def test_stress(self):
        session = small()
        press(session, 60)
        fields = session.fields("lattice")
        self.assertEqual(fields["points_m"].shape[1], 3)
        self.assertTrue(fields["of_cells"])


class MisuseTest(unittest.TestCase):
    def test_wrong_poses(self):
        nan = float("nan")
        for wrong in ([0, 0], [[0, 0, 0]], [0, 0, nan], [0, 0, 1e300], np.zeros((3, 1)), 5):
            with self.assertRaises(ValueError):
                viscera.Stylus(wrong)
        for wrong in ([0, 0, 0, 0], [0, 0, 0, 2], [0, 0, 1], [nan] * 4):
            with self.assertRaises(ValueError):
                viscera.Stylus([0, 0, 0], wrong)

    def test_jaws_are_open_by_an_angle_or_unknown(self):
        self.assertIsNone(PRESSED.jaw_rad)
        self.assertEqual(viscera.Stylus([0, 0, 0], jaw_rad=0.5).jaw_rad, 0.5)
        for wrong in (-0.1, 4, float("nan")):
            with self.assertRaises(ValueError):
                viscera.Stylus([0, 0, 0], jaw_rad=wrong)

    def test_fuzz(self):
        """Whatever is called with whatever: an exception of ours or of Python's, or a result."""
        rng, session = random.Random(7), small()
        scene = viscera.Scene(SMALL)
        values = [None, 0, -1, 10 ** 30, 3.5, float("nan"), "", "auto", "lattice", "color", b"", b"x" * 99, [], [None] * 3, {},
                  object(), np.zeros(3), np.full(4, np.nan), np.zeros((2, 2), "O"), PRESSED, [PRESSED, None], scene, session, True]
        calls = [viscera.Stylus, viscera.Scene, viscera.Session, session.step, session.restore, session.fields,
                 session.picture, session.reset, session.state, session.skin, lambda *a: session.wrenches,
                 lambda *a: session.contacts, lambda *a: session.diagnostics, lambda *a: session.positions_m]
        raised = 0
        for _ in range(600):
            arguments = [rng.choice(values) for _ in range(rng.randrange(4))]
            try:
                rng.choice(calls)(*arguments)
            except (viscera.Error, TypeError, ValueError, OverflowError):
                raised += 1
        self.assertGreater(raised, 100)
        session.reset()
        session.step(n=5)
        other = small()
        other.step(n=5)
        self.assertEqual(session.hash, other.hash)


class OverheadTest(unittest.TestCase):
    def test_print_of_a_step(self):
        session, hands, ticks = small(), [viscera.Stylus([0, 0, 0.5])], 2000  # nothing moves: ticks take alike
        session.step(hands, n=ticks)
        each, together = [], []
        for _ in range(5):
            start = time.perf_counter()
            session.step(hands, n=ticks)
            together.append(time.perf_counter() - start)
            start = time.perf_counter()
            for _ in range(ticks):
                session.step(hands)
            each.append(time.perf_counter() - start)
        print(f"overhead of a step: {(min(each) - min(together)) / ticks * 1e6:.1f} us", file=sys.stderr)


if __name__ == "__main__":
    unittest.main()
