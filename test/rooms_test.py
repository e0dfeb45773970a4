#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rooms: no folder of more than 36 files, and includes go the way that ARCHITECTURE.md states: a room includes rooms of
lines below its own, or itself. Usage: rooms_test.py [ROOT]"""
import os
import pathlib
import re
import subprocess
import sys

MOST_FILES = 36  # in one folder: a list of them still fits on a screen
CODE = ('.h', '.cpp', '.inc', '.glsl', '.comp', '.vert', '.frag')
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)


def stated_order(root):
    """{room: line}: the block of ARCHITECTURE.md behind "Rooms, from the top down"; rooms of a line know nothing of
    each other, but for those joined by +, which are one."""
    text = (root / 'ARCHITECTURE.md').read_text()
    block = re.search(r'Rooms, from the top down.*?\n\n((?:    .*\n)+)', text)
    assert block, 'ARCHITECTURE.md: no block "Rooms, from the top down"'
    order = {}
    for number, line in enumerate(block.group(1).splitlines()):
        for joined in line.split():
            for room in joined.split('+'):
                assert room not in order, f'ARCHITECTURE.md: room {room} stands twice in the order'
                order[room] = number, joined
    return order


def tracked(root):
    """The files of the repository; where there is no git (an archive), all but builds."""
    listed = subprocess.run(['git', '-C', str(root), 'ls-files', '-co', '--exclude-standard'], capture_output=True, text=True)
    if listed.returncode == 0:
        return [name for name in listed.stdout.splitlines() if (root / name).is_file()]
    return [str(path.relative_to(root)) for top in ('src', 'include', 'shaders', 'bench', 'test')
            for path in (root / top).rglob('*') if path.is_file() and path.suffix != '.pyc']


class Tree:
    def __init__(self, root):
        self.root, self.files = root, tracked(root)
        self.known = set(self.files)
        # A public header is of the room that has its source; one that is a header alone, of its own folder.
        self.sources = {name[4:].split('/')[0] + '/' + pathlib.PurePath(name).stem: os.path.dirname(name)
                        for name in self.files if name.startswith('src/') and name.endswith('.cpp')}

    def room(self, name):
        folder = os.path.dirname(name)
        public = re.match(r'include/viscera/([^/]+)', folder)
        if not public:
            return folder
        folder_of_source = self.sources.get(public.group(1) + '/' + pathlib.PurePath(name).stem)
        return folder_of_source if folder_of_source and public.group(1) != 'solver' else folder

    def included(self, name, text):
        for what in INCLUDE.findall(text):
            for place in (os.path.dirname(name), 'src', 'include', 'shaders', '.'):
                path = os.path.normpath(os.path.join(place, what))
                if path in self.known:
                    yield path
                    break

    def wrong_includes(self, order):
        for name in self.files:
            if not name.startswith(('src/', 'include/', 'shaders/')) or not name.endswith(CODE):
                continue
            room = self.room(name)
            if room not in order:
                yield f'{name}: ARCHITECTURE.md states no place in the order for {room}'
                continue
            for other in self.included(name, (self.root / name).read_text(errors='replace')):
                target = self.room(other)
                if target == room or order.get(target) == order[room]:
                    continue
                if target not in order or order[target][0] <= order[room][0]:
                    yield f'{name} includes {other}: {target} is not below {room} in ARCHITECTURE.md'

    def full_folders(self):
        count = {}
        for name in self.files:
            count[os.path.dirname(name)] = count.get(os.path.dirname(name), 0) + 1
        return [f'{folder}: {number} files, {MOST_FILES} at most' for folder, number in sorted(count.items()) if number > MOST_FILES]


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__).resolve()
    root = root if root.is_dir() else root.parent.parent
    tree, order = Tree(root), stated_order(root)
    wrong = tree.full_folders() + sorted(set(tree.wrong_includes(order)))
    wrong += [f'ARCHITECTURE.md: room {room} has no files' for room in order
              if not any(tree.room(name) == room for name in tree.files)]
    print('\n'.join(wrong) or f'{len(order)} rooms, {len(tree.files)} files: in order')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
