# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The reference of messages and services, from msg/*.msg and srv/*.srv."""
import re

FIELD = re.compile(r'([\w/]+(?:\[\d*\])?)\s+(\w+)\s*(?:=\s*([^#]*?)\s*)?(?:#\s*(.*))?$')


def cell(text):
    """Returns text for a cell of a table: code between backticks stays, other markup of Markdown becomes plain text."""
    parts = re.split(r'(`[^`|]+`)', text or '')
    return ''.join(part if part.startswith('`') and len(part) > 1 else re.sub(r'([\\`*_{}\[\]<>|])', r'\\\1', part) for part in parts)


def parsed(text):
    """Returns (comment above the fields, [sections]) of a definition; a section is a list of [type, name, value, comment]."""
    about, sections = [], [[]]
    for line in text.split('\n'):
        line = line.rstrip()
        field = FIELD.match(line)
        comment = re.match(r'\s*#\s?(.*)', line)
        if line == '---':
            sections.append([])
        elif line.startswith('#') and not any(sections):
            about.append(comment[1])
        elif comment and line.startswith(' '):  # continues that of the field before it
            sections[-1][-1][3] = f'{sections[-1][-1][3]} {comment[1].strip()}'.strip()
        elif comment:
            sections[-1].append(['', '', None, comment[1]])
        elif field:
            sections[-1].append([field[1], field[2], field[3], field[4] or ''])
        elif line:
            raise ValueError(f'neither field nor comment: {line}')
    return ' '.join(about), sections


def table(fields, names):
    """Returns the table of a section. names: messages of this package, which get a link."""
    out = ['| field | type | meaning |', '|---|---|---|']
    for kind, name, value, comment in fields:
        base = re.sub(r'\[.*', '', kind)
        shown = f'[`{kind}`](#{base.lower()})' if base in names else f'`{kind}`' if kind else ''
        field = f'`{name} = {value}`' if value else f'`{name}`' if name else ''
        out.append(f'| {field} | {shown} | {cell(comment)} |')
    return out


def page(root):
    """Returns the page."""
    messages, services = sorted((root / 'msg').glob('*.msg')), sorted((root / 'srv').glob('*.srv'))
    names = {path.stem for path in messages}
    out = ['# Messages and services', '', 'Fields of the messages and services of the package `viscera`. '
           '[ROS interface](../docs/ros_api.md) lists the topics and services that use them. `T[]` is a list.', '', '## Messages', '']
    for path in messages:
        about, sections = parsed(path.read_text(encoding='utf-8'))
        out += [f'### {path.stem}', '', cell(about), '', *table(sections[0], names), '']
    out += ['## Services', '']
    for path in services:
        about, sections = parsed(path.read_text(encoding='utf-8'))
        out += [f'### {path.stem}', '', cell(about), '']
        for title, fields in zip(('Request', 'Response'), sections):
            out += [f'**{title}**', '', *(table(fields, names) if fields else ['No fields.']), '']
    return '\n'.join(out)
