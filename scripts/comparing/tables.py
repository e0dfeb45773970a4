# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of the page about large strain and motion, each a function of a row's results that returns lines."""
from comparing import bends, motions, shells, strains, throughput

PERCENT, MM = 100, 1e3


def row(*cells):
    """Returns a line of a table."""
    return "| " + " | ".join(map(str, cells)) + " |"


def heading(*cells):
    """Returns the first two lines of a table."""
    return [row(*cells), "|" + "---|" * len(cells)]


def signed(value):
    """Returns a relative error in %."""
    return "" if value is None else "%+.1f" % (PERCENT * value)


def number(value, digits=3):
    """Returns a value, or what says that there is none."""
    return "stopped" if value is None else "%.*g" % (digits, value)


def mine(found, **keys):
    """Returns viscera's runs with some values."""
    return [run for run in found["runs"] if run["program"] == "viscera" and all(run.get(k) == v for k, v in keys.items())]


def truth(found, **keys):
    """Returns CalculiX's run with some values."""
    return next(run for run in found["runs"] if run["program"] == "CalculiX" and all(run.get(k) == v for k, v in keys.items()))


def listed(runs, k):
    """Returns the errors of runs at the k-th load, parted by commas."""
    return ", ".join(signed(run["error"][k]) for run in runs)


def block(found):
    """Returns the clamped block's forces."""
    spacings = " and ".join("%g" % (MM * spacing_m) for spacing_m in strains.BLOCK_SPACINGS_M)
    out = ["A block of 24 x 24 x 36 mm, both ends clamped, one moved by a share of the height: error of the force in %",
           f"at {spacings} mm.", ""]
    out += heading("moved", "nu", *("%g %%" % (PERCENT * share) for share in strains.SHARES))
    for run in found["runs"]:
        if run["program"] == "CalculiX":
            same = mine(found, way=run["way"], ratio=run["ratio"])
            out.append(row(run["way"], run["ratio"], *(listed(same, k) if run["forces_n"][k] is not None else "CalculiX stopped"
                                                       for k in range(len(strains.SHARES)))))
    return out


def press(found):
    """Returns the pressed sphere's forces."""
    out = ["A sphere of 15 mm pressed without friction into a block of 60 x 60 x 30 mm on a plate, nu 0.3: force, CalculiX's in N, error in %.",
           "At 1 mm the contact is one or two cells wide, in both programs.", ""]
    out += heading("spacing", *("%g mm deep" % (MM * depth) for depth in strains.DEPTHS_M))
    out.append(row("CalculiX", *(number(force) for force in truth(found)["forces_n"])))
    out += [row("%g mm" % (MM * run["spacing_m"]), *map(signed, run["error"])) for run in mine(found)]
    return out


def swings(found):
    """Returns frequencies."""
    decays = ", ".join("%.3f" % decay for run in mine(found) if run["damping_per_s"] for decay in run["decay_per_s"])
    out = [f"Frequencies at nu {motions.RATIO:g}, CalculiX's in Hz, errors in %, without damping. The plate (80 x 60 x 6 mm) and the ring",
           f"(radii 27 and 33 mm, 6 mm high) are free. With `mass_damping_per_s: {motions.DAMPING_PER_S:g}` the cantilever's modes decay at",
           f"{decays} /s (theory: {motions.DAMPING_PER_S / 2:g}).", ""]
    out += heading("body", "CalculiX", "5.67 mm", "4 mm", "3 mm")
    for body in ("cantilever", "plate", "ring"):
        runs = {run["spacing_m"]: run for run in mine(found, body=body, damping_per_s=0.0)}
        out.append(row(body, ", ".join("%.3f" % hz for hz in truth(found, body=body)["hz"]),
                       *(", ".join(map(signed, runs[h]["error"])) if h in runs else "" for h in (0.00567, 0.004, 0.003))))
    return out


def snap(found):
    """Returns the bowl's forces."""
    rolled = sum(run["roll_backs"] for run in mine(found))
    out = [f"A half sphere of radius 40 mm, wall 3 mm, nu {shells.BOWL_RATIO:g}, its rim held, is pushed in by a disc of {MM * shells.DISC_M:g} mm radius at its pole.",
           "CalculiX's force in N (axisymmetric), errors in %. A grab holds nodes, so the disc's edge is known to a quarter of a",
           f"spacing. Roll-backs: {rolled}.", ""]
    out += heading("pushed by", *("%g %%" % (PERCENT * share) for share in shells.BOWL_SHARES))
    out.append(row("CalculiX", *(number(force) for force in truth(found)["forces_n"])))
    for run in mine(found):
        out.append(row("%g mm: force" % (MM * run["spacing_m"]), *map(signed, run["error"])))
    for run in mine(found)[-1:]:
        out.append(row("%g mm: shape, largest" % (MM * run["spacing_m"]), *("%.1f" % (PERCENT * e) for e in run["most"])))
    return out + ["", "![The bowl after the snap, and its section with CalculiX's](images/comparison_snap.png)"]


def bend(found):
    """Returns the bent tube's moments."""
    out = [f"A tube of {MM * bends.LENGTH_M:g} mm, radius {MM * bends.OUTER_M:g} mm, wall {MM * bends.WALL_M:g} mm, nu {bends.RATIO:g}, ends clamped, is bent along an arc:",
           "CalculiX's moment in N mm, errors in %.", ""]
    out += heading("bent by", *("%g deg" % degrees for degrees in bends.TURNS_DEG))
    out.append(row("CalculiX", *(number(None if moment is None else MM * moment) for moment in truth(found)["moments_nm"])))
    for run in mine(found):
        out.append(row("%g mm: moment" % (MM * run["spacing_m"]), *map(signed, run["error"])))
    for run in mine(found)[-1:]:
        out.append(row("%g mm: shape, largest" % (MM * run["spacing_m"]), *("%.1f" % (PERCENT * e) for e in run["most"])))
    return out


TABLES = {"swings": ("Motion", swings), "block": ("Large strain", block), "press": (None, press), "snap": ("Thin walls at large strain", snap), "bend": (None, bend),
          "throughput": (throughput.TITLE, throughput.section)}
