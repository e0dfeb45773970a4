#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Files have at most 400 lines and functions at most 60; what may be longer is listed here with its reason.

The layout is clang-format's: a function ends at the first closing brace that is indented as its first line is.
An exception that is no longer needed is a failure too, so that the lists get shorter only.
"""
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
FILE_LINES = 400
FUNCTION_LINES = 60
ENDINGS = (".cpp", ".h", ".py", ".comp", ".glsl", ".vert", ".frag", ".inc", ".cmake")
FOLDERS = ("src", "include", "shaders", "bench", "test", "examples", "scripts", "cmake")

LONG_FILES = {
    "test/cli/run_gl_test.cpp": "the options of `viscera run`, one short test each",
    "test/model/network_builder_test.cpp": "the kinds of networks, one short test each",
    "test/model/scene_keys_test.cpp": "the kinds of keys, one short test each",
    "test/session/threaded_view_gl_test.cpp": "one fixture that all its tests need",
}
LONG_FUNCTIONS = {
    "src/model/scene/body_fields.h: visitFields": "the table of a body's keys, a line each",
    "test/model/scene_keys_test.cpp: TEST": "a table of keys that are refused, a line each",
}

TYPE = re.compile(r"^(template <.*> )?(class|struct|enum|union|namespace|extern)\b")


def sources():
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files", "--cached", "--others", "--exclude-standard", *FOLDERS],
                            check=True, capture_output=True, text=True).stdout.split()
    return [name for name in listed if name.endswith(ENDINGS) and (ROOT / name).is_file()]


def functions(lines):
    """Yields (name, lines) of the functions of a C++ file, at the top level or within a class."""
    begin = None
    for number, line in enumerate(lines):
        if begin is None:
            text = line.strip()
            if re.match(r"^ {0,2}\S", line) and line.endswith("{") and "(" in line and not TYPE.match(text):
                begin, indent = number, len(line) - len(line.lstrip())
        elif re.match(" " * indent + r"\}", line):
            yield re.split(r"\(", lines[begin].strip())[0].split(" ")[-1], number - begin + 1
            begin = None


class Limits(unittest.TestCase):
    def test_files(self):
        long = {name: count for name in sources()
                if (count := len((ROOT / name).read_text(encoding="utf-8").splitlines())) > FILE_LINES}
        self.assertEqual({}, {n: c for n, c in long.items() if n not in LONG_FILES}, "lines of files")
        self.assertEqual([], [n for n in LONG_FILES if n not in long], "no longer too long: take it off the list")

    def test_functions(self):
        long = {}
        for name in sources():
            if not name.endswith((".cpp", ".h")):
                continue
            for function, count in functions((ROOT / name).read_text(encoding="utf-8").splitlines()):
                if count > FUNCTION_LINES:
                    long[name + ": " + function] = count
        self.assertEqual({}, {n: c for n, c in long.items() if n not in LONG_FUNCTIONS}, "lines of functions")
        self.assertEqual([], [n for n in LONG_FUNCTIONS if n not in long], "no longer too long: take it off the list")


if __name__ == "__main__":
    sys.exit(unittest.main())
