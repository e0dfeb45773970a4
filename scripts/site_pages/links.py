# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Links, headings and anchors of Markdown pages, as GitHub shows them. Needs no packages."""
import re

LINK = re.compile(r'(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(\s*<?([^()\s<>]+)>?(?:\s+"[^"]*")?\s*\)')
HEADING = re.compile(r'^(#{1,6})\s+(.*?)\s*#*\s*$')
ITEM = re.compile(r'^( {0,3})([*+-]|\d{1,9}[.)])( {1,4})(?=\S)')
CODE_SPAN = re.compile(r'(?<!`)(`+)(?!`).*?(?<!`)\1(?!`)', re.S)
NAMED = re.compile(r'<a\s+(?:name|id)="([^"]+)"')


def without_code(text):
    """Returns the text with blanks in place of code; lines and columns stay the same."""
    lines, fence, after_blank, content = [], '', True, 0  # content: column at which the text of the list item begins
    for line in text.split('\n'):
        mark, item = re.match(r'\s*(```+|~~~+)', line), ITEM.match(line)
        if fence or mark:
            if not fence:
                fence = mark[1]
            elif mark and mark[1].startswith(fence):
                fence = ''
            lines.append(' ' * len(line))
            after_blank = False
            continue
        indent = len(line) - len(line.lstrip(' '))
        if item:
            content = len(item[0])
        elif line.strip() and after_blank and indent < content:
            content = 0
        if line.strip() and after_blank and not item and indent >= content + 4:
            lines.append(' ' * len(line))
            continue  # the next line, if indented, is code as well
        after_blank = not line.strip()
        lines.append(line)
    return CODE_SPAN.sub(lambda found: re.sub(r'[^\n]', ' ', found[0]), '\n'.join(lines))


def links(text):
    """Returns (line, target) of each link and image of a page."""
    plain = without_code(text)
    found = []
    for link in LINK.finditer(plain):
        found.append((plain.count('\n', 0, link.start()) + 1, link[3]))
        if link[2].startswith('!['):  # an image that is a link
            found += [(found[-1][0], inner[3]) for inner in LINK.finditer(link[2])]
    return found


def slug(heading):
    """Returns the anchor that GitHub gives to a heading."""
    text = LINK.sub(r'\2', heading)
    text = re.sub(r'<[^>]+>', '', text)
    text = re.sub(r'(\*+)(\S(?:.*?\S)?)\1', r'\2', text)
    return re.sub(r'[^\w\- ]', '', text.lower()).replace(' ', '-')


def headings(text):
    """Returns (line, level, text, anchor) of each heading; repeated ones are numbered as on GitHub."""
    plain, out, seen = without_code(text).split('\n'), [], {}
    for number, line in enumerate(text.split('\n'), 1):
        found = HEADING.match(line)
        if found and plain[number - 1].startswith('#'):
            base = slug(found[2])
            count = seen.get(base, 0)
            seen[base] = count + 1
            out.append((number, len(found[1]), found[2], f'{base}-{count}' if count else base))
    return out


def anchors(text):
    """Returns the anchors of a page: those of headings, and those that it names by <a name="...">."""
    return {anchor for *_, anchor in headings(text)} | set(NAMED.findall(text))
