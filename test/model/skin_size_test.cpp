// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/skin_size.h"

#include <gtest/gtest.h>

#include "support/text.h"
#include "viscera/math/error.h"

using namespace viscera;

namespace {

/// Returns a small triangle, and a sheet of `edge_m` next to it.
TriangleMesh organAndSheet(float edge_m) {
  TriangleMesh mesh;
  mesh.part_names = {"liver", "drape"};
  mesh.positions_m = {{0, 0, 0},      {0.01f, 0, 0},       {0, 0.01f, 0}, {0, 0, 1},
                      {edge_m, 0, 1}, {edge_m, edge_m, 1}, {0, edge_m, 1}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {3, 5, 6}};
  mesh.parts = {0, 1, 1};
  return mesh;
}

}  // namespace

TEST(SkinSize, IsKnownWithinAFactorOfThreeBeforeItIsMade) {
  for (const double longest_m : {0.5, 0.11, 0.07, 0.03}) {
    const TriangleMesh mesh = organAndSheet(1);
    const auto made = static_cast<double>(refine(mesh, longest_m).triangles.size());
    EXPECT_LT(refinedTriangles(mesh, longest_m), 3 * made) << longest_m;
    EXPECT_GT(refinedTriangles(mesh, longest_m), made / 3) << longest_m;
  }
}

TEST(SkinSize, OfAStraySheetIsRefusedWithItsPartNumberAndKey) {
  EXPECT_NO_THROW(requireSkinSize(organAndSheet(1), 0.01, 1000000));
  const std::string said = test::messageOf<LatticeError>([] { requireSkinSize(organAndSheet(100), 0.002, 20000000); });
  EXPECT_TRUE(test::says(said, {"'drape'", "import_limits.max_triangles = 20000000"}));
}
