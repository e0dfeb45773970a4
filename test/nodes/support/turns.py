# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Rotations as three rows of three, and vectors as three numbers."""
import math

IDENTITY = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


def transposed(m):
    return tuple(zip(*m))


def times(a, b):
    """Returns the product of two matrices, or of a matrix and a vector."""
    if isinstance(b[0], (tuple, list)):
        return tuple(tuple(sum(x * y for x, y in zip(row, column)) for column in zip(*b)) for row in a)
    return tuple(sum(x * y for x, y in zip(row, b)) for row in a)


def plus(a, b, share=1.0):
    return tuple(x + share * y for x, y in zip(a, b))


def length(a):
    return math.sqrt(sum(x * x for x in a))


def quaternion(m):
    """Returns x, y, z, w of a rotation, computed from the largest of the four."""
    trace = m[0][0] + m[1][1] + m[2][2]
    squares = [1 + 2 * m[i][i] - trace for i in range(3)] + [1 + trace]
    largest = max(range(4), key=lambda i: squares[i])
    s = 2 * math.sqrt(squares[largest])
    differences = (m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1])
    if largest == 3:
        return tuple(d / s for d in differences) + (s / 4,)
    out = [(m[largest][j] + m[j][largest]) / s for j in range(3)] + [differences[largest] / s]
    out[largest] = s / 4
    return tuple(out)


def rotation(x, y, z, w):
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
            (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
            (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
