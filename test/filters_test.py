#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Every pattern of TIMING and LONG in test/CMakeLists.txt names a test: filters_test.py PROGRAM FILTER [PROGRAM FILTER]...

A test that is renamed would otherwise run where its pattern was to keep it away. Programs that are not built, as with
scripts/test --changed, are left out."""
import fnmatch
import os
import subprocess
import sys


def names_of(program):
    """Returns the names of all tests of a program, as suite.test."""
    listed = subprocess.run([program, "--gtest_list_tests"], check=True, capture_output=True, text=True).stdout
    suite, names = "", []
    for line in listed.splitlines():
        word = line.split("#")[0].strip()
        if line.startswith(" "):
            names.append(suite + word)
        elif word.endswith("."):
            suite = word
    return names


def main(arguments):
    unmatched = []
    built = [pair for pair in zip(arguments[::2], arguments[1::2]) if os.path.exists(pair[0])]
    for program, patterns in built:
        names = names_of(program)
        unmatched += [(program, pattern) for pattern in patterns.split(":") if not fnmatch.filter(names, pattern)]
    for program, pattern in unmatched:
        print("%s has no test %s" % (program, pattern))
    return 0 if built and not unmatched else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
