# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""The rows of the comparison: {name: function of a Place that returns the list of its runs}."""
from comparing import bends, heart, motions, shells, statics, strains, throughput

ROWS = {
    **{name: lambda place, name=name: statics.measure(name, place, statics.BODIES[name]()) for name in statics.BODIES},
    "heart": lambda place: statics.measure("heart", place, heart.body(place)),
    "block": strains.block,
    "press": strains.press,
    "swings": motions.swings,
    "snap": shells.bowl,
    "bend": bends.bend,
    "throughput": throughput.measure,
}
