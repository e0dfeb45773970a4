#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""What libviscera_core exports is what include/viscera declares: exports_test.py HEADERS LIBRARY VERSION ARCHIVE... [--module FILE].

HEADERS: include/viscera. VERSION: of the package. ARCHIVE: the static libraries of which the library is made; what they define and
a header declares must be exported. FILE: the Python module, which exports its entry alone.
"""
import argparse
import pathlib
import re
import subprocess
import unittest

FEWEST = 100  # symbols of the library: fewer are a mistake of this test
PREFIX = re.compile(r"_ZT[VIS]N|_ZNK?")
INTERNAL_LINKAGE = "_GLOBAL__N_1"
# Clang-format begins what is declared in a namespace in the first column; what is defined there has no symbol of the library.
FUNCTION = re.compile(r"^(?!inline|constexpr|template|using|namespace|static_assert)[A-Za-z][^;{}()=#]*?\b(\w+)\(", re.M)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)


def printed(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def names_of(symbol):
    """Returns the names of a mangled symbol from the outermost namespace on, or () for one outside of any namespace.

    A constructor, destructor or operator has the name of its class alone: ("viscera", "Session").
    """
    start = PREFIX.match(symbol)
    if not start:
        return ()
    rest, names = symbol[start.end():], []
    while True:
        length = re.match(r"[1-9]\d*", rest)
        if not length:
            return tuple(names)
        begin = length.end()
        names.append(rest[begin:begin + int(length.group())])
        rest = rest[begin + int(length.group()):]


class Header:
    def __init__(self, path):
        self.text = COMMENT.sub("", path.read_text())
        self.types = set(re.findall(r"\b(?:class|struct)\s+(?:VISCERA_PUBLIC\s+)?(\w+)(?:\s+final)?\s*(?::[^;{]*)?\{", self.text))
        self.spaces = set(re.findall(r"\bnamespace\s+(?:VISCERA_PUBLIC\s+)?(\w+)\s*\{", self.text))
        self.functions = set(FUNCTION.findall(self.text))
        self.others = set(re.findall(r"\b(\w+)\s*[({\[=;]", self.text)) - {"if", "for", "while", "return", "sizeof"}

    def declares(self, names):
        """Returns whether it has these names: types and namespaces around the last, which may be a function or variable."""
        around, last = names[:-1], names[-1]
        if not all(name in self.types or name in self.spaces for name in around):
            return False
        return last in self.types or last in self.others


class ExportsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.headers = {path: Header(path) for path in sorted(GIVEN.headers.rglob("*.h"))}
        cls.exported = exports(GIVEN.library)

    def declared(self, symbol):
        names = names_of(symbol)
        return len(names) > 1 and names[0] == "viscera" and any(header.declares(names) for header in self.headers.values())

    def test_only_what_headers_declare(self):
        self.assertGreater(len(self.exported), FEWEST)
        wrong = [symbol for symbol in self.exported if not self.declared(symbol)]
        if wrong:
            self.fail(f"{len(wrong)} exported symbols that no header in {GIVEN.headers} declares:\n" + demangled(wrong))

    def test_all_that_headers_declare(self):
        """Members of public classes one by one. Functions by name: some have internal overloads."""
        exported = {names_of(symbol) for symbol in self.exported}
        types = {name for header in self.headers.values() for name in header.types}
        functions = {name for header in self.headers.values() for name in header.functions}

        def public(symbol):
            names = names_of(symbol)
            if names[-1] in types or names[-2] in types:
                return True
            return names[-1] in functions and names not in exported

        defined = {symbol for archive in GIVEN.archives for symbol in symbols(archive) if self.declared(symbol)}
        self.assertGreater(len(defined), FEWEST)
        self.assertGreater(len(functions), 50)
        hidden = [symbol for symbol in defined - self.exported if INTERNAL_LINKAGE not in symbol and public(symbol)]
        if hidden:
            self.fail(f"{len(hidden)} symbols of public headers are hidden; the class or its namespace lacks VISCERA_PUBLIC:\n" +
                      demangled(hidden))

    def test_every_header_marks_its_namespace(self):
        for path, header in self.headers.items():
            if header.spaces:
                self.assertIn("namespace VISCERA_PUBLIC viscera", header.text, f"{path}: see viscera/api.h")

    def test_binary_interface_is_that_of_the_minor_version(self):
        name = re.search(r"Library soname: \[(.*)\]", printed("readelf", "-d", str(GIVEN.library))).group(1)
        self.assertEqual(name, "libviscera_core.so." + ".".join(GIVEN.version.split(".")[:2]))

    def test_the_python_module_exports_its_entry(self):
        if not GIVEN.module:
            self.skipTest("no module is built")
        self.assertEqual(exports(GIVEN.module), {"PyInit__viscera"})


def exports(library):
    return {line.split()[-1] for line in printed("nm", "-D", "--defined-only", str(library)).splitlines()}


def symbols(archive):
    """Returns what an archive defines for others: functions, variables, vtables; not what is inline, which users compile themselves."""
    lines = printed("nm", "--defined-only", "--extern-only", str(archive)).splitlines()
    return {line.split()[-1] for line in lines if re.match(r"[0-9a-f]+ [TDBR] ", line)}


def demangled(mangled):
    return subprocess.run(["c++filt"], input="\n".join(sorted(mangled)[:40]), check=True, capture_output=True, text=True).stdout


if __name__ == "__main__":
    options = argparse.ArgumentParser()
    options.add_argument("headers", type=pathlib.Path)
    options.add_argument("library", type=pathlib.Path)
    options.add_argument("version")
    options.add_argument("archives", type=pathlib.Path, nargs="+")
    options.add_argument("--module", type=pathlib.Path)
    GIVEN = options.parse_args()
    unittest.main(argv=["exports_test"])
