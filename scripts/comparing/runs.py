# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the compared programs: sessions of viscera and Bullet's world, each in a process and thread of its own."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
YOUNG_PA, DENSITY = 20e3, 1060.0
TICK_S = 1 / 60


class Place:
    """Folders and programs of a comparison. build: viscera's build folder."""

    def __init__(self, build):
        self.build = pathlib.Path(build).resolve()
        self.folder = self.build / "compare"
        self.cache = self.folder / "calculix"
        self.package = self.build / "devel" / "lib" / "python3" / "dist-packages"
        if not (self.package / "viscera").is_dir():
            sys.exit("scripts/compare: %s has no Python package of viscera; run scripts/build, or name its folder by --build" % self.build)
        self.folder.mkdir(exist_ok=True)
        self.kept_work = tempfile.TemporaryDirectory(dir=self.folder)
        self.work = pathlib.Path(self.kept_work.name)

    def bullet(self):
        """Returns the path of the program with Bullet's world, which it builds when it is first needed."""
        program, source = self.folder / "bullet_tetrahedra", HERE / "bullet_tetrahedra.cpp"
        if not program.exists() or program.stat().st_mtime < source.stat().st_mtime:
            flags = subprocess.run(["pkg-config", "--cflags", "bullet"], check=True, capture_output=True, text=True).stdout.split()
            subprocess.run(["g++", "-std=c++17", "-O3", "-march=native", *flags, str(source), "-o", str(program),
                            "-lBulletSoftBody", "-lBulletDynamics", "-lBulletCollision", "-lLinearMath"], check=True)
        return program


def say(*words):
    """Prints a line of progress."""
    print(time.strftime("%H:%M:%S"), *words, flush=True)


def simulate(place, kind, scene, **job):
    """Runs a job of simulate.py and returns its answer; "moved" of the answer is the array that it saved, if any."""
    points = job.pop("points", None)
    job.update(kind=kind, scene=scene, moved=str(place.work / "moved.npy"))
    if points is not None:
        job["points"] = str(place.work / "points.npy")
        np.save(job["points"], points)
    pathlib.Path(job["moved"]).unlink(missing_ok=True)
    done = subprocess.run([sys.executable, str(HERE / "simulate.py")], input=json.dumps(job), capture_output=True, text=True, check=False,
                          env=dict(os.environ, PYTHONPATH=str(place.package), PYTHONDONTWRITEBYTECODE="1"))
    if done.returncode:
        raise RuntimeError("viscera: " + done.stderr[-1500:])
    answer = json.loads(done.stdout.splitlines()[-1])
    if os.path.exists(job["moved"]):
        answer["moved"] = np.load(job["moved"])
    return answer


def hang_in_bullet(place, mesh, law, ratio, gravity, seconds, step_s=TICK_S):
    """Runs Bullet and returns its answer with "moved", the displacement of each node [m]. @param mesh: (nodes,
    tetrahedra, held nodes)"""
    nodes, cells, held = mesh
    fixed = np.zeros(len(nodes), int)
    fixed[held] = 1
    path, moved = place.work / "bullet.mesh", place.work / "bullet.moved"
    with open(path, "w") as out:
        out.write("%d %d\n" % (len(nodes), len(cells)))
        out.writelines("%.9g %.9g %.9g %d\n" % (*at, f) for at, f in zip(nodes, fixed))
        out.writelines("%d %d %d %d\n" % tuple(cell) for cell in cells)
    words = [law, YOUNG_PA, ratio, DENSITY, *gravity, step_s, seconds]
    done = subprocess.run([str(place.bullet()), str(path), str(moved), *map(str, words)], capture_output=True, text=True, check=True)
    return dict(json.loads(done.stdout.splitlines()[-1]), moved=np.loadtxt(moved))


def tissue(ratio, young_pa=YOUNG_PA, **keys):
    """Returns a material of a scene: the law, without damping."""
    return {"young_modulus_pa": young_pa, "poisson_ratio": ratio, "density_kg_per_m3": DENSITY, "law": "neo_hookean", **keys}


def hanging_scene(name, mesh_file, spacing_m, ratio, gravity, plane, **keys):
    """Returns a scene with one body from a mesh, held at a plane. @param plane: (point, normal)   @param keys: of its
    material, and `parts` of the body"""
    parts = keys.pop("parts", None)
    body = {"name": name, "source": "mesh", "mesh_file": str(mesh_file), "textures": False, "spacing_m": spacing_m,
            "material": tissue(ratio, **keys), "fixed": [{"shape": "plane", "point_m": list(plane[0]), "normal": list(plane[1])}]}
    if parts:
        body["parts"] = parts
    return {"name": name, "bodies": [body], "environment": {"gravity_m_per_s2": [float(g) for g in gravity]}}
