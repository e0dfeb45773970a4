#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Scripts of examples/measure, as a user runs them."""
import os
import subprocess
import sys
import tempfile
import unittest

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "measure")
COARSE = ["--spacing-m", "0.004"]  # two cells to the sphere's radius: soon there, and forces off by a fifth


def run(script, *arguments):
    return subprocess.run([sys.executable, os.path.join(FOLDER, script), *arguments], capture_output=True, text=True, timeout=300)


class Measure(unittest.TestCase):
    def test_what_was_pressed_is_fitted(self):
        """E goes in, forces come out; forces go in, the same E comes out, to 1 %: both run the same physics."""
        with tempfile.TemporaryDirectory() as folder:
            pressed = run("press.py", *COARSE, "--young-pa", "7000", "--out", folder)
            self.assertEqual(pressed.returncode, 0, pressed.stderr)
            shares = [float(line.split()[-3]) for line in pressed.stdout.splitlines() if "Hertz" in line]
            self.assertEqual(len(shares), 5)
            # Hertz has small strains: at half the radius the law presses back harder.
            self.assertTrue(all(0.8 < share < 1.3 for share in shares), shares)
            fitted = run("fit_e.py", os.path.join(folder, "press.csv"), *COARSE)
            self.assertEqual(fitted.returncode, 0, fitted.stderr)
            self.assertAlmostEqual(float(fitted.stdout.split()[1]) / 7000, 1, delta=0.01)

    def test_fit_says_what_it_wants(self):
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "wrong.csv")
            with open(file, "w", encoding="utf-8") as text:
                text.write("depth_mm,force_n\n1,0.1\n0.5,nan\n")
            for name in (file, os.path.join(folder, "none.csv")):
                fitted = run("fit_e.py", name)
                self.assertNotEqual(fitted.returncode, 0)
                self.assertEqual(len(fitted.stderr.splitlines()), 1, fitted.stderr)
                self.assertIn(name, fitted.stderr)

    def test_sweep(self):
        swept = run("sweep.py", "--poisson", "0.25", "0.45", "--spacings-mm", "4")
        self.assertEqual(swept.returncode, 0, swept.stderr)
        rows = [line.split() for line in swept.stdout.splitlines()[1:]]
        self.assertEqual([row[0] for row in rows], ["0.25", "0.45"])
        self.assertLess(float(rows[0][2]), float(rows[1][2]))  # 1/(1 - nu^2)


if __name__ == "__main__":
    unittest.main()
