#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""What scripts/changed_tests chooses in a small project: two programs with a header in common and one of their own each, one
of them as two shards, and tests in Python. Usage: changed_tests_test.py CMAKE NINJA COMPILER"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent.parent / "scripts" / "changed_tests"
LISTS = """cmake_minimum_required(VERSION 3.16)
project(small CXX)
enable_testing()
add_executable(one test/one_test.cpp)
add_executable(two test/two_test.cpp test/more_test.cpp)
set_target_properties(two PROPERTIES UNITY_BUILD ON)
include_directories(${PROJECT_SOURCE_DIR})
add_test(NAME one COMMAND one)
foreach(shard 0 1)
  add_test(NAME two_${shard} COMMAND two --gtest_filter=-Slow.*)
  set_tests_properties(two_${shard} PROPERTIES ENVIRONMENT "GTEST_TOTAL_SHARDS=2;GTEST_SHARD_INDEX=${shard}")
endforeach()
add_test(NAME reader COMMAND python3 ${PROJECT_SOURCE_DIR}/test/reader_test.py)
add_test(NAME texts COMMAND python3 ${PROJECT_SOURCE_DIR}/test/texts_test.py)
"""
FILES = {
    "CMakeLists.txt": LISTS,
    ".gitignore": "/build/\n",
    "common.h": "#define TEST(suite, name) inline int suite##name()\n",
    "first.h": "",
    "second.h": "",
    "test/one_test.cpp": '#include "common.h"\n#include "first.h"\nint main() {}\n',
    "test/two_test.cpp": '#include "common.h"\n#include "second.h"\nTEST(Pair, adds) { return 2; }\nint main() {}\n',
    "test/more_test.cpp": '#include "common.h"\nTEST(More, adds) { return 3; }\n',
    "test/reader_test.py": 'import helper\nSCENE = "/config/" + "organ" + ".yaml"\n',
    "test/helper.py": "",
    "test/texts_test.py": "",
    "config/organ.yaml": "",
    "docs/page.md": "",
}


class ChangedTests(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(os.path.realpath(cls.temporary.name))
        cls.build = cls.root / "build"
        for name, content in FILES.items():
            (cls.root / name).parent.mkdir(exist_ok=True)
            (cls.root / name).write_text(content)
        cmake, ninja, compiler = ARGUMENTS
        cls.run_quietly("git", "init", "--quiet")
        cls.commit()
        cls.run_quietly(cmake, "-S", ".", "-B", "build", "-G", "Ninja", f"-DCMAKE_MAKE_PROGRAM={ninja}",
                        f"-DCMAKE_CXX_COMPILER={compiler}")
        cls.before_a_build = cls.chosen("docs/page.md")
        cls.run_quietly(cmake, "--build", "build")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def run_quietly(cls, *command):
        subprocess.run(command, cwd=cls.root, check=True, stdout=subprocess.DEVNULL)

    @classmethod
    def commit(cls):
        cls.run_quietly("git", "add", "--all")
        cls.run_quietly("git", "-c", "user.name=a test", "-c", "user.email=", "commit", "--quiet", "--allow-empty", "-m", "small")

    @classmethod
    def told(cls, *arguments):
        done = subprocess.run([sys.executable, SCRIPT, "--plan", cls.build / "plan", *arguments], check=True, capture_output=True,
                              env={**os.environ, "VISCERA_BUILD": str(cls.build)}, text=True)
        return done.stdout, (cls.build / "plan").read_text()

    @classmethod
    def chosen(cls, *files):
        """{test: why} after a line has been added to these files, which then are as before, or gone."""
        for name in files:
            with open(cls.root / name, "a", encoding="utf-8") as file:
                file.write("\n")
        try:
            lines = cls.told()[0].splitlines()
        finally:
            for name in files:
                (cls.root / name).unlink()
            cls.run_quietly("git", "checkout", "--quiet", ".")
        return dict(line.split(": ", 1) for line in lines[1:])

    def test_nothing_has_changed(self):
        said, plan = self.told()
        self.assertEqual(said, "nothing has changed since HEAD\n")
        self.assertEqual(plan, "everything=false\nprograms=()\ntests=''\nalone=()\n")

    def test_a_header_of_one_program(self):
        self.assertEqual(self.chosen("first.h"), {"one": "first.h", "texts": "first.h"})
        self.assertEqual(set(self.chosen("second.h")), {"two_0", "two_1", "texts"})  # in a unity source

    def test_a_source_that_has_joined_a_group(self):
        group = next(self.build.rglob("unity_*_cxx.cxx"))
        was = group.read_text()
        group.write_text(was + f'#include "{self.root}/test/other_test.cpp"\n')
        chosen = self.chosen("docs/page.md")
        group.write_text(was)
        self.assertEqual(set(chosen), {"two_0", "two_1", "texts"})  # what it includes is known to no one yet

    def test_a_header_of_both(self):
        self.assertEqual(set(self.chosen("common.h")), {"one", "two_0", "two_1", "texts"})

    def test_a_page_and_a_new_file(self):
        self.assertEqual(self.chosen("docs/page.md"), {"texts": "docs/page.md"})
        self.assertEqual(set(self.chosen("new.h")), {"texts"})

    def test_what_python_reads(self):
        for file in ("test/reader_test.py", "test/helper.py", "config/organ.yaml"):
            self.assertEqual(set(self.chosen(file)), {"reader", "texts"}, file)

    def test_a_source_of_tests_alone(self):
        self.assertEqual(set(self.chosen("test/more_test.cpp")), {"two, of which More", "texts"})
        self.assertEqual(set(self.chosen("test/more_test.cpp", "test/two_test.cpp")), {"two, of which More, Pair", "texts"})
        self.assertEqual(set(self.chosen("test/more_test.cpp", "second.h")), {"two_0", "two_1", "texts"})

    def test_settings(self):
        (self.root / "CMakeLists.txt").write_text(LISTS + "\n")
        said, plan = self.told()
        self.run_quietly("git", "checkout", "--quiet", ".")
        self.assertIn("CMakeLists.txt has changed since HEAD (1 file), on which everything may depend: all 5 tests", said)
        self.assertIn("everything=true\n", plan)

    def test_since_a_commit(self):
        (self.root / "first.h").write_text("// changed\n")
        self.commit()
        self.assertIn("nothing", self.told()[0])
        said, plan = self.told("HEAD~1")
        self.assertIn("one: first.h", said)
        self.assertIn("programs=(one)\ntests='^(one|texts)$'\n", plan)

    def test_what_has_never_been_built_may_depend_on_anything(self):
        self.assertEqual(self.before_a_build["one"], "one, not all of which has been built")
        self.assertEqual(set(self.before_a_build), {"one", "two_0", "two_1", "texts"})


if __name__ == "__main__":
    ARGUMENTS = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1])
