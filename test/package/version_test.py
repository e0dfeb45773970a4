#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The version is the same in package.xml, CMake, change logs and Debian's files, and what programs print: version_test.py COMMAND VERSION."""
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
COMMAND, OF_CMAKE = sys.argv[1:3]


def text(name):
    return (ROOT / name).read_text(encoding="utf-8")


class VersionTest(unittest.TestCase):
    def setUp(self):
        self.version = re.search(r"<version>(.*)</version>", text("package.xml")).group(1)
        self.minor = ".".join(self.version.split(".")[:2])

    def test_package_and_cmake(self):
        self.assertRegex(self.version, r"^\d+\.\d+\.\d+$")
        self.assertEqual(self.version, OF_CMAKE)
        self.assertEqual(subprocess.run([COMMAND, "--version"], check=True, capture_output=True, text=True).stdout.strip(),
                         f"viscera {self.version}")

    def test_change_log_has_catkins_form(self):
        headings = re.findall(r"^(?:Forthcoming|\d+\.\d+\.\d+ \(\d{4}-\d\d-\d\d\))\n-+$", text("CHANGELOG.rst"), re.M)
        self.assertEqual(len(headings), len(re.findall(r"^-{4,}$", text("CHANGELOG.rst"), re.M)), "a heading of another form")
        for heading in headings:
            title, line = heading.split("\n")
            self.assertEqual(len(title), len(line), title)
        releases = [heading for heading in headings if not heading.startswith("Forthcoming")]
        self.assertTrue(releases[0].startswith(self.version + " "), f"{releases[0]}: package.xml has {self.version}")
        try:
            from catkin_pkg.changelog import get_changelog_from_path
        except ImportError:
            return
        changes = dict((version, items) for version, _, items in get_changelog_from_path(str(ROOT)).foreach_version())
        self.assertIn(self.version, changes)

    def test_debian(self):
        self.assertTrue(text("debian/changelog").startswith(f"viscera ({self.version}-"))
        library = f"libviscera-core{self.minor}"
        self.assertIn(f"Package: {library}\n", text("debian/control"))
        self.assertTrue((ROOT / f"debian/{library}.install").exists())
        self.assertIn(f"`{library}`", text("docs/install.md"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
