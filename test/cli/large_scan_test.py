#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A label map of 512 x 512 x 1000 voxels with six ellipsoids of the size of organs is imported within 1 GB of memory.

usage: large_scan_test.py COMMAND [--keep FILE]"""
import argparse
import gzip
import math
import pathlib
import re
import resource
import struct
import subprocess
import sys
import tempfile
import time

SIZE = (512, 512, 1000)
SPACING_MM = (0.8, 0.8, 1.0)
# Label, centre and half axes [mm]: two lungs, a heart between them, a liver, two kidneys.
ORGANS = [(1, (110, 200, 700), (55, 85, 140)), (2, (300, 200, 700), (55, 85, 140)), (3, (205, 180, 640), (50, 50, 60)),
          (4, (150, 190, 470), (90, 75, 70)), (5, (120, 280, 350), (30, 25, 55)), (6, (290, 280, 350), (30, 25, 55))]
MOST_BYTES = 10**9
SAME = 0.005  # relative to a volume: voxels of 1 mm, organs of 100 mm


def header():
    data = bytearray(352)
    struct.pack_into('<i', data, 0, 348)
    struct.pack_into('<8h', data, 40, 3, *SIZE, 1, 1, 1, 1)
    struct.pack_into('<2h', data, 70, 4, 16)
    struct.pack_into('<4f', data, 76, 1, *SPACING_MM)
    struct.pack_into('<f', data, 108, 352)
    struct.pack_into('<B', data, 123, 2)
    struct.pack_into('<h', data, 254, 1)
    struct.pack_into('<12f', data, 280, SPACING_MM[0], 0, 0, 0, 0, SPACING_MM[1], 0, 0, 0, 0, SPACING_MM[2], 0)
    struct.pack_into('<4s', data, 344, b'n+1\0')
    return bytes(data)


def sliceOf(k):
    spans = {}
    for label, middle, half in ORGANS:
        depth = 1 - ((k * SPACING_MM[2] - middle[2]) / half[2])**2
        if depth <= 0:
            continue
        for j in range(SIZE[1]):
            width = depth - ((j * SPACING_MM[1] - middle[1]) / half[1])**2
            if width <= 0:
                continue
            reach = half[0] * math.sqrt(width)
            first = math.ceil((middle[0] - reach) / SPACING_MM[0])
            spans.setdefault(j, []).append((first, math.floor((middle[0] + reach) / SPACING_MM[0]) + 1, label))
    out = bytearray(2 * SIZE[0] * SIZE[1])
    for j, row in spans.items():
        for first, end, label in row:
            at = 2 * (SIZE[0] * j + first)
            out[at:at + 2 * (end - first)] = struct.pack('<h', label) * (end - first)
    return bytes(out)


def write(path):
    with gzip.open(path, 'wb', compresslevel=1) as file:
        file.write(header())
        for k in range(SIZE[2]):
            file.write(sliceOf(k))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('command')
    parser.add_argument('--keep', type=pathlib.Path, help='writes the scan there, and keeps it')
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        scan = options.keep or pathlib.Path(folder) / 'large.nii.gz'
        write(scan)
        start = time.monotonic()
        ending = subprocess.run([options.command, 'import', str(scan), '--out', folder + '/out'], capture_output=True, text=True)
        wall_s = time.monotonic() - start
    most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024
    print(ending.stdout + ending.stderr + f'{wall_s:.1f} s, at most {most / 1e6:.0f} MB')
    faults = [] if ending.returncode == 0 else [f'status {ending.returncode}']
    for label, _, half in ORGANS:
        cm3 = 4 / 3 * math.pi * math.prod(half) / 1000
        said = re.search(rf'label {label}, ([\d.]+) cm3', ending.stdout)
        if not said or abs(float(said.group(1)) - cm3) > SAME * cm3:
            faults.append(f'label {label}: {said and said.group(1)} cm3, not {cm3:.1f}')
    if most > MOST_BYTES:
        faults.append(f'{most / 1e6:.0f} MB, more than {MOST_BYTES / 1e6:.0f}')
    print('\n'.join(faults))
    return 1 if faults else 0


if __name__ == '__main__':
    sys.exit(main())
