#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pages can be read in an editor: no line of README.md, ARCHITECTURE.md, CONTRIBUTING.md and docs/ is longer than 400
characters, rows of tables and those that `viscera keys` prints included. And to their end: docs/ has at most 36 pages
and 85,000 words. Usage: docs_test.py [ROOT]"""
import pathlib
import re
import sys

LONGEST = 400  # characters: four lines of a page that is 100 wide
MOST_PAGES = 36
MOST_WORDS = 85000  # as `wc -w` counts: a day of reading
ADDRESS = re.compile(r'https?://\S+')  # cannot be broken, and does not count


def main():
    root = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent
    pages = sorted([*root.glob('*.md'), *(root / 'docs').rglob('*.md')])
    assert len(pages) > 3, f'{root} holds no docs/'
    wrong = [f'{page.relative_to(root)}:{number}: {len(line)} characters, {LONGEST} at most; a table or paragraph of its own is read more easily'
             for page in pages for number, line in enumerate(page.read_text(encoding='utf-8').splitlines(), 1)
             if len(ADDRESS.sub('', line)) > LONGEST]
    docs = sorted((root / 'docs').rglob('*.md'))
    words = sum(len(page.read_text(encoding='utf-8').split()) for page in docs)
    if len(docs) > MOST_PAGES or words > MOST_WORDS:
        wrong.append(f'docs/: {len(docs)} pages with {words} words, at most {MOST_PAGES} and {MOST_WORDS}: shorten what another page says too')
    print('\n'.join(wrong) or f'{len(pages)} pages: every line within {LONGEST} characters, {words} words in docs/')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
