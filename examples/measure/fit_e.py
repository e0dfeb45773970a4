#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""E of a tissue from the measured force on a sphere at some depths: a file of lines `depth_mm,force_n` with a header, as
press.py writes it. Forces grow with E, so that one run is of all E; a second one, with what was found, says how well it fits."""
import argparse
import sys

import numpy as np

import indentation

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("measured")
parser.add_argument("--poisson", type=float, default=0.45)
parser.add_argument("--spacing-m", type=float, default=0.002)
options = parser.parse_args()

try:
    measured = np.atleast_2d(np.genfromtxt(options.measured, delimiter=",", skip_header=1, usecols=(0, 1)))
except (OSError, ValueError) as error:
    sys.exit(f"fit_e: {options.measured}: {error}")
if measured.size == 0 or not np.isfinite(measured).all() or (measured <= 0).any() or (np.diff(measured[:, 0]) <= 0).any():
    sys.exit(f"fit_e: {options.measured}: depths that rise and forces above 0 are wanted, one pair to a line")
depths_m, forces_n = 1e-3 * measured[:, 0], measured[:, 1]

FIRST_PA = 10e3
at_first = indentation.press(depths_m, FIRST_PA, options.poisson, options.spacing_m)
young_pa = FIRST_PA * (at_first @ forces_n) / (at_first @ at_first)
off = indentation.press(depths_m, young_pa, options.poisson, options.spacing_m) / forces_n - 1
print(f"E {young_pa:.0f} Pa; forces of a second run with it are off by {100 * off.min():+.1f} to {100 * off.max():+.1f} %")
