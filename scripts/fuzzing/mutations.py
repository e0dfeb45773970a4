# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Ways of spoiling a file: each takes a random generator and bytes, and gives bytes."""
import copy
import gzip
import json
import re
import struct
import zlib

from fuzzing import seeds

NUMBERS = ['nan', 'inf', '-inf', '-1', '0', '-0', '1e308', '-1e308', '1e-320', '1e9', '4294967295', '4294967296', '2147483648',
           '18446744073709551616', '99999999999999999999999999', '0.5', '1e', '0x7f', '', '--1', '1,5', '1e99999', '.']
WORDS = ['null', '~', '{}', '[]', '*a', '&a', '!!binary', '"', "'", '\x1b[31m', '\x07', '\x00', '\u202e', '\r', 'é', '|', '? :', '#',
         '%', '$End', '\\', '../../..', '/dev/null', 'a' * 3000, '\xff']
NUMBER = re.compile(rb'-?\d+(\.\d+)?([eE][-+]?\d+)?')
MANY = [2, 10, 1000, 100000]


def flipped(rng, data):
    out = bytearray(data)
    for _ in range(rng.choice([1, 1, 3, 20])):
        if out:
            out[rng.randrange(len(out))] ^= 1 << rng.randrange(8)
    return bytes(out)


def truncated(rng, data):
    return data[:rng.randrange(len(data) + 1)]


def chunkGone(rng, data):
    begin = rng.randrange(len(data) + 1)
    return data[:begin] + data[begin + rng.choice([1, 4, 30, 200]):]


def chunkRepeated(rng, data):
    begin = rng.randrange(len(data) + 1)
    chunk = data[begin:begin + rng.choice([1, 2, 8, 60])]
    return data[:begin] + chunk * min(rng.choice(MANY), 300000 // max(1, len(chunk))) + data[begin:]


def noise(rng, data):
    at = rng.randrange(len(data) + 1)
    return data[:at] + rng.randbytes(rng.choice([1, 4, 100])) + data[at:]


def lines(rng, data):
    """Deletes, doubles, moves or repeats a line."""
    parts = data.split(b'\n')
    at, to = rng.randrange(len(parts)), rng.randrange(len(parts))
    how = rng.randrange(4)
    if how == 0:
        del parts[at]
    elif how == 1:
        parts.insert(to, parts[at])
    elif how == 2:
        parts[at], parts[to] = parts[to], parts[at]
    else:
        parts[at:at] = [parts[at]] * min(rng.choice(MANY), 300000 // (len(parts[at]) + 1))
    return b'\n'.join(parts)


def numbers(rng, data):
    found = list(NUMBER.finditer(data))
    if not found:
        return noise(rng, data)
    at = rng.choice(found)
    return data[:at.start()] + rng.choice(NUMBERS).encode() + data[at.end():]


def words(rng, data):
    parts = re.split(rb'(\s+)', data)
    parts[rng.randrange(len(parts))] = rng.choice(WORDS).encode()
    return b''.join(parts)


def text(rng, data):
    return rng.choice([flipped, truncated, chunkGone, chunkRepeated, noise, lines, lines, numbers, numbers, numbers, words])(rng, data)


def fields(rng, data):
    """Overwrites 4 bytes by an extreme number."""
    value = rng.choice([struct.pack('<I', n) for n in (0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0xfffffffe, 1 << 24)] +
                       [struct.pack('<f', n) for n in (float('nan'), float('inf'), -float('inf'), 1e30, -1e30, 1e-40, 100)])
    at = rng.randrange(max(1, len(data) - 3))
    return data[:at] + value + data[at + 4:]


def binary(rng, data):
    return rng.choice([flipped, truncated, chunkGone, chunkRepeated, noise, fields, fields, fields, numbers])(rng, data)


def nestedYaml(rng, data):
    count = rng.choice([10, 500, 3000, 100000])
    opened, closed = rng.choice([(b'[', b']'), (b'{a: ', b'}'), (b'- ', b''), (b'? ', b'')])
    key = rng.choice([b'\nbodies: ', b'\nfoo: ', b'\nstrokes: ', b'\nname: '])
    return data + key + opened * count + closed * (count if rng.random() < 0.5 else 0) + b'\n'


def unknownKey(rng, data):
    key = rng.choice(['foo', 'spacing', '\x1b[2J', 'a' * 5000, '? [a, b]', '<<', '"\\u0000"', '"\\n"', '1', '*x', 'é'])
    return rng.choice([data + key.encode() + b': 1\n', data.replace(b'{', b'{' + key.encode() + b': 1, ', 1)])


def yaml(rng, data):
    return rng.choice([text, text, text, text, numbers, numbers, unknownKey, nestedYaml])(rng, data)


def places(tree, at=()):
    """Every path into a tree of maps and lists."""
    found = []
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else []
    for key, value in items:
        found.append(at + (key,))
        found += places(value, at + (key,))
    return found


def spoiltTree(rng, tree):
    tree = copy.deepcopy(tree)
    where = rng.choice(places(tree))
    holder = tree
    for key in where[:-1]:
        holder = holder[key]
    how = rng.randrange(4)
    if how == 0:
        del holder[where[-1]]
    elif how == 1 and isinstance(holder, list):
        holder += [copy.deepcopy(holder[where[-1]]) for _ in range(rng.choice([1, 5, 1000]))]
    else:
        holder[where[-1]] = rng.choice([None, True, -1, 0, 1, 2.5, 7, 1e308, 2**31, 2**32 - 1, 2**32, 2**63, 2**64 - 1, '', 'x' * 3000,
                                        '\x1b[31m', [], {}, [[]], [0], [-1], [9], {'a': 1}, '../../../../dev/zero', 5121])
    return tree


def grownTree(rng, tree):
    """Nodes within nodes: a chain, shared children, a circle; meshes of huge accessors."""
    tree = copy.deepcopy(tree)
    how, count = rng.randrange(4), rng.choice([5, 30, 300, 5000, 100000])
    if how == 0:
        tree['nodes'] = [{'children': [i + 1]} for i in range(count)] + [{'mesh': 0}]
    elif how == 1:
        count = min(count, 300)
        tree['nodes'] = [{'children': [i + 1, i + 1]} for i in range(count)] + [{'mesh': 0}]
    elif how == 2:
        tree['nodes'] = [{'children': [(i + 1) % count], 'mesh': 0} for i in range(min(count, 300))]
    else:
        tree['accessors'][rng.randrange(2)] = {'componentType': 5126, 'type': rng.choice(['VEC3', 'SCALAR', 'MAT4']),
                                               'count': rng.choice([10**6, 10**9, 2**31, 2**63])}
    return tree


def deepJson(rng, data):
    count = rng.choice([10, 900, 5000, 1000000])
    return data[:-1] + b', "extras": ' + rng.choice([b'[' * count + b']' * count, b'{"a":' * count + b'1' + b'}' * count]) + b'}'


def json_(rng, data):
    if rng.random() < 0.2:
        return deepJson(rng, data)
    try:
        tree = json.loads(data)
        return json.dumps(rng.choice([spoiltTree, spoiltTree, grownTree])(rng, tree)).encode()
    except (ValueError, LookupError, TypeError, RecursionError, AttributeError):  # it was spoilt before
        return text(rng, data)


def gltf(rng, data):
    return rng.choice([json_, json_, json_, text])(rng, data)


def glb(rng, data):
    json_bytes = int.from_bytes(data[12:16], 'little')
    if rng.random() < 0.4 or data[:4] != b'glTF' or 20 + json_bytes > len(data):
        return binary(rng, data)
    return seeds.glbOf(json_(rng, data[20:20 + json_bytes].rstrip()), data[28 + json_bytes:])


def gzipped(rng, data):
    """What is within is spoilt, what is around it, or both."""
    try:
        inner = gzip.decompress(data)
    except (OSError, EOFError, ValueError, zlib.error):  # it was spoilt before
        return binary(rng, data)
    out = gzip.compress(binary(rng, inner) if rng.random() < 0.8 else inner, 1, mtime=0)
    return binary(rng, out) if rng.random() < 0.3 else out


def header(rng, data):
    """A text header before data: the header is spoilt more often than what comes behind it."""
    end = max(data.find(b'\n\n'), data.find(b'LOCAL\n'))
    if end < 0 or rng.random() < 0.3:
        return binary(rng, data)
    return text(rng, data[:end]) + data[end:]


def options(rng, scene, option, commands=('run', 'run', 'run', 'run', 'anchor', 'fly', 'keys')):
    """Arguments of a command line with wrong values, unknown names, too many and too few."""
    words_of_option = option.split(' ', 1)
    if len(words_of_option) == 2:
        value = words_of_option[1]
        value = rng.choice([value, rng.choice(NUMBERS), rng.choice(WORDS), value + rng.choice(WORDS),
                            value.split('=')[0] + '=' + rng.choice(NUMBERS + WORDS), value + '[' * 3000])
        words_of_option[1] = value.replace('\0', '0')
    arguments = [rng.choice(commands), scene] + words_of_option
    if rng.random() < 0.2:
        del arguments[rng.randrange(len(arguments))]
    if rng.random() < 0.2:
        arguments.insert(rng.randrange(len(arguments) + 1), rng.choice(['--fly', '-x', '--', '', '--set', '\x1b[31m', 'a' * 3000]))
    return arguments
