#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""A sweep in one process: force on a sphere at half its radius over Hertz's, by Poisson's ratio and spacing."""
import argparse
import itertools

import indentation

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--poisson", type=float, nargs="+", default=[0.25, 0.35, 0.45, 0.49])
parser.add_argument("--spacings-mm", type=float, nargs="+", default=[4, 2.67, 2])
options = parser.parse_args()

depth_m = 0.5 * indentation.RADIUS_M
print("nu    spacing [mm]  force [N]  over Hertz's")
for poisson, spacing_mm in itertools.product(options.poisson, options.spacings_mm):
    force_n = indentation.press([depth_m], 10e3, poisson, 1e-3 * spacing_mm)[0]
    print(f"{poisson:4.2f}  {spacing_mm:12.2f}  {force_n:9.4f}  {force_n / indentation.hertz(depth_m, 10e3, poisson):12.3f}")
