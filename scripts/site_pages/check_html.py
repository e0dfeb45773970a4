#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the pages of a site: links lead to files and anchors of it, nothing is loaded from the network, and no Markdown is
left in the text. Usage: check_html.py SITE"""
import html.parser
import os
import pathlib
import re
import sys
import urllib.parse

LOADED = {('img', 'src'), ('script', 'src'), ('iframe', 'src'), ('link', 'href')}
DOXYGEN = {'nested-classes'}  # Doxygen 1.9.4 links to this heading also where all nested classes are private, and omits it
LEFT_OVER = re.compile(r'\]\([\w./#-]+\)|\*\*\w|^ *\|.*\|$|^#{2,} \w|\{: ?#|`|^[*+-] \w|\\[*_|]', re.M)  # of links, strong text, tables ...


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.anchors, self.text, self.inside = [], set(), [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == 'id' or name == 'name' and tag == 'a':
                self.anchors.add(value)
            if name in {'href', 'src'} and value:
                self.links.append((tag, name, value))
        if tag in {'code', 'pre', 'script', 'style'}:
            self.inside.append(tag)

    def handle_endtag(self, tag):
        if self.inside and self.inside[-1] == tag:
            self.inside.pop()

    def handle_data(self, data):
        self.text.append('code' if self.inside else data)


def faults(site):
    """Returns ([a line for each fault], number of pages, number of links)."""
    pages = {path: Page(path.read_text(encoding='utf-8')) for path in sorted(site.rglob('*.html'))}
    files, out = {str(path) for path in site.rglob('*')}, []
    for path, page in pages.items():
        name = path.relative_to(site)
        for tag, attribute, target in page.links:
            address = urllib.parse.urlsplit(target)
            if address.scheme or address.netloc:
                if (tag, attribute) in LOADED and address.scheme not in {'data', 'javascript'}:
                    out.append(f'{name}: loads {target} from the network')
                continue
            file = os.path.normpath(path.parent / urllib.parse.unquote(address.path)) if address.path else str(path)
            if address.path.startswith('/') or file not in files and file != str(site):
                out.append(f'{name}: {target}: no such file')
            elif address.fragment and file.endswith('.html'):
                if address.fragment not in DOXYGEN and urllib.parse.unquote(address.fragment) not in pages[pathlib.Path(file)].anchors:
                    out.append(f'{name}: {target}: no such anchor')
        if name.parts[0] != 'api':
            out += [f'{name}: Markdown in the text: {found[0]}' for found in LEFT_OVER.finditer(''.join(page.text))]
    return out, len(pages), sum(len(page.links) for page in pages.values())


def main():
    found, pages, count = faults(pathlib.Path(sys.argv[1]).resolve())
    print('\n'.join(found) or f'{pages} pages with {count} links: all lead to files and anchors of the site')
    return 1 if found else 0


if __name__ == '__main__':
    sys.exit(main())
