# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the page of the comparison, and its plot of error against time."""
import matplotlib
import numpy as np
matplotlib.use("Agg")
from matplotlib import pyplot  # pylint: disable=wrong-import-position

from comparing import calculix, shells, statics, tables
from comparing.tables import MM, PERCENT, signed

HANGING = [*statics.BODIES, "heart"]
TITLES = {"cantilever": "cantilever", "materials": "block of two materials", "tube": "bent tube", "bowl": "bowl", "bladder": "closed bladder",
          "heart": "heart"}
LIMIT_COARSE, LIMIT_FINE = 0.05, 0.03  # of the mean at the spacings above 3 mm, and at 3 mm
FINE_M = 0.0031
REASONS = {  # of misses
    "bowl": "a third of its strain energy is within 4 mm of the clamp (calculated), which a cell or two do not resolve",
    "bladder": "its wall leaves the clamp obliquely, and the clamp ends at nodes "
               "([verification.md](verification.md#organs-that-hang-under-their-weight))",
    "heart": "walls of 0.7 to 2 cells that meet at edges, where a wall has no single normal (supposed)",
}


def of(found, program, **keys):
    """Returns the runs of a program, with the finest spacing last."""
    runs = [run for run in found["runs"] if run["program"].startswith(program) and all(run.get(k) == v for k, v in keys.items())]
    return sorted(runs, key=lambda run: -run.get("spacing_m", 0))


def joined(runs, key, show):
    """Returns a value of several runs, parted by commas."""
    return ", ".join(show(run[key]) for run in runs if key in run)


def misses(results):
    """Yields (body, runs) with runs that miss a limit."""
    for name in HANGING:
        if name in results:
            limit = lambda run: LIMIT_FINE if run["spacing_m"] < FINE_M else LIMIT_COARSE
            missed = [run for run in of(results[name], "viscera") if abs(run["mean"]) > limit(run)]
            if missed:
                yield name, missed


def first_lines(results):
    """Returns the first paragraph: what was found, and what is missed and why."""
    missed = dict(misses(results))
    met = [TITLES[name] for name in HANGING if name in results and name not in missed]
    out = [f"Errors and processor time of viscera, CalculiX {calculix.version()} and Bullet 3.24 on the same bodies, by `scripts/compare`.",
           f"Limits under weight: the mean displacement within {PERCENT * LIMIT_COARSE:g} % of CalculiX's, and within {PERCENT * LIMIT_FINE:g} % at 3 mm.",
           f"Met by: {', '.join(met) or 'none'}." + (" Missed:" if missed else ""), ""]
    _, cheaper = bullet_table(results)
    if cheaper:
        out.insert(1, f"At an equal or smaller error viscera takes 1/{min(cheaper):.0f} to 1/{max(cheaper):.0f} of Bullet's processor time.")
    for name, runs in missed.items():
        fine, coarse = ([run["mean"] for run in runs if (run["spacing_m"] < FINE_M) == is_fine] for is_fine in (True, False))
        worst = [f"{signed(max(part, key=abs))} % {where}" for part, where in ((coarse, "at 4 or 5.67 mm"), (fine, "at 3 mm")) if part]
        out.append(f"* **{TITLES[name]}** ({', '.join(worst)}): {REASONS.get(name, 'the reason is not known')}.")
    return out


def hanging_table(results):
    """Returns the table of bodies that hang."""
    out = tables.heading("body", "nodes", "nu 0.3: mean", "largest", "nu 0.45: mean", "cost", "CalculiX: nodes, s")
    for name in HANGING:
        if name not in results:
            continue
        low, high = (of(results[name], "viscera", ratio=ratio) for ratio in statics.RATIOS)
        truth = of(results[name], "CalculiX")[0]
        cells = [TITLES[name], joined(low, "nodes", str), joined(low, "mean", signed), joined(low, "most", lambda e: "%.1f" % (PERCENT * e)),
                 joined(high, "mean", signed), joined(low, "cost", "{:.2g}".format), "%d, %.1f" % (truth["nodes"], truth["seconds"])]
        out.append(tables.row(*cells))
    return out


def cheapest_as_good(found, peer):
    """Returns viscera's cheapest run with at most the error of a peer's run, or None."""
    good = [run for run in of(found, "viscera", ratio=peer["ratio"]) if abs(run["mean"]) <= abs(peer["mean"]) and "cost" in run]
    return min(good, key=lambda run: run["cost"]) if good else None


def bullet_table(results):
    """Returns the table of Bullet, each run next to viscera's cheapest one with at most its error, and how many times
    cheaper that is."""
    out, cheaper = tables.heading("body", "law", "nodes", "mean", "cost", "viscera: mean, cost", "times cheaper"), []
    for name in HANGING:
        for run in of(results[name], "Bullet") if name in results else ():
            best = cheapest_as_good(results[name], run)
            if best:
                cheaper.append(run["cost"] / best["cost"])
            law = run["program"].split(", ")[1].replace("_", "-")
            out.append(tables.row(TITLES[name], law, run["nodes"], signed(run["mean"]), "%.2g" % run["cost"],
                                  "%s, %.2g" % (signed(best["mean"]), best["cost"]) if best else "none", "%.0f" % cheaper[-1] if best else ""))
    return out, cheaper


def creep(results):
    """Returns how far Bullet's bodies still move at their end [% of the largest displacement]."""
    return max((PERCENT * run["creep"] for found in results.values() for run in of(found, "Bullet")), default=0)


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


def draw_snap(place, path):
    """Draws the bowl after the snap: what a camera sees, and its section."""
    picture, section = np.load(place.folder / "snap.npy"), np.load(place.folder / "snap.npz")
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(8, 3.4), dpi=100)
    left.imshow(picture)
    left.set_axis_off()
    order = np.argsort(section["rest"][:, 0])
    for k, share in enumerate(shells.BOWL_SHARES):
        now = MM * (section["rest"] + section["moved"][k])[order]
        true = MM * (section["section"] + section["true"][k])
        for side in (-1, 1):
            part = now[side * now[:, 0] > 0]
            right.plot(part[:, 0], part[:, 2], "-", color="C%d" % k, label="%g %%" % (PERCENT * share) if side > 0 else None)
            right.plot(side * true[::6, 0], -true[::6, 1], "k.", markersize=3)
    right.set_aspect("equal")
    right.set_xlabel("mm, outside of the wall; dots: CalculiX")
    right.legend(fontsize=7, loc="upper center", title="pushed by", title_fontsize=7)
    figure.tight_layout()
    figure.savefig(path)
    pyplot.close(figure)


def origins(results):
    """Returns which rows were measured where, as one paragraph."""
    groups = {}
    for name, found in results.items():
        if name == "throughput":  # whose section says it
            continue
        groups.setdefault("%(processor)s, %(threads)d threads, %(date)s, commit %(commit)s" % found["machine"], []).append(name)
    return ["; ".join("%s: %s" % (place, ", ".join(names)) for place, names in groups.items()) + "."]


METHOD = """`scripts/compare [--only ROW]` repeats it and installs what it needs. CalculiX gets hexahedra of 20 nodes (the heart: tetrahedra of 10),
viscera their surface, Bullet five tetrahedra a box. The clamp is the same plane, E 20 kPa. Hollow bodies have `walls: rows`.

* Errors are those of equilibria at vertices. Mean: least-squares ratio of displacements, less 1. Largest: of a vertex, over the largest
  displacement. That is 0.05 % of the body's size (Bullet: 1 %), of the cantilever a tenth.
* Cost: processor seconds of stepping in a simulated second, one thread, no sleep; in turns, the least of two (Bullet above 3: of one). Bullet is implicit, 1/60 s.
* Large strain: neo-Hooke. CalculiX's volumetric energy is K/2 (J - 1)^2, viscera's as in [physics.md](physics.md) 1.
"""


def write(place, results, path, images):
    """Writes the page and its images."""
    lines = ["# Comparison with CalculiX and Bullet", "", *first_lines(results), ""]
    if any(name in results for name in HANGING):
        plot(results, images / "comparison.png")
        lines += ["![Error against processor time](images/comparison.png)", "", "## Under their weight", "",
                  "Errors in % and cost at nu 0.3 at 5.67, 4, 3 mm.", "", *hanging_table(results), "",
                  "Bullet's deformable tetrahedra, nu 0.3, and the cheapest run of viscera with at most that error. At the end, after",
                  f"{statics.BULLET_S:g} s, they move by at most {creep(results):.1f} % in a tenth of that time.", "", *bullet_table(results)[0], ""]
    for name, (title, table) in tables.TABLES.items():
        if name in results:
            lines += (["## " + title, ""] if title else []) + [*table(results[name]), ""]
    if "snap" in results:
        draw_snap(place, images / "comparison_snap.png")
    lines += ["## How it was measured", "", *METHOD.splitlines(), "", *origins(results), ""]
    path.write_text("\n".join(lines))
