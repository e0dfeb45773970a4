#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""What comments and pages say of the tree is so.

A path begins with a folder of the root (`scripts/demo`), or has a slash and the extension of a source (`math/error.h`);
it is relative to the root, to src, include/viscera, include, shaders or test, or to its page. A name without a slash is
one of a file somewhere, if its extension is of C++ or GLSL or .md. A `*` stands for at least one file, `{h,cpp}` for
both. What is not looked at: `<hwy/highway.h>`, addresses, `x` for a name (`x_pass.h`), names in capitals (`PLAN.yaml`).
"""
import fnmatch
import glob
import os
import re
import sys
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
BASES = ("", "src", "include/viscera", "include", "shaders", "test")
MADE = ("out", "build")  # by programs
PLAIN = {  # what is said instead
    "nobody": "no one, nothing, or what is not done", "somebody": "someone, or what is done", "whoever": "who, what",
    "anew": "again"}
CODE = {"h", "cpp", "comp", "glsl", "frag", "vert", "inc", "md"}
SOURCES = CODE | {"cmake", "launch", "msg", "srv", "py", "test"}
C_LIKE = {"h", "cpp", "comp", "glsl", "frag", "vert", "inc"}
PAGES = {"md", "rst"}
XML = {"xml", "launch", "test"}
HASHED = {"cmake", "txt", "yaml", "yml", "msg", "srv", "py", ""}
FOLDERS = sorted(name for name in os.listdir(ROOT) if os.path.isdir(os.path.join(ROOT, name))
                 and not name.startswith((".", *MADE)))

WORD = re.compile(r"(?<![\w./~$%:<\"'=@+*}-])[\w.*{},+/-]*[\w*}/]")
NAMELESS = re.compile(r"\bx[_.]|[_/]x\b|[A-Z]{3,}_?[A-Z]*(?=[/.])|\.\.\.")
COMMENT = {"c": re.compile(r"\"(?:\\.|[^\"\\])*\"|(//.*)"), "#": re.compile(r"(?:^|\s)(#.*)")}


def extension(path):
    return os.path.splitext(path)[1][1:]


def texts():
    """(path, content) of the tree's own files."""
    for folder in FOLDERS + [""]:
        top = os.path.join(ROOT, folder)
        for at, folders, names in os.walk(top):
            folders[:] = sorted(f for f in folders if folder and f != "__pycache__")
            for name in sorted(names):
                path = os.path.join(at, name)
                if extension(name) not in C_LIKE | PAGES | XML | HASHED or name == "LICENSE" or os.path.islink(path):
                    continue
                with open(path, encoding="utf-8") as file:
                    yield os.path.relpath(path, ROOT), file.read()


def said(path, content, strings=False):
    """(line number, text) of what it says to its readers: pages whole, comments and docstrings of the rest.

    strings: of C++ those too
    """
    kind = extension(path)
    if kind in PAGES:
        yield from enumerate(content.split("\n"), 1)
    elif kind in XML:
        for found in re.finditer(r"<!--.*?-->|doc=\"[^\"]*\"", content, re.S):
            yield content.count("\n", 0, found.start()) + 1, found.group()
    else:
        pattern = COMMENT["c" if kind in C_LIKE else "#"]
        for number, line in enumerate(content.split("\n"), 1):
            for found in pattern.finditer(line):
                if found.group(1):
                    yield number, found.group(1)
                elif strings:
                    yield number, found.group()
        if kind == "py" or "python3" in content[:40]:
            for found in re.finditer(r"^\s*\"\"\"(.*?)\"\"\"", content, re.S | re.M):
                yield content.count("\n", 0, found.start()) + 1, found.group(1)


def spelled_out(token):
    """`x.{h,cpp}` is `x.h` and `x.cpp`."""
    found = re.search(r"\{([^{}]*)\}", token)
    if not found:
        return [token]
    return [out for part in found.group(1).split(",") for out in
            spelled_out(token[:found.start()] + part + token[found.end():])]


def named_paths(text):
    for found in WORD.finditer(text):
        if NAMELESS.search(found.group()):
            continue
        joined = found.group().rstrip(".,/").split("+")  # rooms that are one, in ARCHITECTURE.md
        for token in (name for each in joined for name in spelled_out(each)):
            parts = token.split("/")
            if parts[0] in MADE:
                continue
            if parts[0] in FOLDERS and len(parts) > 1:
                yield token
            elif extension(parts[-1]) in (SOURCES if len(parts) > 1 else CODE) and re.match(r"[\w*]", parts[-1]):
                yield token


class Texts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.files = dict(texts())
        cls.names = {os.path.basename(path) for path in cls.files}

    def exists(self, token, page):
        if "/" not in token:
            return bool(fnmatch.filter(self.names, "*" + token if token.startswith("_") else token))
        bases = [os.path.join(ROOT, base) for base in BASES] + [os.path.join(ROOT, os.path.dirname(page))]
        return any(glob.glob(os.path.join(base, token)) for base in bases)

    def test_paths_that_comments_and_pages_name_exist(self):
        wrong = [f"{path}:{number}: {token}" for path, content in self.files.items()
                 for number, text in said(path, content) for token in named_paths(text)
                 if not self.exists(token, path)]
        self.assertEqual(wrong, [], "no such file or folder\n" + "\n".join(wrong))

    def test_edits_of_mutations_have_their_text(self):
        """The text that an edit of scripts/mutate replaces occurs once in its file."""
        sys.path.insert(0, os.path.join(ROOT, "scripts"))
        from mutating.mutations import MUTATIONS
        wrong = [f"{edit.name}: {edit.file}" for edit in MUTATIONS if self.files[edit.file].count(edit.old) != 1]
        self.assertEqual(wrong, [], "scripts/mutating/mutations.py: the text to replace must occur once")

    def test_owners_of_shaders_name_them(self):
        wrong, owned = [], 0
        for path, content in self.files.items():
            if not path.startswith("shaders/"):
                continue
            for owners in re.findall(r"Owners?: *(\S+\.h(?:, *\S+\.h)*)", content):
                for owner in re.split(", *", owners):
                    owned += 1
                    ends = [os.path.join("src", owner), os.path.join("src", owner[:-2] + ".cpp")]
                    name = os.path.basename(path)
                    if extension(path) != "glsl":
                        name = f'"{name}"'
                    if not any(name in self.files.get(end, "") for end in ends):
                        wrong.append(f"{path}: {owner} does not name {name}")
        self.assertGreater(owned, 0)
        self.assertEqual(wrong, [], "\n" + "\n".join(wrong))

    def test_words_are_plain(self):
        word = re.compile(r"(?<![\w:.])(%s)\b" % "|".join(PLAIN), re.I)
        wrong = [f"{path}:{number}: {found}: say {PLAIN[found.lower()]}" for path, content in self.files.items()
                 if path != os.path.relpath(__file__, ROOT)
                 for number, text in said(path, content, strings=True) for found in word.findall(text)]
        self.assertEqual(wrong, [], "\n" + "\n".join(wrong))

    def test_wrong_paths_are_found(self):
        for text in ("see model/no_such.h", "as `no_such.comp` does", "scripts/no_such, by hand", "[x](no_such.md)",
                     "src/no_such/*.cpp", "src/math/no_such.{h,cpp}"):
            tokens = list(named_paths(text))
            self.assertTrue(tokens and not all(self.exists(token, "docs/page.md") for token in tokens), text)


if __name__ == "__main__":
    sys.exit(unittest.main())
