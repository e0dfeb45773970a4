// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/shape/triangle_mesh.h"

#include "mesh_samples.h"

namespace viscera::test {
namespace {

constexpr double kSinglePrecision = 1e-6;  // relative

TEST(TriangleMesh, VolumeOfABoxIsExactAlsoFarFromTheOrigin) {
  EXPECT_NEAR(signedVolume(boxMesh({0, 0, 0}, {1, 2, 3})), 6, 1e-12);
  EXPECT_NEAR(signedVolume(boxMesh({1024, 1024, 1024}, {1025, 1026, 1027})), 6, 1e-12);
  EXPECT_NEAR(signedVolume(turnedInsideOut(boxMesh({0, 0, 0}, {1, 2, 3}))), -6, 1e-12);
  EXPECT_EQ(signedVolume({}), 0);
}

TEST(TriangleMesh, NormalsOfASphereArePointingOutward) {
  const Vector3f center(1, 2, 3);
  const TriangleMesh sphere = sphereMesh(center, 0.5f, 32);
  const std::vector<Vector3f> normals = vertexNormals(sphere);
  ASSERT_EQ(normals.size(), sphere.positions_m.size());
  for (size_t v = 0; v < normals.size(); ++v) {
    EXPECT_NEAR(normals[v].norm(), 1, kSinglePrecision);
    EXPECT_GT(normals[v].dot((sphere.positions_m[v] - center).normalized()), 0.99);
  }
}

TEST(TriangleMesh, NormalsAreWeightedByArea) {
  // A large upward face and a small sideways face meet in vertex 0.
  TriangleMesh mesh;
  mesh.positions_m = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  mesh.parts = {0, 0};
  const Vector3f expected = Vector3f(1, 0, 9).normalized();
  EXPECT_LT((vertexNormals(mesh)[0] - expected).norm(), kSinglePrecision);
}

TEST(TriangleMesh, AVertexWithoutAreaGetsAnUpwardNormal) {
  TriangleMesh mesh;
  mesh.positions_m = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 5, 5}};
  mesh.triangles = {{0, 1, 2}};
  mesh.parts = {0};
  for (const Vector3f& normal : vertexNormals(mesh)) EXPECT_EQ(normal, Vector3f::UnitZ());
}

TEST(TriangleMesh, RefiningLeavesNoEdgeTooLongAndNoCrack) {
  for (const TriangleMesh& mesh : {boxMesh({0, 0, 0}, {1, 2, 3}), sphereMesh({0, 0, 0}, 1, 6)}) {
    ASSERT_EQ(openEdges(mesh), 0u);
    for (const double longest : {0.7, 0.31, 0.1}) {
      const TriangleMesh fine = refine(mesh, longest);
      EXPECT_LE(longestEdge(fine), longest);
      EXPECT_EQ(openEdges(fine), 0u) << "an edge with a vertex of a neighbour in its middle is open";
      EXPECT_NEAR(signedVolume(fine), signedVolume(mesh), kSinglePrecision * signedVolume(mesh));
    }
  }
}

TEST(TriangleMesh, RefiningSplitsOnlyWhatIsTooLong) {
  const TriangleMesh sphere = sphereMesh({0, 0, 0}, 1, 6);
  const TriangleMesh same = refine(sphere, longestEdge(sphere));
  EXPECT_EQ(same.triangles, sphere.triangles);
  EXPECT_EQ(same.positions_m.size(), sphere.positions_m.size());
  // One long edge of one triangle: two triangles, one new vertex.
  TriangleMesh sliver;
  sliver.positions_m = {{0, 0, 0}, {2, 0, 0}, {1, 0.5f, 0}};
  sliver.triangles = {{0, 1, 2}};
  sliver.parts = {0};
  EXPECT_EQ(refine(sliver, 1.5).triangles.size(), 2u);
  EXPECT_EQ(refine(sliver, 1.5).positions_m.size(), 4u);
}

TEST(TriangleMesh, RefiningKeepsPartsWithTheirTriangles) {
  TriangleMesh two = joined(boxMesh({0, 0, 0}, {1, 1, 1}), boxMesh({2, 0, 0}, {3, 1, 1}), false);
  two.part_names = {"left", "right"};
  const TriangleMesh fine = refine(two, 0.3);
  ASSERT_EQ(fine.parts.size(), fine.triangles.size());
  EXPECT_EQ(fine.part_names, two.part_names);
  for (size_t t = 0; t < fine.triangles.size(); ++t) {
    EXPECT_EQ(fine.parts[t], fine.positions_m[fine.triangles[t][0]].x() > 1.5f ? 1 : 0);
  }
}

TEST(TriangleMesh, RefiningSplitsAnEdgeOfThreeTrianglesOnce) {
  TriangleMesh fan;
  fan.positions_m = {{0, 0, 0}, {0, 0, 1}, {0.6f, 0, 0.5f}, {-0.6f, 0, 0.5f}, {0, 0.6f, 0.5f}};
  fan.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  fan.parts = {0, 0, 0};
  const TriangleMesh fine = refine(fan, 0.9);
  EXPECT_EQ(fine.positions_m.size(), 6u);
  EXPECT_EQ(fine.triangles.size(), 6u);
}

}  // namespace
}  // namespace viscera::test
