#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Links of the pages resolve: the file exists in the repository, and the anchor is that of a heading in it (GitHub's
slug) or of an <a name="...">. The navigation of the site names every page once. scripts/site checks links of the
built site by itself; here its check is shown faults. Usage: links_test.py"""
import os
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts" / "site_pages"))
sys.dont_write_bytecode = True
import check_html  # noqa: E402  after its folder is known
import links  # noqa: E402

ADDRESS = re.compile(r"[a-z][a-z0-9+.-]*:", re.I)  # of another site, which is not looked up


def pages(root):
    return sorted([*root.glob("*.md"), *(root / "docs").rglob("*.md")])


def exists(path, root):
    """Returns whether a file or folder of this name is below the root, in upper and lower case as written."""
    if not path.exists() or root not in [path, *path.parents]:
        return False
    while path != root:
        if path.name not in os.listdir(path.parent):
            return False
        path = path.parent
    return True


def broken(root):
    """Returns a line for each link that leads nowhere."""
    wrong, texts = [], {page: page.read_text(encoding="utf-8") for page in pages(root)}
    anchors = {page: links.anchors(text) for page, text in texts.items()}
    for page, text in texts.items():
        for line, target in links.links(text):
            if ADDRESS.match(target):
                continue
            name, _, anchor = target.partition("#")
            path = pathlib.Path(os.path.normpath(page.parent / name)) if name else page
            where = f"{page.relative_to(root)}:{line}: {target}: "
            if not exists(path, root):
                wrong.append(where + "no such file")
            elif anchor and anchor not in anchors.get(path, ()):
                wrong.append(where + f"{path.relative_to(root)} has no such heading")
    return wrong


class Links(unittest.TestCase):
    def test_links_lead_to_files_and_headings(self):
        wrong = broken(ROOT)
        self.assertEqual([], wrong, "\n" + "\n".join(wrong))
        self.assertGreater(sum(len(links.links(page.read_text(encoding="utf-8"))) for page in pages(ROOT)), 100)

    def test_navigation_of_the_site_names_every_page_once(self):
        text = (ROOT / "docs" / "site" / "mkdocs.yml").read_text(encoding="utf-8")
        named = re.findall(r"^\s+- .*?([\w./-]+\.md)$", text[text.index("\nnav:"):], re.M)
        made = [name for name in named if name.startswith("reference/")]  # by scripts/site
        self.assertEqual(sorted(str(page.relative_to(ROOT)) for page in pages(ROOT)), sorted(set(named) - set(made)),
                         "add pages to nav in docs/site/mkdocs.yml, or remove them there")
        self.assertEqual(len(named), len(set(named)))

    def test_broken_links_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder).resolve()
            (root / "docs").mkdir()
            (root / "docs" / "other.md").write_text("# Two  words, `code_x`\n\n## Same\n\n## Same\n\n<a name=\"named\"></a>\n")
            right = ["docs/other.md", "docs", "docs/other.md#two--words-code_x", "docs/other.md#same-1", "docs/other.md#named",
                     "#start", "https://example.org/x#y"]
            faulty = ["docs/no.md", "docs/Other.md", "docs/other.md#same-2", "docs/other.md#Same", "#no", "../docs", "docs#same"]
            text = "# Start\n\n" + "\n".join(f"* [x]({target})" for target in right + faulty)
            text += "\n\n      f[0](docs/no_code.md)\n      g[1](docs/no_code.md)\n\nText\n\n    h[2](docs/no_code.md)\n\n```\n[x](docs/no_code.md)\n```\n`[x](docs/no_code.md)`\n"
            (root / "README.md").write_text(text)
            wrong = [line.split(": ")[1] for line in broken(root)]
            self.assertEqual(faulty, wrong)

    def test_faults_of_a_built_site_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            site = pathlib.Path(folder).resolve()
            (site / "other.html").write_text('<h1 id="here">x</h1><a name="there"></a>')
            right = ['<a href="other.html#here">x</a>', '<a href="other.html#there">x</a>', '<a href="https://example.org">x</a>',
                     "<pre>\n* [x](y.md) `x`\n</pre>", '<img src="data:,">']
            faulty = ['<a href="no.html">x</a>', '<a href="other.html#no">x</a>', '<a href="/other.html">x</a>',
                      '<script src="https://example.org/x.js"></script>', "<p>\n* an item</p>", "<p>[x](y.md)</p>", "<p>`x</p>"]
            for text, count in [*((text, 0) for text in right), *((text, 1) for text in faulty)]:
                (site / "index.html").write_text(text)
                self.assertEqual(count, len(check_html.faults(site)[0]), text)


if __name__ == "__main__":
    sys.exit(unittest.main())
