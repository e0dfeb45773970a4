# Copyright (c) 2026, the viscera authors
# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that hang under their weight: equilibria of viscera and of Bullet against CalculiX's."""
import numpy as np

from comparing import calculix, runs, solids

SPACINGS_M = (0.00567, 0.004, 0.003)
RATIOS = (0.3, 0.45)
SMALL_SHARE = 5e-4  # largest displacement over the body's size, where everything is linear
BULLET_SHARE = 0.01  # the same for Bullet's linear law, which is computed in float32 positions
FINEST_LEVEL = 2  # of bench/references/walls.py: its displacements are within 0.5 % of the limit
GRAVITY = 9.81
COST_TICKS, COST_TURNS = 30, 2
BULLET_S = 2.0  # simulated time until Bullet's body is at rest
BULLET_ONCE = 3  # above this many seconds a simulated second, one turn is enough


class Body:
    """A body that is compared: reference mesh, skin, plane that holds it, direction of gravity, size [m]."""

    def __init__(self, solid, held, plane, down, size_m, mirror=None, mirrored=(), soft=None, skin=None, **keys):
        self.solid, self.held, self.plane, self.down, self.size_m = solid, held, plane, np.array(down, float), size_m
        self.mirror, self.mirrored, self.soft, self.keys = mirror, np.setdiff1d(mirrored, held), soft, keys
        self.skin = skin or solids.Skin(solid, mirror, keys.pop("part_of", None))
        point, normal = (np.array(v, float) for v in plane)
        self.free = ((self.skin.at - point) @ normal > 1e-6) & self.skin.outside  # vertices that are compared

    def deck(self, ratio, gravity, law="linear"):
        """Returns CalculiX's deck of the body under its weight."""
        parts = None
        if self.soft is not None:
            stiff = np.setdiff1d(np.arange(len(self.solid.centres())), self.soft)
            parts = [(self.soft, runs.YOUNG_PA / 10, ratio), (stiff, runs.YOUNG_PA, ratio)]
        deck = calculix.Deck(self.solid, law, parts, runs.YOUNG_PA, ratio, runs.DENSITY)
        deck.hold("HELD", self.held)
        deck.hold("MIRROR", self.mirrored, (self.mirror or 0) + 1, (self.mirror or 0) + 1)
        deck.node_set("SHOWN", np.unique(self.skin.source))
        deck.static(gravity=gravity, shown="SHOWN", first=0.5)
        return deck

    def reference(self, place, ratio, law="linear", g=GRAVITY):
        """Returns CalculiX's displacements of the skin's vertices [m] under a gravity of g, and the run."""
        run = calculix.solve(self.deck(ratio, g * self.down, law), place.cache)
        if not run.ended:
            raise RuntimeError("CalculiX found no equilibrium under the weight")
        return self.skin.of(run.displacements(len(self.solid.nodes))[-1]), run


def plane_at(axis, at_m):
    """Returns the plane that holds what is beyond a position along an axis."""
    point, normal = np.zeros(3), np.zeros(3)
    point[axis], normal[axis] = at_m, -1
    return point.tolist(), normal.tolist()


def cantilever(level=1):
    """Returns a beam of 100 x 20 x 14 mm, held at x = -50 mm."""
    size = np.array([0.1, 0.02, 0.014])
    solid = solids.box(-size / 2, size / 2, [20 * level, 4 * level, 3 * level])
    held = solid.where(lambda x: x[:, 0] < -size[0] / 2 + 1e-9)
    return Body(solid, held, ((-size[0] / 2, 0, 0), (1, 0, 0)), (0, 0, -1), size[0])


def organ(name, level=FINEST_LEVEL):
    """Returns an organ of bench/references/walls.py, or its block of two materials."""
    planes = {"block": plane_at(0, 0.03), "tube": plane_at(2, 0), "bowl": plane_at(1, 0.025), "bladder": plane_at(2, 0.02)}
    sizes_m = {"block": 0.06, "tube": 0.095, "bowl": 0.08, "bladder": 0.072}
    solid, held, mirrored, mirror, soft = solids.organ(name, level)
    keys = {}
    if name == "block":
        keys = {"part_of": lambda x: "soft" if x[0] < solids.walls.Block.BORDER else "stiff"}
        down = (0, 0, -1)
    else:
        down, keys = solids.walls.ORGANS[name].load, {"walls": "rows"}
    return Body(solid, held, planes[name], down, sizes_m[name], mirror, mirrored, soft, **keys)


BODIES = {"cantilever": cantilever, "materials": lambda: organ("block"), "tube": lambda: organ("tube"), "bowl": lambda: organ("bowl"),
          "bladder": lambda: organ("bladder")}
BULLET_MESHES = {  # boxes of five tetrahedra: counts of the cantilever; size along the wall [m] and number across it
    "cantilever": [(20, 4, 3), (28, 6, 4)], "tube": [(0.006, 1), (0.004, 1)], "bowl": [(0.006, 1), (0.004, 1)],
    "bladder": [(0.006, 1)]}


def gravity_for(name, body, place, ratio):
    """Returns (law, gravity [m/s2], reference displacements, run): a sag of a tenth for the cantilever, else small strain."""
    if name == "cantilever":
        g = 0.25
        moved, run = body.reference(place, ratio, "neo_hooke", g)
        return g, moved, run
    moved, run = body.reference(place, ratio)
    share = SMALL_SHARE * body.size_m / np.linalg.norm(moved, axis=1).max()
    return GRAVITY * share, moved * share, run


def scene_of(name, body, place, spacing_m, ratio, g):
    """Returns viscera's scene of a body, and writes its mesh."""
    path = place.work / (name + ".obj")
    body.skin.write(path)
    keys = dict(body.keys)
    if body.soft is not None:
        keys["parts"] = [{"part": "soft", "young_modulus_pa": runs.YOUNG_PA / 10}, {"part": "stiff"}]
    return runs.hanging_scene(name, path, spacing_m, ratio, g * body.down, body.plane, **keys)


def settled(name, body, place, spacing_m, ratio, g, moved):
    """Returns the error of viscera's equilibrium, with the number of nodes and seconds."""
    answer = runs.simulate(place, "settle", scene_of(name, body, place, spacing_m, ratio, g), points=body.skin.at[body.free])
    return dict(solids.compare(answer["moved"], moved[body.free]), program="viscera", spacing_m=spacing_m, ratio=ratio,
                nodes=answer["nodes"], settle_s=answer["seconds"], far_m=answer["far"])


def bullet_mesh(name, body, size):
    """Returns a mesh of tetrahedra for Bullet."""
    if name != "cantilever":
        return solids.organ_tetrahedra(name, *size)
    low, high = body.solid.nodes.min(0), body.solid.nodes.max(0)
    nodes, cells, held = solids.tetrahedra(lambda *p: high - (high - low) * np.stack(p, -1), size)
    return nodes, cells, held


def in_bullet(name, body, place, size, ratio, law, g, moved):
    """Returns the error and the cost of Bullet's body. Its nodes are compared where they are vertices of the skin."""
    mesh = bullet_mesh(name, body, size)
    share = 1 if name == "cantilever" else BULLET_SHARE / SMALL_SHARE
    answer = runs.hang_in_bullet(place, mesh, law, ratio, g * share * body.down, BULLET_S)
    at = body.skin.at[body.free]
    apart = ((mesh[0][:, None, :] - at[None, :, :]) ** 2).sum(-1)
    on = np.sqrt(apart.min(1)) < 0.001  # a node of the surface; displacements vary by less than 0.2 % over a millimetre
    error = solids.compare(answer["moved"][on] / share, moved[body.free][apart.argmin(1)[on]])
    return dict(error, program="Bullet, " + law, ratio=ratio, nodes=answer["nodes"], cost=answer["cost"],
                creep=answer["creep_m"] / share / np.linalg.norm(moved, axis=1).max())


def measure(name, place, body):
    """Returns the results of one body: list of runs, in the order in which they were made."""
    out = []
    for ratio in RATIOS:
        g, moved, run = gravity_for(name, body, place, ratio)
        runs.say(name, "nu %g: CalculiX %d nodes, %.1f s" % (ratio, len(body.solid.used), run.seconds))
        out.append({"program": "CalculiX", "ratio": ratio, "nodes": len(body.solid.used), "seconds": run.seconds})
        for spacing_m in SPACINGS_M:
            out.append(settled(name, body, place, spacing_m, ratio, g, moved))
            runs.say(name, "nu %g, %.3g mm: mean %+.1f %%, rms %.1f %%, most %.1f %%" %
                     (ratio, 1e3 * spacing_m, *(100 * out[-1][k] for k in ("mean", "rms", "most"))))
    add_costs(name, body, place, out)
    return out


def add_costs(name, body, place, out):
    """Adds the processor time of a simulated second at nu 0.3, viscera and Bullet in turns: the least of the turns."""
    ratio = RATIOS[0]
    g, moved, _ = gravity_for(name, body, place, ratio)
    law = [("linear", size) for size in BULLET_MESHES.get(name, [])]
    if name == "cantilever":
        law.append(("neo_hooke", BULLET_MESHES[name][0]))
    peers = [None] * len(law)
    mine = [run for run in out if run["program"] == "viscera" and run["ratio"] == ratio]
    for turn in range(COST_TURNS):
        for k in range(max(len(mine), len(law))):
            if k < len(mine):
                answer = runs.simulate(place, "cost", scene_of(name, body, place, mine[k]["spacing_m"], ratio, g), ticks=COST_TICKS)
                mine[k]["cost"] = min(answer["cost"], mine[k].get("cost", np.inf))
                runs.say(name, "%.3g mm: %.3f s/s" % (1e3 * mine[k]["spacing_m"], answer["cost"]))
            if k < len(law) and (turn == 0 or peers[k]["cost"] < BULLET_ONCE):
                found = in_bullet(name, body, place, law[k][1], ratio, law[k][0], g, moved)
                if peers[k] is None or found["cost"] < peers[k]["cost"]:
                    peers[k] = found
                runs.say(name, "Bullet, %s, %d nodes: mean %+.1f %%, %.2f s/s" % (law[k][0], found["nodes"], 100 * found["mean"], found["cost"]))
    out += peers
