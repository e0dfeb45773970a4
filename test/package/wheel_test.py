#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The wheel, installed by pip into an empty folder: wheel_test.py PACKAGE_FOLDER COMMAND WORK.

NumPy 2 is not to be had from Debian: a stand-in has the names that NumPy 2 moved and removed, and its copy=False.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

PACKAGE, COMMAND, WORK = (pathlib.Path(text).resolve() for text in sys.argv[1:4])
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MOST_MB = 30
SECONDS = 0.1
STEP = """
import os, viscera
environment = dict(os.environ)
with viscera.Session(viscera.Scene("practice_pad")) as session:
    session.step(n=round(%r / session.tick_s))
    skin = session.skin()
    print(session.hash, viscera.__file__)
assert dict(os.environ) == environment
with open("/proc/self/maps") as maps:
    print(*sorted({line.split()[-1] for line in maps if ".so" in line and "/numpy" not in line}))
""" % SECONDS
AS_NUMPY_2 = """
import sys
import numpy
for name in ("NaN", "Inf", "infty", "PINF", "NINF", "float_", "complex_", "unicode_", "string_", "product", "cumproduct", "alltrue",
             "sometrue", "in1d", "row_stack", "cast", "find_common_type", "issubsctype", "mat", "safe_eval", "asfarray", "core"):
    if name in vars(numpy):
        delattr(numpy, name)
array = numpy.array
def array_2(given, *types, copy=True, **options):
    if copy is False and not isinstance(given, numpy.ndarray):
        raise ValueError("Unable to avoid copy while creating an array as requested.")
    return array(given, *types, copy=copy, **options)
numpy.array = array_2
for name in [name for name in sys.modules if name == "numpy.core" or name.startswith("numpy.core.")]:
    sys.modules[name.replace("numpy.core", "numpy._core")] = sys.modules[name]
class Moved:  # NumPy 1 itself needs the rest of numpy.core
    def find_spec(self, name, path=None, target=None):
        if name == "numpy.core.multiarray":
            raise ImportError(name + " is in numpy._core")
del sys.modules["numpy.core.multiarray"]
sys.meta_path.insert(0, Moved())
numpy.__version__ = "2.0.0"
"""


def printed(text, **environment):
    """Returns the output of a Python program that finds the wheel's package, and nothing of a build or of ROS."""
    ran = subprocess.run(["/usr/bin/python3", "-B", "-c", text], capture_output=True, text=True, cwd="/", timeout=300,
                         env={"PATH": "/usr/bin:/bin", "HOME": str(WORK), "PYTHONPATH": str(WORK / "site"), **environment})
    if ran.returncode:
        raise AssertionError(ran.stdout + ran.stderr)
    return ran.stdout


class WheelTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(WORK, ignore_errors=True)
        WORK.mkdir(parents=True)
        subprocess.run(["/usr/bin/python3", str(ROOT / "scripts/packaging/wheel"), str(ROOT), str(PACKAGE), str(WORK)], check=True)
        (cls.wheel,) = WORK.glob("*.whl")
        subprocess.run(["/usr/bin/python3", "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", "--target", str(WORK / "site"),
                        str(cls.wheel)], check=True, env={"PATH": "/usr/bin:/bin", "HOME": str(WORK)})

    def test_size(self):
        self.assertLess(self.wheel.stat().st_size, MOST_MB * 2**20)

    def test_steps_as_the_command_does_with_libraries_of_its_own(self):
        ran = subprocess.run([str(COMMAND), "run", "practice_pad", "--no-view", "--seconds", str(SECONDS)], check=True, capture_output=True, text=True)
        first, libraries = printed(STEP).strip().split("\n")
        state, place = first.split()
        self.assertEqual(state, json.loads(ran.stdout.strip().split("\n")[-1])["state_hash"])
        self.assertEqual(place, str(WORK / "site/viscera/__init__.py"))
        of_wheel = [file for file in libraries.split() if file.startswith(str(WORK))]
        self.assertTrue(any("libopenvdb-" in file for file in of_wheel), libraries)
        for name in ("openvdb", "assimp", "yaml-cpp", "hwy", "tbb"):
            self.assertFalse([file for file in libraries.split() if f"/lib{name}" in file and file not in of_wheel], libraries)

    def test_driver_libraries_are_those_of_the_machine_where_it_has_them(self):
        _, libraries = printed(STEP).strip().split("\n")
        self.assertFalse([file for file in libraries.split() if "fallback" in file])
        order = (WORK / "site/viscera/libraries/fallback/order.txt").read_text().split()
        self.assertLess(order.index("libGLdispatch.so.0"), order.index("libOpenGL.so.0"))

    def test_knows_no_binary_interface_of_numpy(self):
        (module,) = (WORK / "site/viscera").glob("_viscera*.so")
        data = module.read_bytes()
        for name in (b"_ARRAY_API", b"multiarray"):
            self.assertNotIn(name, data)

    def test_runs_with_what_numpy_2_moved(self):
        with self.assertRaises(AssertionError):  # else it would not show anything
            printed(AS_NUMPY_2 + "import numpy.core.multiarray")
        self.assertEqual(printed(STEP).split()[0], printed(AS_NUMPY_2 + STEP).split()[0])
        printed(AS_NUMPY_2 + "import numpy\nfrom viscera import gym\ngym.check(gym.make('touch'))\nassert numpy.__version__ == '2.0.0'")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
