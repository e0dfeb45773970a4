# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Presses a sphere into a block of tissue; used by the scripts in this folder."""
import numpy as np

import viscera

RADIUS_M = 0.008
CLEAR_M = 0.004          # a probe that starts in or near tissue does not act until it has left it
SPEED_M_PER_S = 0.012
SETTLE_S = 0.5           # time until the force is constant, with the damping below
DRAG_PER_S = 30          # damping of the block


def scene(young_modulus_pa, poisson_ratio, spacing_m):
    """Returns a scene with a block of 10 x 10 x 5 radii, fixed at its bottom, and a sphere; no gravity."""
    size_m = np.array([10, 10, 5]) * RADIUS_M
    bottom_m = -0.5 * size_m[2]
    return viscera.Scene({
        "name": "indentation",
        "bodies": [{
            "name": "block", "source": "box", "box_size_m": [float(x) for x in size_m], "spacing_m": float(spacing_m),
            "material": {"young_modulus_pa": float(young_modulus_pa), "poisson_ratio": float(poisson_ratio),
                         "mass_damping_per_s": DRAG_PER_S},
            "fixed": [{"shape": "box", "min_m": [-1, -1, -1], "max_m": [1, 1, float(bottom_m + 1e-4)]}],
        }],
        "styluses": [{"name": "sphere", "probe": {"radius_m": RADIUS_M}}],
        "environment": {"gravity_m_per_s2": [0, 0, 0]},
    })


def press(depths_m, young_modulus_pa=10e3, poisson_ratio=0.45, spacing_m=0.25 * RADIUS_M):
    """Returns the static force on the sphere at each depth [N], (depths,). Depths must increase."""
    forces_n = []
    with viscera.Session(scene(young_modulus_pa, poisson_ratio, spacing_m)) as session:
        touching_m = 2.5 * RADIUS_M + RADIUS_M  # height of the tip at contact
        height_m = touching_m + CLEAR_M
        step_m = SPEED_M_PER_S * session.tick_s
        session.step([viscera.Stylus([0, 0, height_m])])
        for depth_m in depths_m:
            while height_m > touching_m - depth_m:
                height_m = max(height_m - step_m, touching_m - depth_m)
                session.step([viscera.Stylus([0, 0, height_m])])
            session.step([viscera.Stylus([0, 0, height_m])], n=round(SETTLE_S / session.tick_s))
            forces_n.append(session.wrenches[0][2])
    return np.array(forces_n)


def hertz(depths_m, young_modulus_pa, poisson_ratio):
    """Returns the force on a sphere in a half space [N], for depths well below its radius."""
    stiffness = 4 / 3 * young_modulus_pa / (1 - poisson_ratio ** 2) * np.sqrt(RADIUS_M)
    return stiffness * np.asarray(depths_m) ** 1.5
