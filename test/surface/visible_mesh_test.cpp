// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/surface/visible_mesh.h"

#include <gtest/gtest.h>

#include "layout.h"
#include "support/temporary_folder.h"
#include "support/text.h"
#include "surface/visible_triangles.h"
#include "viscera/math/error.h"
#include "viscera/model/shape/mesh_import.h"

namespace viscera {
namespace {

/// Returns two bodies: a square of two triangles, and a flap of one that can split into vertices 7 to 12.
Model twoBodies() {
  Model model;
  model.bodies.resize(2);
  model.bodies[0].name = "square";
  model.bodies[1].name = "flap";
  model.bodies[1].color = Vector3d(0, 1, 0);
  model.bodies[0].skin.mesh.triangles = {{0, 1, 2}, {2, 1, 3}};
  model.bodies[1].skin.mesh.triangles = {{0, 1, 2}};
  return model;
}

class Shown : public ::testing::Test {
 protected:
  std::shared_ptr<const VisibleTopology> shown(const std::vector<uint32_t>& alive) {
    return triangles_.shown(alive.data());
  }

  const std::vector<uint32_t> all_ = {0, 1, 2, 2, 1, 3, 4, 5, 6};
  VisibleTriangles triangles_{twoBodies(), 13, all_, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7, 8, 9, 10, 11, 12}};
};

TEST_F(Shown, WholeSkinShowsEveryTriangleOfEveryBody) {
  const auto whole = triangles_.whole();
  EXPECT_EQ(whole->revision, 1u);
  EXPECT_EQ(whole->vertices, 13u);
  EXPECT_EQ(whole->triangles, all_);
  ASSERT_EQ(whole->bodies.size(), 2u);
  EXPECT_EQ(whole->bodies[1].name, "flap");
  EXPECT_EQ(whole->bodies[1].color, Vector3d(0, 1, 0));
  EXPECT_EQ(whole->patchOf(1).body, 0u);
  EXPECT_EQ(whole->patchOf(2).body, 1u);
  EXPECT_EQ(whole->patchOf(2).kind, SurfaceKind::kSkin);
}

TEST_F(Shown, TornTrianglesAreLeftOut) {
  const auto torn = shown({0, 1, 1});
  EXPECT_EQ(torn->triangles, (std::vector<uint32_t>{2, 1, 3, 4, 5, 6}));
  EXPECT_EQ(torn->patchOf(0).body, 0u);
  EXPECT_EQ(torn->patchOf(1).body, 1u);
  const auto gone = shown({0, 0, 1});
  ASSERT_EQ(gone->patches.size(), 2u);
  EXPECT_EQ(gone->patches[0].count, 0u);
  EXPECT_EQ(gone->patchOf(0).body, 1u);
}

TEST_F(Shown, SplitTrianglesAreInTheirPieces) {
  const auto split = shown({1, 1, layout::kShownCorner << 1 | layout::kShownRest << 1});
  EXPECT_EQ(split->triangles, (std::vector<uint32_t>{0, 1, 2, 2, 1, 3, 5, 9, 8, 10, 6, 4, 10, 4, 7}));
  EXPECT_EQ(split->patches[1].count, 3u);
}

TEST_F(Shown, TopologyIsSharedUntilSomethingElseIsShown) {
  EXPECT_EQ(shown({1, 1, 1}), triangles_.whole());
  const auto torn = shown({0, 1, 1});
  EXPECT_EQ(shown({0, 1, 1}), torn);
  EXPECT_NE(torn->revision, triangles_.whole()->revision);
  EXPECT_NE(shown({0, 0, 1})->revision, torn->revision);
  EXPECT_EQ(shown({1, 1, 1}), triangles_.whole());  // as after a reset
}

TEST_F(Shown, PlyIsReadBackAsItWasShown) {
  const test::TemporaryFolder folder;
  VisibleMesh mesh;
  mesh.topology = shown({0, 1, 1});
  for (size_t i = 0; i < 39; ++i) mesh.positions_m.push_back(0.001f * static_cast<float>(i * i));
  mesh.normals.assign(13, packNormal({0, 0, 1}));
  EXPECT_LT((mesh.normal(3) - Vector3f(0, 0, 1)).norm(), 1e-6f);
  writePly(mesh, folder.file("skin.ply"));
  const std::string text = test::readFile(folder.file("skin.ply"));
  EXPECT_NE(text.find("comment body 1 flap\n"), std::string::npos);
  EXPECT_EQ(text.size(), text.find("end_header\n") + 11 + 13 * 24 + 2 * 15);
  EXPECT_EQ(text.substr(text.size() - 2),
            std::string("\1\0", 2));  // the last face is the flap's, of the original surface
  const TriangleMesh read = importMesh(folder.file("skin.ply"), 1);
  ASSERT_EQ(read.triangles.size(), 2u);
  for (size_t t = 0; t < 2; ++t) {
    for (size_t i = 0; i < 3; ++i) {
      const Vector3f wanted = mesh.position_m(mesh.topology->triangles[3 * t + i]);
      EXPECT_EQ(read.positions_m[read.triangles[t][i]], wanted) << t << ' ' << i;
    }
  }
}

TEST_F(Shown, PlyThatCannotBeWrittenIsAnError) {
  VisibleMesh mesh;
  mesh.topology = triangles_.whole();
  mesh.positions_m.assign(39, 0.0f);
  mesh.normals.assign(13, 0u);
  EXPECT_THROW(writePly(mesh, "/no/such/folder/skin.ply"), Error);
}

}  // namespace
}  // namespace viscera
