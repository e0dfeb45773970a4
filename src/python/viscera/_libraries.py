# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Libraries of graphics drivers that a wheel has with it, for machines without them (scripts/package wheel)."""
import ctypes
import os


def load_missing():
    """Loads those of viscera/libraries/fallback that this machine has not; nothing where the folder is not there."""
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
