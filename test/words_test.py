#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Checks how pages and comments are written: sentences that a reader finishes, the field's words, docstrings of functions that begin with a verb.
Usage: words_test.py [--list] [FILE|FOLDER]...   (without one: what CHECKED names)"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CHECKED = ['README.md', 'ARCHITECTURE.md', 'CONTRIBUTING.md', 'docs', 'include', 'src', 'shaders', 'bench', 'test', 'msg', 'srv']
LONGEST = 40       # words of a sentence; MuJoCo's pages have 4 % above it, Jolt's 6 %
LONG_SHARE = 0.03  # of a page's sentences
FEW = 1            # a short page may have one all the same
CODE = {'.h', '.cpp', '.glsl', '.comp', '.vert', '.frag', '.inc', '.msg', '.srv'}
AVOIDED = re.compile(r'\b(anew|heeds?|heeded|told|tells|(?:is|are) asked|whose|of what|that which|beside|for ever|to be had|the like|at first|'
                     r'newcomers?|as many as there are|void)\b', re.IGNORECASE)
OLD_NAMES = re.compile(r'\b(ThreadBodies|ThreadConfig|tie_thread|governor|Governor|dashpot_ratio|drag_per_s|mottling|wall_grain|FoldWatch|nodes_unfolded|'
                       r'mayBeCrushed|CellPull|CellMotion|SeenTarget|seen_light|SeenBurns|ShownMesh|PaleSkin|Fingers|DeviceEar|ToldStatus|ToldSimulators|'
                       r'stand_ins|heedPulls|heedFeeling|notePoses|noteTask|held_back|hands_anew|HelpingThreads|keep_up|KeepUp|ToolTarget|bury|'
                       r'place_m|places_m|placeOf|placesOf|MeshPlace|WoundPlace|FramePlace|BrickPlaces|way_m|ways_|wayOf|wayOfEdge|wayOfSurface|EdgeWay|most_way|'
                       r'under_way|told_s|told_n|told_rad|told_m_|wantsOf|HandsThere|HandMotions?|CpuHands|HandBuffers|handsForgotten|hand_scale|steered_hand|'
                       r'SutureChannels|ChannelLaw|BesideChannels|suture_channels|key_place|lookAt(?:Vertex|Edges?)|noteLooks|look_notes|with_look|noteRead|'
                       r'noteErrors|noteStretch|taskNoted|stylusTold|toldBy|giveWay|since_look_s_)\b')
OLD_NAMES_IN = {'src/model/scene/yaml/renamed_keys.cpp', 'test/cli/upgrade_test.cpp', 'test/words_test.py'}
ABBREVIATION = re.compile(r'\b(e\.g|i\.e|vs|Fig|Eq|Sec|approx|No|etc|al|p|pp)\.')
NO_VERBS = {'This', 'Its', 'As', 'Is', 'Was', 'Has', 'Does', 'Nodes', 'Cells', 'Always', 'Seconds', 'Metres', 'Values', 'Bytes', 'Forces', 'Springs',
            'Names', 'Words', 'Bodies', 'Options', 'Indices', 'Vertices', 'Faces', 'Weights', 'Units', 'Less', 'Us', 'Perhaps', 'Pairs', 'Rows'}


def proseOfPage(text):
    """Returns (line, paragraph) of a page of Markdown without code; a cell of a table is a paragraph."""
    out, current, start, fenced = [], [], 0, False
    for number, line in enumerate([*text.splitlines(), ''], 1):
        if line.lstrip().startswith('```'):
            fenced = not fenced
            line = ''
        elif fenced:
            continue
        stripped = line.strip()
        breaks = not stripped or stripped[0] in '|#>' or re.match(r'([*+-]|\d+\.)\s', stripped)
        if breaks and current:
            out.append((start, ' '.join(current)))
            current = []
        if stripped.startswith('|'):
            out += [(number, cell) for cell in re.split(r'(?<!\\)\|', stripped) if cell.strip()]
        elif stripped and not stripped.startswith('#'):
            start = start if current else number
            current.append(re.sub(r'^([*+>-]|\d+\.)\s', '', stripped))
    return out


def proseOfCode(path, text):
    """Returns (line, comment) of a source: consecutive lines of comments are one."""
    mark = r'#' if path.suffix in {'.msg', '.srv'} else r'//[/!]?<?'
    out, current, start = [], [], 0
    for number, line in enumerate([*text.splitlines(), ''], 1):
        alone = re.match(rf'\s*{mark}\s?(.*)', line)
        if alone and (not current or not re.match(r'@(param|return|throws)', alone[1].strip())):
            start = start if current else number
            current.append(alone[1].strip())
            continue
        if current:
            out.append((start, ' '.join(current)))
        current = [alone[1].strip()] if alone else []
        start = number
        trailing = None if alone else re.search(rf'\s{mark}\s(.*)$', line)
        if trailing:
            out.append((number, trailing[1]))
    return out


def withoutTargets(text):
    return re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', text)


def sentences(paragraph):
    plain = withoutTargets(re.sub(r'`[^`]*`', 'CODE', paragraph))
    plain = ABBREVIATION.sub(lambda m: m[1].replace('.', ''), plain)
    return [part for part in re.split(r'(?<=[.!?:;])\s+', plain) if part.strip()]


def words(sentence):
    return [word for word in sentence.split() if re.search(r'[A-Za-z]', word)]


def docstringsWithoutVerb(path, text):
    if path.suffix not in {'.h'}:
        return []
    wrong, lines, number = [], text.splitlines(), 0
    while number < len(lines):
        if not re.match(r'\s*///(?!<)', lines[number]):
            number += 1
            continue
        first = number
        while number < len(lines) and re.match(r'\s*///', lines[number]):
            number += 1
        code = lines[number].strip() if number < len(lines) else ''
        while code.startswith('template') and number + 1 < len(lines):
            number += 1
            code = lines[number].strip()
        function = re.match(r'[\w:<>,&*\s\[\]~]+\(', code) and not re.match(r'(class|struct|enum|using|namespace|static_assert|constexpr \w+ k|friend)\b', code)
        if not function or re.match(r'(explicit )?[A-Z]\w*\(', code) or code.startswith('~'):
            continue
        begin = re.sub(r'^\s*///\s*(@brief\s*)?', '', lines[first]).split()
        if begin and not begin[0].startswith('@') and not (re.fullmatch(r"[A-Z][a-z]+s", begin[0]) and begin[0] not in NO_VERBS):
            wrong.append((first + 1, f'a docstring of a function begins with a verb ("Returns"), not with "{begin[0]}"'))
    return wrong


def check(path):
    text = path.read_text(encoding='utf-8')
    page = path.suffix == '.md'
    prose = proseOfPage(text) if page else proseOfCode(path, text)
    wrong = [(line, f'"{match[0]}": plain words, please (CONTRIBUTING.md, Words)') for line, paragraph in prose
             for match in AVOIDED.finditer(withoutTargets(re.sub(r'`[^`]*`', '', paragraph)))]
    every = [(line, words(sentence)) for line, paragraph in prose for sentence in sentences(paragraph)]
    long = [(line, sentence) for line, sentence in every if len(sentence) > LONGEST]
    if len(long) > max(FEW, LONG_SHARE * len(every)):
        wrong += [(line, f'{len(sentence)} words in a sentence: {" ".join(sentence[:8])} ...') for line, sentence in long]
    if path.resolve().relative_to(ROOT).as_posix() not in OLD_NAMES_IN:
        wrong += [(number, f'"{match[0]}" is an old name: see `viscera upgrade` and docs/glossary.md') for number, line in enumerate(text.splitlines(), 1)
                  for match in OLD_NAMES.finditer(line)]
    return wrong + docstringsWithoutVerb(path, text)


def main():
    named = [name for name in sys.argv[1:] if not name.startswith('--')]
    files = []
    for name in named or CHECKED:
        path = pathlib.Path(name) if named else ROOT / name
        files += sorted(file for file in path.rglob('*') if file.suffix in CODE | {'.md'}) if path.is_dir() else [path]
    assert files, 'nothing to check'
    wrong = [f'{file}:{line}: {text}' for file in files for line, text in sorted(check(file))]
    print('\n'.join(wrong) or f'{len(files)} files: in plain words')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
