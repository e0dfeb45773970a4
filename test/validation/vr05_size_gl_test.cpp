// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "support/gpu_fixture.h"
#include "surface/surface.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// VR05 section 3: a box of 100 x 100 x 100 with 42,745 particles, and a surface of 31,320 faces.
constexpr size_t kNodes = 42745, kFaces = 31320;
constexpr int kNodesPerAxis = 100;

/// Returns three crossed beams that span the box: as sparse a filling as a hollow organ, in one piece.
Solid crossedBeams() {
  constexpr int kFrom = 44, kTo = 56;  // 12 cells, 13 nodes wide; one cell less along the second side
  Solid solid;
  solid.spacing_m = 0.001;
  solid.cells = Vector3i::Constant(kNodesPerAxis - 1);
  solid.part_names = {"beams"};
  solid.labels.resize(static_cast<size_t>(solid.cells.cast<int64_t>().prod()));
  const auto inside = [](int a, int from, int to) { return a >= from && a < to; };
  for (int z = 0; z < solid.cells.z(); ++z)
    for (int y = 0; y < solid.cells.y(); ++y)
      for (int x = 0; x < solid.cells.x(); ++x) {
        const bool along_x = inside(y, kFrom, kTo) && inside(z, kFrom, kTo - 1);
        const bool along_y = inside(x, kFrom, kTo) && inside(z, kFrom, kTo - 1);
        const bool along_z = inside(x, kFrom, kTo) && inside(y, kFrom, kTo - 1);
        solid.labels[solid.index(x, y, z)] = along_x || along_y || along_z ? 1 : 0;
      }
  return solid;
}

}  // namespace

class Vr05Size : public GpuTest {};

TEST_F(Vr05Size, BoxOfAHundredCubedLoadsAndRuns) {
  const Solid solid = crossedBeams();
  Body body;
  body.name = "beams";
  body.lattice = buildLattice(solid, Weights::kCell);
  EXPECT_EQ(body.lattice.nodes_per_axis, Vector3i::Constant(kNodesPerAxis));
  EXPECT_NEAR(static_cast<double>(body.lattice.active_slots.size()), kNodes, 0.02 * kNodes);
  // Work and memory follow the nodes, not the box: bricks without nodes do not exist.
  EXPECT_LT(body.lattice.nodes.size(), 2 * body.lattice.active_slots.size());
  body.skin = bindSkin(extractSkin(solid), body.lattice, solid);
  EXPECT_GT(body.skin.mesh.triangles.size(), kFaces);
  const Model model = modelOf({body});
  GpuSolver solver(model, sceneFor(model, 20, {}, Vector3d(0, 0, -9.81)));
  Surface surface(model);
  solver.step({});
  surface.follow(solver.state());
  layout::TickStats stats{};
  while (solver.pollStats(stats, true)) {
  }
  EXPECT_EQ(stats.nonfinite, 0u);
  EXPECT_GT(stats.max_speed_bits, 0u);
}
