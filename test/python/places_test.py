#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The package from the build folder and from an installed prefix, with the messages that ROS puts into the same folder.
Usage: places_test.py CMAKE BUILD_FOLDER PACKAGE_FOLDER PREFIX"""
import os
import shutil
import subprocess
import sys
import unittest

CMAKE, BUILD, PACKAGE, PREFIX = sys.argv[1:]
ROS = os.path.isdir(os.path.join(PACKAGE, "msg"))
MESSAGES = """
import sys
from viscera.msg import Tick
from viscera.srv import Step
assert "viscera._viscera" not in sys.modules, "a node that wants messages alone has loaded the simulator"
"""
STEP = """
import viscera
session = viscera.Session(viscera.Scene("cloth_on_points"), threads=1)
session.step()
print(viscera.__path__[0], session.hash)
"""


def printed(text, *folders):
    """What a program prints that finds modules in these folders, and where ROS is."""
    path = os.pathsep.join([*folders, os.environ.get("PYTHONPATH", "")])
    return subprocess.run([sys.executable, "-B", "-c", text], env={**os.environ, "PYTHONPATH": path}, check=True,
                          stdout=subprocess.PIPE, text=True, timeout=120).stdout.split()


class PlacesTest(unittest.TestCase):
    def install(self, *components):
        shutil.rmtree(PREFIX, ignore_errors=True)
        for component in components:
            subprocess.run([CMAKE, "--install", BUILD, "--component", component, "--prefix", PREFIX], check=True,
                           stdout=subprocess.DEVNULL, timeout=300)
        folder = os.path.join(PREFIX, os.path.relpath(PACKAGE, PACKAGE.rsplit("/lib/python", 1)[0]))
        self.assertTrue(os.path.exists(os.path.join(folder, "__init__.py")))
        self.assertFalse(os.path.exists(os.path.join(folder, "config_folder.txt")))
        return folder

    def test_build_and_prefix_step_alike(self):
        built = printed((MESSAGES if ROS else "") + STEP, os.path.dirname(PACKAGE))
        self.assertEqual(built[0], PACKAGE)
        folder = self.install("Unspecified", "python")
        installed = printed((MESSAGES if ROS else "") + STEP, os.path.dirname(folder))
        self.assertEqual(installed, [folder, built[1]])

    @unittest.skipUnless(ROS, "no messages here")
    def test_messages_of_another_folder(self):
        folder = self.install("python")
        self.assertFalse(os.path.isdir(os.path.join(folder, "msg")))
        printed(MESSAGES, os.path.dirname(folder), os.path.dirname(PACKAGE))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
