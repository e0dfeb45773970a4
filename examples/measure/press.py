#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Force against depth of a sphere in a block, beside Hertz's law: a table, press.csv, and a plot where gnuplot is."""
import argparse
import os
import shutil
import subprocess

import numpy as np

import indentation

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--young-pa", type=float, default=10e3)
parser.add_argument("--poisson", type=float, default=0.45)
parser.add_argument("--spacing-m", type=float, default=0.002)
parser.add_argument("--out", default="out/press", help="folder")
options = parser.parse_args()

depths_m = indentation.RADIUS_M * np.array([0.1, 0.2, 0.3, 0.4, 0.5])
forces_n = indentation.press(depths_m, options.young_pa, options.poisson, options.spacing_m)
law_n = indentation.hertz(depths_m, options.young_pa, options.poisson)

os.makedirs(options.out, exist_ok=True)
table = os.path.join(options.out, "press.csv")
np.savetxt(table, np.column_stack([1e3 * depths_m, forces_n, law_n]), "%.6g", ",", header="depth_mm,force_n,hertz_n",
           comments="")
for depth_m, force_n, hertz_n in zip(depths_m, forces_n, law_n):
    print(f"{1e3 * depth_m:5.2f} mm  {force_n:7.4f} N  {force_n / hertz_n:5.3f} of Hertz's")
print(table)
if shutil.which("gnuplot"):
    plot = os.path.join(options.out, "press.png")
    subprocess.run(["gnuplot", "-e", f"set terminal png size 640,480; set output '{plot}'; set datafile separator ',';"
                    "set key left; set xlabel 'depth [mm]'; set ylabel 'force [N]';"
                    f"plot '{table}' skip 1 using 1:2 with linespoints title 'tissue', '' skip 1 using 1:3 with lines title 'Hertz'"],
                   check=True)
    print(plot)
