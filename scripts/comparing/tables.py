# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Tables of the page about large strain and motion, each a function of a row's results that returns lines."""
from comparing import motions, shells, strains

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
    out = ["A block of 24 x 24 x 36 mm, both ends clamped, one moved by a share of the height: error of the force in % at %s mm." %
           " and ".join("%g" % (MM * h) for h in strains.BLOCK_SPACINGS_M), ""]
    out += heading("moved", "nu", *("%g %%" % (PERCENT * share) for share in strains.SHARES))
    for run in found["runs"]:
        if run["program"] == "CalculiX":
            same = mine(found, way=run["way"], ratio=run["ratio"])
            out.append(row(run["way"], run["ratio"], *(listed(same, k) if run["forces_n"][k] is not None else "CalculiX stopped"
                                                       for k in range(len(strains.SHARES)))))
    return out


def press(found):
    """Returns the pressed sphere's forces."""
    out = ["A sphere of 15 mm pressed without friction into a block of 60 x 60 x 30 mm on a plate, nu 0.3: force, CalculiX's in N, error in %.", ""]
    out += heading("spacing", *("%g mm deep" % (MM * depth) for depth in strains.DEPTHS_M))
    out.append(row("CalculiX", *(number(force) for force in truth(found)["forces_n"])))
    out += [row("%g mm" % (MM * run["spacing_m"]), *map(signed, run["error"])) for run in mine(found)]
    return out


def swings(found):
    """Returns frequencies."""
    out = ["Frequencies at nu %g, CalculiX's in Hz, errors in %%, without damping. The plate (80 x 60 x 6 mm) and the ring (radii 27 and 33 mm, 6 mm high)" % motions.RATIO,
           "are free. With `mass_damping_per_s: %g` the cantilever's modes decay at %s /s (theory: %g)." %
           (motions.DAMPING_PER_S, ", ".join("%.3f" % d for run in mine(found) if run["damping_per_s"] for d in run["decay_per_s"]), motions.DAMPING_PER_S / 2), ""]
    out += heading("body", "CalculiX", "5.67 mm", "4 mm", "3 mm")
    for body in ("cantilever", "plate", "ring"):
        runs = {run["spacing_m"]: run for run in mine(found, body=body, damping_per_s=0.0)}
        out.append(row(body, ", ".join("%.3f" % hz for hz in truth(found, body=body)["hz"]),
                       *(", ".join(map(signed, runs[h]["error"])) if h in runs else "" for h in (0.00567, 0.004, 0.003))))
    return out


def snap(found):
    """Returns the bowl's forces."""
    out = ["A half sphere of radius 40 mm, wall 3 mm, nu %g, its rim held, is pushed in by a disc of %g mm radius at its pole. Its force falls from 10 %% of the"
           % (shells.BOWL_RATIO, MM * shells.DISC_M),
           "radius on: it snaps through. CalculiX's force in N (axisymmetric), errors in %. A grab holds nodes, so the disc's edge is known to a quarter of a",
           "spacing: that is what errors before the snap show. Roll-backs: %d." % sum(run["roll_backs"] for run in mine(found)), ""]
    out += heading("pushed by", *("%g %%" % (PERCENT * share) for share in shells.BOWL_SHARES))
    out.append(row("CalculiX", *(number(force) for force in truth(found)["forces_n"])))
    for run in mine(found):
        out.append(row("%g mm: force" % (MM * run["spacing_m"]), *map(signed, run["error"])))
    for run in mine(found):
        out.append(row("%g mm: shape, largest" % (MM * run["spacing_m"]), *("%.1f" % (PERCENT * e) for e in run["most"])))
    return out + ["", "![The bowl after the snap, and its section with CalculiX's](images/comparison_snap.png)"]


TABLES = {"swings": ("Motion", swings), "block": ("Large strain", block), "press": (None, press), "snap": ("A bowl that snaps through", snap)}
