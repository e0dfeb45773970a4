# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the page of the comparison, and its plot of error against time."""
import matplotlib
matplotlib.use("Agg")
from matplotlib import pyplot  # pylint: disable=wrong-import-position

from comparing import calculix, statics

HANGING = [*statics.BODIES, "heart"]
TITLES = {"cantilever": "cantilever", "materials": "block of two materials", "tube": "bent tube", "bowl": "bowl", "bladder": "closed bladder",
          "heart": "heart"}
LIMIT_COARSE, LIMIT_FINE = 0.05, 0.03  # of the mean at the spacings above 3 mm, and at 3 mm
FINE_M = 0.0031
REASONS = {
    "bladder": "its wall bends within two wall thicknesses of the clamp, where 0.5 to 1 cell shows one bend",
    "bowl": "at nu 0.45 the clamp also resists the wall's thinning, which varies within a cell there",
    "heart": "walls of 4 to 12 mm that meet at edges: there neither rows of nodes nor one direction across the wall exist",
    "tube": "the clamp, as in the bladder",
    "materials": "cells that the border crosses obliquely to the load",
    "cantilever": "a beam of 2.5 cells: the last half cell at its sides",
}
PERCENT, MM = 100, 1e3


def signed(value):
    """Returns a relative error in %."""
    return "%+.1f" % (PERCENT * value)


def of(found, program, **keys):
    """Returns the runs of a program, with the finest spacing last."""
    runs = [run for run in found["runs"] if run["program"].startswith(program) and all(run.get(k) == v for k, v in keys.items())]
    return sorted(runs, key=lambda run: -run.get("spacing_m", 0))


def joined(runs, key, show):
    """Returns a value of several runs, parted by slashes."""
    return " / ".join(show(run[key]) for run in runs if key in run)


def misses(results):
    """Yields (body, runs) with runs that miss a limit."""
    for name in HANGING:
        if name in results:
            missed = [run for run in of(results[name], "viscera") if abs(run["mean"]) > (LIMIT_FINE if run["spacing_m"] < FINE_M else LIMIT_COARSE)]
            if missed:
                yield name, missed


def first_lines(results):
    """Returns the first paragraph: what was found, and what is missed and why."""
    missed = dict(misses(results))
    met = [TITLES[name] for name in HANGING if name in results and name not in missed]
    out = ["Errors and processor time of viscera, CalculiX %s and Bullet 3.24 on the same bodies, written by `scripts/compare`. Limits: the mean"
           % calculix.version(),
           "displacement within 5 % of CalculiX's, and within 3 % at a spacing of 3 mm. They are met by: %s. Missed:" % ", ".join(met), ""]
    for name, runs in missed.items():
        worst = "; ".join("nu %g, %.3g mm: %s %%" % (run["ratio"], MM * run["spacing_m"], signed(run["mean"])) for run in runs)
        out.append("* **%s** (%s): %s." % (TITLES[name], worst, REASONS[name]))
    return out


def hanging_table(results):
    """Returns the table of bodies that hang."""
    out = ["| body | nodes | nu 0.3: mean | largest | nu 0.45: mean | largest | s per s | CalculiX |", "|---|---|---|---|---|---|---|---|"]
    for name in HANGING:
        if name not in results:
            continue
        low, high = (of(results[name], "viscera", ratio=ratio) for ratio in statics.RATIOS)
        truth = of(results[name], "CalculiX")[0]
        cells = [TITLES[name], joined(low, "nodes", "{:,}".format), joined(low, "mean", signed), joined(low, "most", lambda e: "%.1f" % (PERCENT * e)),
                 joined(high, "mean", signed), joined(high, "most", lambda e: "%.1f" % (PERCENT * e)), joined(low, "cost", "{:.2g}".format),
                 "%s nodes, %.1f s" % ("{:,}".format(truth["nodes"]), truth["seconds"])]
        out.append("| " + " | ".join(cells) + " |")
    return out


def bullet_table(results):
    """Returns the table of Bullet, each run next to the cheapest run of viscera with at most its error."""
    out = ["| body | law | nodes | mean | s per s | viscera at most that error | times cheaper |", "|---|---|---|---|---|---|---|"]
    for name in HANGING:
        for run in of(results.get(name, {"runs": []}), "Bullet"):
            better = [mine for mine in of(results[name], "viscera", ratio=run["ratio"]) if abs(mine["mean"]) <= abs(run["mean"]) and "cost" in mine]
            best = min(better, key=lambda mine: mine["cost"]) if better else None
            mine = "%.3g mm, %s %%, %.2g" % (MM * best["spacing_m"], signed(best["mean"]), best["cost"]) if best else "none"
            times = "%.0f" % (run["cost"] / best["cost"]) if best else ""
            out.append("| %s | %s | %s | %s | %.2g | %s | %s |" % (TITLES[name], run["program"].split(", ")[1].replace("_", "-"), "{:,}".format(run["nodes"]),
                                                             signed(run["mean"]), run["cost"], mine, times))
    return out


def plot(results, path):
    """Draws errors against processor time."""
    figure, axes = pyplot.subplots(figsize=(7, 4.2), dpi=100)
    for k, name in enumerate(name for name in HANGING if name in results):
        mine = [run for run in of(results[name], "viscera", ratio=statics.RATIOS[0]) if "cost" in run]
        axes.loglog([run["cost"] for run in mine], [PERCENT * abs(run["mean"]) for run in mine], "o-", color="C%d" % k, label=TITLES[name])
        peers = of(results[name], "Bullet, linear")
        axes.loglog([run["cost"] for run in peers], [PERCENT * abs(run["mean"]) for run in peers], "x--", color="C%d" % k)
    axes.plot([], [], "ko-", label="viscera")
    axes.plot([], [], "kx--", label="Bullet, linear")
    axes.set_xlabel("processor seconds per simulated second, one thread")
    axes.set_ylabel("mean error against CalculiX [%]")
    axes.grid(True, which="both", alpha=0.25)
    axes.legend(fontsize=8, ncol=2)
    figure.tight_layout()
    figure.savefig(path)
    pyplot.close(figure)


def origins(results):
    """Returns which rows were measured where."""
    groups = {}
    for name, found in results.items():
        machine = found["machine"]
        groups.setdefault("commit %(commit)s, %(date)s, %(processor)s, %(threads)d threads" % machine, []).append(name)
    return ["* %s: %s." % (", ".join(names), place) for place, names in groups.items()]


METHOD = """`scripts/compare [--only ROW]` repeats it. It installs CalculiX, Bullet and the rest by
`scripts/install_packages compare`, which nothing else needs.

* Each body is one mesh: hexahedra of 20 nodes for CalculiX (the heart: tetrahedra of 10 by tetgen), their surface for viscera, five tetrahedra a
  box for Bullet. The clamp is the same plane. E is 20 kPa, the density 1060 kg/m3. Hollow bodies have `walls: rows`.
* The error is that of the equilibrium at the surface's vertices. Mean: the least-squares ratio of displacements, less 1 (below 0: too stiff).
  Largest: of any vertex, over the largest displacement. The largest displacement is 0.05 % of the body's size, so the material law does not
  count. Only the cantilever sags by a tenth: neo-Hooke in both programs.
* s per s: processor seconds of stepping alone in one simulated second, in one thread, the least of two turns, without sleep. Programs take
  turns. Bullet steps implicitly at 1/60 s, for three seconds from rest."""


def write(results, path, images):
    """Writes the page and its images."""
    lines = ["# Comparison with CalculiX and Bullet", "", *first_lines(results), ""]
    if any(name in results for name in HANGING):
        plot(results, images / "comparison.png")
        lines += ["![Error against processor time](images/comparison.png)", "", "## Under their weight", "",
                  "Errors in % at 5.67 / 4 / 3 mm; `s per s` is the cost at nu 0.3.", "", *hanging_table(results), "",
                  "Bullet's deformable tetrahedra, nu 0.3:", "", *bullet_table(results), ""]
    lines += ["## How it was measured", "", *METHOD.splitlines(), "", *origins(results), ""]
    path.write_text("\n".join(lines))
