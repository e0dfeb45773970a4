#!/usr/bin/env python3
# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Memory does not grow with steps. Usage: memory_test.py [STEPS]"""
import gc
import os
import sys

import viscera

STEPS = int(sys.argv[1]) if len(sys.argv) > 1 else 20_000
MOST_GROWTH = 1 << 20  # bytes, after a tenth of the steps: what the allocator keeps in its pages moves by less
LOOKS = 50             # steps between looks at everything there is
SCENE = {
    "name": "small",
    "bodies": [{"name": "block", "source": "box", "box_size_m": [0.04, 0.04, 0.02], "spacing_m": 0.01,
                "fixed": [{"shape": "box", "min_m": [-1, -1, -1], "max_m": [1, 1, -0.009]}]}],
    "styluses": [{"name": "tool", "probe": {"radius_m": 0.012}}],
    "solver": {"backend": "cpu", "threads": 1},
}


def resident():
    """Bytes of this process in memory."""
    gc.collect()
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def look(session, vector):
    state = session.state()
    session.restore(state)
    arrays = session.skin(), session.fields(), session.positions_m, session.velocity_m_per_s, session.contacts, session.diagnostics
    vector.step()
    try:
        session.step([None] * 9)
        sys.exit("too many styluses were taken")
    except ValueError:
        pass
    return arrays, vector.positions_m, vector.wrenches, viscera.Scene(SCENE).keys


def main():
    session = viscera.Session(viscera.Scene(SCENE))
    vector = viscera.VectorSession(viscera.Scene(SCENE), 3, threads=2)
    before = 0
    for step in range(STEPS):
        height_m = 0.02 + 0.002 * (step % 11 - 5) / 5
        session.step([viscera.Stylus([0, 0, height_m])])
        session.wrenches
        if step % (LOOKS if STEPS <= 100_000 else LOOKS * 20) == 0:
            look(session, vector)
        if step == STEPS // 10:
            before = resident()
    growth = resident() - before
    print(f"{STEPS} steps: memory grew by {growth} bytes since the first tenth (at most {MOST_GROWTH})")
    sys.exit(growth > MOST_GROWTH)


if __name__ == "__main__":
    main()
