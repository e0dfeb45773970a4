# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Graphics driver libraries in a wheel, for machines without them (scripts/package wheel)."""
import ctypes
import os


def load_missing():
    """Loads the libraries of viscera/libraries/fallback that this machine lacks; none if the folder does not exist."""
    folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "libraries", "fallback")
    try:
        with open(os.path.join(folder, "order.txt"), encoding="utf-8") as file:
            names = file.read().split()
    except OSError:
        return
    for name in names:
        try:
            ctypes.CDLL(name)
        except OSError:
            ctypes.CDLL(os.path.join(folder, name))
