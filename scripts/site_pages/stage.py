#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the pages of the site: copies those of the repository in the dialect of Python-Markdown, which MkDocs reads, and
generates the references. Usage: stage.py ROOT OUT; Doxygen's pages are in OUT/api."""
import os
import pathlib
import re
import shutil
import sys

import cpp_reference
import links
import message_reference
import python_reference

NAVIGATION = 'docs/site/mkdocs.yml'


def titled(label, path, anchor, titles):
    """Returns the label of a link; if it is the name of the page's file, the title of the page or of the section."""
    if not re.fullmatch(r'[\w./]+\.md(#[\w-]+)?', label) or path not in titles:
        return label
    return titles[path].get(anchor if '#' in label else '', label)


def linked(page, text, root, pages, titles):
    """Returns the text with links to files that are not on the site turned into their paths as code.
    page: path of the page from the root; pages: paths of what is on the site; titles: {page: {anchor, or '' for the page: title}}."""
    plain = links.without_code(text)
    out, at = [], 0
    for link in links.LINK.finditer(plain):
        label, target = text[link.start(2):link.end(2)], link[3]
        path = os.path.normpath(os.path.join(os.path.dirname(page), target.partition('#')[0]))
        if re.match(r'[a-z]+:|#', target) or path in pages:
            shown = titled(label, path, target.partition('#')[2], titles)
            out += [text[at:link.start(2)], shown]
            at = link.end(2)
            continue
        if not os.path.exists(os.path.join(root, path)):
            sys.exit(f'{page}: {target}: no such file; test/links_test.py lists such links')
        code = f'`{path}`'
        out += [text[at:link.start()], code if label.strip('`') in path else f'{label} ({code})']
        at = link.end()
    return ''.join(out) + text[at:]


def anchored(text):
    """Returns the text with GitHub's anchor at each heading."""
    lines = text.split('\n')
    for number, level, heading, anchor in links.headings(text):
        lines[number - 1] = f'{"#" * level} {heading} {{: #{anchor} }}'
    return '\n'.join(lines)


def escaped(text):
    """Returns the text with a backslash before each * that neither begins nor ends emphasis, as in F* = F."""
    plain = links.without_code(text)
    literal, opened = [], []
    for found in re.finditer(r'\*+|\n\s*\n|(?:^|(?<=\n)) *[*+-] |\|', plain):
        mark = found[0]
        if '*' not in mark or mark.endswith(' '):  # another paragraph, item or cell
            literal += opened
            opened = []
            continue
        before, after = text[found.start() - 1:found.start()] or ' ', text[found.end():found.end() + 1] or ' '
        opens = not after.isspace() and (after.isalnum() or after in '`[(\\' or not before.isalnum())
        closes = not before.isspace()
        if closes and opened and plain[opened[-1]:].startswith(mark):
            opened.pop()
        elif opens:
            opened.append(found.start())
        elif not (before.isspace() and after.isspace()):
            literal.append(found.start())
    for position in sorted(literal + opened, reverse=True):
        stars = re.match(r'\*+', plain[position:])[0]
        text = text[:position] + '\\*' * len(stars) + text[position + len(stars):]
    return text


def indented(lines):
    """Returns lines in which text below an item of a list is indented by four, and a blank line is before each list."""
    out, at = [], 0
    while at < len(lines):
        item = links.ITEM.match(lines[at])
        if not item or item[1]:
            if lines[at].startswith('```'):  # fenced code stays as it is
                end = next((n for n in range(at + 1, len(lines)) if lines[n].startswith('```')), len(lines) - 1)
                out += lines[at:end + 1]
                at = end + 1
                continue
            out.append(lines[at])
            at += 1
            continue
        # In the middle of a paragraph, as where a line begins with a number, it is an item if it is a bullet or 1.
        previous = out[-1] if out else ''
        if previous.strip() and not previous.startswith((' ', '#')) and not links.ITEM.match(previous):
            if item[2][0].isdigit() and item[2][:-1] != '1':
                out.append(lines[at])
                at += 1
                continue
            out.append('')
        width = len(item[0])
        body = [lines[at][width:]]
        at += 1
        while at < len(lines):
            line = lines[at]
            lazy = line.strip() and body[-1].strip() and not links.ITEM.match(line) and not line.startswith(('#', '|', '```'))
            if line.strip() and not line.startswith(' ' * width) and not lazy:
                break
            body.append(line[width:] if line.startswith(' ' * width) else line.lstrip() if lazy else '')
            at += 1
        trailing = 0
        while not body[-1].strip():
            body.pop()
            trailing += 1
        inner = indented(body)
        out.append(item[2] + ' ' + inner[0])
        out += ['    ' + line if line.strip() else '' for line in inner[1:]]
        out += [''] * max(trailing, '' in inner)  # below several paragraphs, the next item begins after a blank line
    return out


def referred(text, pages):
    """Returns the text of a generated page with a link where it names a page, as in docs/python.md."""
    plain, out, at = links.without_code(text), [], 0
    for found in re.finditer(r'(?<!\]\()(?<![\w/.])(docs/[\w/\\]+\.md)', plain):
        name = found[1].replace('\\', '')
        if name in pages:
            out += [text[at:found.start()], f'[{found[1]}](../{name})']
            at = found.end()
    return ''.join(out) + text[at:]


def piped(text):
    """Returns the text with | for \\| in code in tables, where Python-Markdown would show the backslash."""
    return '\n'.join(links.CODE_SPAN.sub(lambda code: code[0].replace('\\|', '|'), line) if line.startswith('|') else line
                     for line in text.split('\n'))


def page_for_site(page, text, root, pages, titles):
    """Returns the text of a page of the repository for Python-Markdown."""
    text = anchored(escaped(linked(page, piped(text), root, pages, titles)))
    return '\n'.join(indented(text.split('\n')))


def main():
    root, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    pages = sorted([*root.glob('*.md'), *(root / 'docs').rglob('*.md')])
    copied = [path for path in sorted((root / 'docs').rglob('*')) if path.suffix in {'.png', '.gif', '.jpg', '.svg'}]
    names = {str(path.relative_to(root)) for path in pages + copied}
    for path in copied:
        target = out / path.relative_to(root)
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, target)
    generated = {'reference/python.md': python_reference.page(root), 'reference/messages.md': message_reference.page(root),
                 'reference/cpp.md': cpp_reference.page(root, out / 'api')}
    texts = {str(path.relative_to(root)): path.read_text(encoding='utf-8') for path in pages}
    titles = {name: {anchor: heading for *_, heading, anchor in links.headings(text)} for name, text in texts.items()}
    for title, name in re.findall(r'^ +- "?(.+?)"?: (\S+\.md)$', (root / NAVIGATION).read_text(encoding='utf-8'), re.M):
        titles.setdefault(name, {})[''] = title
    for name, text in texts.items():
        target = out / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(page_for_site(name, text, root, names, titles), encoding='utf-8')
    for name, text in generated.items():
        target = out / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(anchored(referred(text, names)), encoding='utf-8')


if __name__ == '__main__':
    main()
