// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numeric>

#include "body_samples.h"
#include "model/body/network_builder.h"

namespace viscera::test {
namespace {

constexpr double kNetworkSceneSinglePrecision = 2e-6;  ///< relative: vertices of a TriangleMesh are floats

Body bodyOf(const std::string& body_yaml, const std::string& rest = "") {
  return buildModel(parseScene("bodies: [{" + body_yaml + "}]\n" + rest, "s.yaml")).bodies.at(0);
}

template <class Expected>
void expectRefused(const std::string& body_yaml, const std::vector<std::string>& pieces) {
  try {
    bodyOf(body_yaml);
    ADD_FAILURE() << "built without an error: " << body_yaml;
  } catch (const Expected& error) {
    for (const std::string& piece : pieces) EXPECT_TRUE(contains(error.what(), piece)) << error.what();
  }
}

double massOf(const Body& body) {
  return std::accumulate(body.network->masses_kg.begin(), body.network->masses_kg.end(), 0.0);
}

bool hasNote(const Body& body, const std::string& piece) {
  return std::any_of(body.notes.begin(), body.notes.end(), [&](const std::string& n) { return contains(n, piece); });
}

std::string allNotes(const Body& body) {
  std::string out;
  for (const std::string& note : body.notes) out += note + '\n';
  return out;
}

std::vector<Vector3d> fixedPositions(const Body& body) {
  std::vector<Vector3d> out;
  for (const uint32_t slot : body.lattice.active_slots) {
    if (isFixed(body.lattice.nodes[slot])) out.push_back(restPosition(body, slot));
  }
  return out;
}

const std::string kSheet = "source: sheet, structure: surface, box_size_m: [0.3, 0.2, 0.01], spacing_m: 0.01";

TEST(NetworkScene, ASheetBecomesANetworkWithASkin) {
  const Body body = bodyOf(kSheet + ", thickness_m: 0.002, name: cloth, color: [0, 1, 0], force_n: [1, 2, 3]");
  ASSERT_TRUE(body.network.has_value());
  EXPECT_FALSE(body.network->of_lattice);
  EXPECT_EQ(body.lattice.active_slots.size(), 24u * 31);
  EXPECT_EQ(body.skin.mesh.positions_m.size(), body.lattice.active_slots.size());
  EXPECT_EQ(body.skin.mesh.triangles.size(), 2u * 23 * 30);
  EXPECT_EQ(body.color, Vector3d(0, 1, 0));
  EXPECT_EQ(body.force_n, Vector3d(1, 2, 3));
  const double area_m2 = 2 * 23 * 30 * 0.5 * std::sqrt(0.75) * 1e-4;
  EXPECT_NEAR(massOf(body), 1060 * 0.002 * area_m2, kNetworkSceneSinglePrecision * massOf(body));
  EXPECT_TRUE(hasNote(body, "network: 744 nodes (0 fixed), ")) << allNotes(body);
  EXPECT_TRUE(hasNote(body, "valence 2..6, mean length 10.0025 mm")) << allNotes(body);
}

TEST(NetworkScene, ThePoseTurnsTheNodes) {
  const Body body = bodyOf(kSheet + ", position_m: [1, 2, 3], rotation_deg: [90, 0, 0]");
  Eigen::AlignedBox3d box;
  for (const uint32_t slot : body.lattice.active_slots) box.extend(restPosition(body, slot));
  EXPECT_LT((box.center() - Vector3d(1, 2, 3)).norm(), 1e-6);
  EXPECT_LT(box.sizes().y(), 1e-6) << "it stands upright";
  EXPECT_NEAR(box.sizes().z(), 0.2, 0.01);
}

TEST(NetworkScene, SpheresHoldTheCornersOfASheet) {
  const Body body = bodyOf(kSheet + R"(, fixed: [
    {shape: sphere, center_m: [-0.15, -0.1, 0], radius_m: 0.006}, {shape: sphere, center_m: [0.15, -0.1, 0], radius_m: 0.006},
    {shape: sphere, center_m: [-0.15, 0.1, 0], radius_m: 0.006}, {shape: sphere, center_m: [0.15, 0.1, 0], radius_m: 0.006}])");
  const std::vector<Vector3d> held = fixedPositions(body);
  EXPECT_EQ(held.size(), 4u) << "one each";
  for (const Vector3d& p : held) EXPECT_LT((p.cwiseAbs() - Vector3d(0.15, 0.1, 0)).norm(), 0.001) << p.transpose();
  EXPECT_TRUE(hasNote(body, "(4 fixed)"));
}

TEST(NetworkScene, PlanesHoldTheEdgeOfASheet) {
  const Body body = bodyOf(kSheet + ", fixed: [{shape: plane, point_m: [0, 0.09, 0], normal: [0, -1, 0]}]");
  EXPECT_EQ(fixedPositions(body).size(), 2u * 31);
}

TEST(NetworkScene, ARegionThatHoldsNothingIsRefusedWithTheExtent) {
  expectRefused<SceneError>(kSheet + ", fixed: [{shape: sphere, center_m: [1, 0, 0]}]",
                            {"fixed[0] matches no node", "the body spans"});
  expectRefused<SceneError>(kSheet + ", fixed: [{shape: part, part: hem}]", {"no part 'hem'; the parts are sheet"});
  expectRefused<SceneError>(kSheet + ", fixed: [{shape: part, part: sheet}]", {"nothing can move"});
}

TEST(NetworkScene, PartsOfASurfaceCanBeHeld) {
  TriangleMesh mesh = boxMesh({0, 0, 0}, {0.03f, 0.03f, 0.03f});
  BodyConfig config = meshConfig(mesh, 0.01);
  config.structure = Structure::kSurface;
  config.fixed.resize(1);
  config.fixed[0].shape = FixedShape::kPart;
  config.fixed[0].part = mesh.part_names[0];
  Scene scene = sceneOf(config);
  scene.bodies.push_back(boxConfig({0.01, 0.01, 0.01}, 0.01));
  const Body body = buildModel(scene).bodies[0];
  EXPECT_EQ(fixedPositions(body).size(), body.lattice.active_slots.size());
}

TEST(NetworkScene, TargetNodesAreMetByFlatAndRoundSurfaces) {
  // For the ball and the box, numbers that they can have: 10 n^2 + 2 and 6 n^2 + 2.
  for (const auto& [source, nodes] : {std::make_pair("source: sheet, box_size_m: [0.3, 0.2, 1]", 3000),
                                      std::make_pair("source: ball, ball_radius_m: 0.05", 2562),
                                      std::make_pair("source: box, box_size_m: [0.1, 0.1, 0.1]", 2906)}) {
    const Body body = bodyOf(std::string(source) + ", structure: surface, target_nodes: " + std::to_string(nodes));
    EXPECT_NEAR(static_cast<double>(body.lattice.active_slots.size()), nodes, 0.02 * nodes) << source;
  }
}

TEST(NetworkScene, SurfacesOfSolidsHaveEdgesOfAboutOneSpacing) {
  for (const std::string source :
       {"source: phantom", "source: ball, ball_radius_m: 0.04", "source: box, box_size_m: [0.08, 0.04, 0.04]"}) {
    const Body body = bodyOf(source + ", structure: surface, spacing_m: 0.005");
    EXPECT_NEAR(body.network->meanLength(), 0.005, 0.25 * 0.005) << source;
  }
}

TEST(NetworkScene, PiecesOfASurfaceAreCounted) {
  const Body body = bodyOf("source: phantom, structure: surface, spacing_m: 0.005");
  EXPECT_TRUE(hasNote(body, "the network consists of 2 separate pieces"))
      << "chambers without a way out: " << allNotes(body);
  EXPECT_FALSE(hasNote(bodyOf("source: ball, structure: surface"), "separate pieces"));
}

TEST(NetworkScene, MeshesAreRefinedToOneSpacing) {
  BodyConfig config = meshConfig(boxMesh({0, 0, 0}, {0.04f, 0.04f, 0.04f}), 0.006);
  config.structure = Structure::kSurface;
  const Body body = build(config);
  for (const NetworkSpring& spring : body.network->springs) EXPECT_LE(spring.rest_length_m, 0.006);
  EXPECT_NEAR(massOf(body), 1060 * 0.001 * 6 * 0.04 * 0.04, kNetworkSceneSinglePrecision * massOf(body));
}

TEST(NetworkScene, ABallIsFilledOrHollow) {
  const Body solid =
      bodyOf("source: ball, ball_radius_m: 0.05, spacing_m: 0.005, position_m: [0.5, 0, 0], material: {law: springs}");
  EXPECT_FALSE(solid.network.has_value());
  const double volume_m3 = 4.0 / 3 * std::acos(-1.0) * 0.05 * 0.05 * 0.05;
  size_t eighths = 0;
  for (const uint32_t slot : solid.lattice.active_slots) eighths += massEighths(solid.lattice.nodes[slot]);
  EXPECT_NEAR(static_cast<double>(eighths) / 8 * 1.25e-7, volume_m3, 0.03 * volume_m3);
  EXPECT_NEAR(signedVolume(solid.skin.mesh), volume_m3, 0.03 * volume_m3);
  const Body hollow = bodyOf("source: ball, ball_radius_m: 0.05, spacing_m: 0.005, structure: surface");
  EXPECT_LT(hollow.lattice.active_slots.size(), solid.lattice.active_slots.size() / 2);
}

TEST(NetworkScene, AnExplicitLatticeIsTheLatticeWithLinks) {
  const std::string source = "source: phantom, spacing_m: 0.006, fixed: [{shape: part, part: aorta}]";
  const Body implicit = bodyOf(source + ", material: {law: springs}"), body = bodyOf(source + ", structure: explicit");
  ASSERT_TRUE(body.network.has_value());
  EXPECT_TRUE(body.network->of_lattice);
  EXPECT_EQ(body.lattice.active_slots, implicit.lattice.active_slots);
  EXPECT_EQ(body.network->springs.size(), implicit.lattice.springs());
  EXPECT_EQ(body.skin.mesh.triangles.size(), implicit.skin.mesh.triangles.size());
  EXPECT_EQ(fixedPositions(body).size(), fixedPositions(implicit).size());
  EXPECT_TRUE(hasNote(body, "explicit: ")) << allNotes(body);
}

TEST(NetworkScene, AnExplicitLatticeMayResistBending) {
  const std::string source = "source: box, box_size_m: [0.05, 0.05, 0.01], spacing_m: 0.01, structure: explicit";
  EXPECT_GT(bodyOf(source + ", bending_ratio: 0.5").network->springs.size(), bodyOf(source).network->springs.size());
}

TEST(NetworkScene, WhatDoesNotGoTogetherIsRefused) {
  const std::string ball = "source: ball, structure: surface";
  expectRefused<SceneError>(
      "source: sheet",
      {"s.yaml: body 'tissue'", "source: sheet needs structure surface, not lattice: a sheet has no volume"});
  expectRefused<SceneError>("source: sheet, structure: explicit", {"needs structure surface, not explicit"});
  expectRefused<SceneError>("source: ball, structure: tetrahedra",
                            {"s.yaml:1", "'bodies[0].structure: tetrahedra' was removed: use lattice", ".msh file"});
  expectRefused<SceneError>(ball + ", material: {poisson_ratio: 0.3}",
                            {"poisson_ratio other than 0.25", "needs structure lattice, not surface", "1/3"});
  expectRefused<SceneError>(ball + ", material: {weights: paper}", {"weights: paper needs structure lattice"});
  expectRefused<SceneError>(ball + ", parts: [{part: a}]", {"parts needs structure lattice or explicit"});
  expectRefused<SceneError>(ball + ", skin: volume", {"skin other than auto needs structure lattice or explicit"});
  expectRefused<SceneError>(ball + ", spacing_m: auto",
                            {"spacing_m: auto without target_nodes needs structure lattice"});
  expectRefused<SceneError>(ball + ", mapping: constant", {"mapping other than auto needs structure lattice"});
  expectRefused<SceneError>("bending_ratio: 0.1",
                            {"bending_ratio above 0 needs structure explicit or surface, not lattice"});
  expectRefused<LatticeError>(ball + ", spacing_m: 1", {"body 'tissue'", "larger than the whole body"});
  expectRefused<LatticeError>("source: sheet, structure: surface, box_size_m: [10, 10, 1], spacing_m: 1e-5",
                              {"more than 2e+07"});
  expectRefused<MeshError>("source: mesh, mesh_file: gone.msh", {"gone.msh", "no such file"});
}

TEST(NetworkScene, ConfigurationsMadeInCodeAreHeldToTheSameRules) {
  BodyConfig config;
  config.source = TissueSource::kSheet;
  EXPECT_TRUE(contains(errorOf<SceneError>(config), "source: sheet needs structure surface"));
}

TEST(NetworkScene, BodiesOfEveryKindGoTogether) {
  const Model model = buildModel(parseScene(R"(
bodies:
  - {name: cloth, source: sheet, structure: surface, box_size_m: [0.3, 0.2, 0.01], spacing_m: 0.02}
  - {name: ball, source: ball, spacing_m: 0.01}
  - {name: brick, source: box, spacing_m: 0.01, structure: explicit}
)",
                                            "s.yaml"));
  EXPECT_TRUE(model.hasNetwork());
  EXPECT_TRUE(model.hasLattice());
  EXPECT_EQ(model.slots() % layout::kBrickSlots, 0u);
  EXPECT_EQ(model.springs(), model.bodies[0].network->springs.size() + model.bodies[1].lattice.springs() +
                                 model.bodies[2].network->springs.size());
}

}  // namespace
}  // namespace viscera::test
