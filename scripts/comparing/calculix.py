# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Input decks of CalculiX, its runs, and what its tables say.

Every run is kept under the hash of its deck, so a deck that was solved before is not solved again. Lengths are in
metres, forces in newtons, stresses in pascals; nodes and elements are counted from 0 here and from 1 in the deck.
"""
import hashlib
import io
import os
import pathlib
import re
import resource
import subprocess
import tempfile

import numpy as np

MARGIN_S = 3600  # no run of the comparison takes this long [s]


def id_lines(ids):
    """Returns numbers as lines of a set of a deck."""
    ids = np.asarray(ids, int) + 1
    return "".join(", ".join(map(str, ids[i:i + 12])) + ",\n" for i in range(0, len(ids), 12))


def material_lines(law, young_pa, ratio):
    """Returns a material: "linear", or "neo_hooke": mu/2 (J^(-2/3) |F|^2 - 3) + K/2 (J - 1)^2."""
    if law == "linear":
        return "*ELASTIC\n%.9g, %.9g\n" % (young_pa, ratio)
    shear, bulk = young_pa / (2 * (1 + ratio)), young_pa / (3 * (1 - 2 * ratio))
    return "*HYPERELASTIC, NEO HOOKE\n%.9g, %.9g\n" % (shear / 2, 2 / bulk)


class Deck:
    """The model of a run; steps are added to it."""

    def __init__(self, solid, law="linear", parts=None, young_pa=20e3, ratio=0.3, density=1060.0):
        """@param parts: list of (elements, E [Pa], nu); None: one material"""
        self.out = io.StringIO()
        self.nonlinear = law != "linear"
        write = self.out.write
        write("*NODE, NSET=ALL\n")
        self.out.writelines("%d, %.12g, %.12g, %.12g\n" % (i + 1, *solid.nodes[i]) for i in solid.used)
        number = 0
        for kind, elements in solid.elements.items():
            if len(elements):
                write("*ELEMENT, TYPE=%s, ELSET=ALL\n" % kind)
            for element in elements:
                number += 1
                ids = [str(number), *(str(k + 1) for k in element)]
                write("\n".join(", ".join(ids[i:i + 12]) + "," for i in range(0, len(ids), 12)).rstrip(",") + "\n")
        for k, (elements, part_pa, part_ratio) in enumerate(parts or [(np.arange(number), young_pa, ratio)]):
            write("*ELSET, ELSET=P%d\n%s*MATERIAL, NAME=M%d\n" % (k, id_lines(elements), k))
            write(material_lines(law, part_pa, part_ratio))
            write("*DENSITY\n%.9g\n*SOLID SECTION, ELSET=P%d, MATERIAL=M%d\n" % (density, k, k))

    def node_set(self, name, nodes):
        """Adds a named set of nodes."""
        self.out.write("*NSET, NSET=%s\n%s" % (name, id_lines(nodes)))

    def hold(self, name, nodes, first=1, last=3):
        """Holds nodes along axes first to last (1 to 3) throughout."""
        if len(nodes):
            self.node_set(name, nodes)
            self.out.write("*BOUNDARY\n%s, %d, %d\n" % (name, first, last))

    def static(self, moves=(), gravity=None, shown="ALL", forces=(), reactions=(), totals=None, first=0.25, most=400):
        """Adds a static step. @param moves: list of (set, axis 1 to 3, displacement [m]) at its end; gravity: [m/s2];
        forces, reactions: sets of which the sum of reactions, or each one, is printed; totals: quantities of which the sum over all elements is."""
        write = self.out.write
        if self.nonlinear:
            write("*STEP, NLGEOM, INC=%d\n*STATIC\n%g, 1., 1e-6, %g\n" % (most, first, max(first, 0.25)))
        else:
            write("*STEP\n*STATIC\n")
        if gravity is not None:
            size = float(np.linalg.norm(gravity))
            write("*DLOAD\nALL, GRAV, %.9g, %.9g, %.9g, %.9g\n" % (size, *(np.asarray(gravity, float) / size)))
        for name, axis, metres in moves:
            write("*BOUNDARY\n%s, %d, %d, %.9g\n" % (name, axis, axis, metres))
        if shown:
            write("*NODE PRINT, NSET=%s, FREQUENCY=%d\nU\n" % (shown, most))
        for name in forces:
            write("*NODE PRINT, NSET=%s, TOTALS=ONLY, FREQUENCY=%d\nRF\n" % (name, most))
        for name in reactions:
            write("*NODE PRINT, NSET=%s, FREQUENCY=%d\nRF\n" % (name, most))
        if totals:
            write("*EL PRINT, ELSET=ALL, TOTALS=ONLY\n%s\n" % totals)
        write("*END STEP\n")

    def frequencies(self, count, shown):
        """Adds a step that finds the lowest modes."""
        self.out.write("*STEP\n*FREQUENCY\n%d\n*NODE PRINT, NSET=%s\nU\n*END STEP\n" % (count, shown))

    def raw(self, text):
        """Adds lines as they are."""
        self.out.write(text)


class Run:
    """What a run printed. tables: list of (title, time, rows); seconds: its processor time [s]; ended: whether all
    steps were finished."""

    def __init__(self, text, seconds, ended):
        self.text, self.seconds, self.ended = text, seconds, ended
        self.tables = list(tables_of(text))

    def displacements(self, count, of="displacements"):
        """Returns the displacement of nodes at the end of each step, (count, 3), NaN where none was printed; or their
        reactions, with "forces"."""
        out = []
        for title, _, rows in self.tables:
            if title.startswith(of):
                moved = np.full((count, 3), np.nan)
                moved[rows[:, 0].astype(int) - 1] = rows[:, 1:4]
                out.append(moved)
        return out

    def forces(self, name):
        """Returns the sum of reactions on a set at the end of each step, as (time, force) [N]."""
        return [(time, rows[-1][:3]) for title, time, rows in self.tables
                if title.startswith("total force") and (" " + name.lower() + " ") in title.lower() + " "]

    def modes(self):
        """Returns the frequencies [Hz]."""
        lines = re.findall(r"^\s+\d+\s+(\S+)\s+(\S+)\s+(\S+)\s+(\S+)\s*$", self.text.split("P A R T")[0], re.M)
        return [float(line[2]) for line in lines]


def tables_of(text):
    """Yields (title, time, rows) of the tables of a .dat file."""
    title, rows, time = None, [], 0.0
    for line in [*text.splitlines(), "end"]:
        words = line.split()
        if not words:
            continue
        if re.match(r"\s*[-+0-9.]", line):
            try:
                rows.append([float(word) for word in words])
            except ValueError:
                continue
        else:
            if title and rows and len({len(row) for row in rows}) == 1:
                yield title, time, np.array(rows)
            title, rows = line.strip(), []
            found = re.search(r"time\s+([-+0-9.Ee]+)", line)
            time = float(found.group(1)) if found else 0.0


def version():
    """Returns the version of CalculiX, as in "2.20"."""
    said = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout
    found = re.search(r"Version\s+(\S+)", said)
    return found.group(1) if found else "unknown"


def solve(deck, folder):
    """Returns the Run of a deck, from the folder if it is there. CalculiX uses one thread."""
    text = deck.out.getvalue()
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    kept = folder / (hashlib.sha256(text.encode()).hexdigest()[:20] + ".dat")
    if not kept.exists():
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        with tempfile.TemporaryDirectory(dir=folder) as work:
            pathlib.Path(work, "job.inp").write_text(text)
            environment = dict(os.environ, OMP_NUM_THREADS="1", CCX_NPROC_EQUATION_SOLVER="1")
            done = subprocess.run(["ccx", "-i", "job"], cwd=work, env=environment, capture_output=True, text=True,
                                  check=False, timeout=MARGIN_S)
            found = pathlib.Path(work, "job.dat")
            tables = found.read_text() if found.exists() else ""
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        ended = "Job finished" in done.stdout and "*ERROR" not in done.stdout
        if not tables:
            raise RuntimeError("CalculiX: " + (done.stdout + done.stderr)[-1500:])
        kept.write_text("%.3f %d\n%s" % (seconds, ended, tables))
    first, tables = kept.read_text().split("\n", 1)
    return Run(tables, float(first.split()[0]), first.split()[1] == "1")
