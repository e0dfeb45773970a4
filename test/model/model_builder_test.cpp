// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <set>

#include "body_samples.h"

namespace viscera::test {
namespace {

Eigen::AlignedBox3d boundsOf(const Lattice& lattice) {
  Eigen::AlignedBox3d box;
  for (const uint32_t slot : lattice.active_slots) box.extend(lattice.restPosition(slot));
  return box;
}

TEST(BuildModel, ABoxIsCentredOnItsOriginWithAnExactSkin) {
  BodyConfig config = boxConfig({0.05, 0.04, 0.03}, 0.01);
  config.position_m = {1, 2, 3};
  const Body body = build(config);
  EXPECT_EQ(body.lattice.active_slots.size(), 6u * 5u * 4u);
  EXPECT_TRUE(
      boundsOf(body.lattice).isApprox(Eigen::AlignedBox3d(Vector3d(0.975, 1.98, 2.985), Vector3d(1.025, 2.02, 3.015))));
  EXPECT_EQ(openEdges(body.skin.mesh), 0u);
  EXPECT_NEAR(signedVolume(body.skin.mesh), 0.05 * 0.04 * 0.03, 1e-9);
  EXPECT_EQ(body.name, "slab");
}

TEST(BuildModel, ABoxOfUnevenSizeIsAsLargeAsItIs) {
  const Body body = build(boxConfig({0.05, 0.05, 0.014}, 0.01));
  EXPECT_EQ(body.lattice.nodes_per_axis, Vector3i(6, 6, 3));
  EXPECT_NEAR(signedVolume(body.skin.mesh), 0.05 * 0.05 * 0.014, 1e-9);
}

TEST(BuildModel, ABoxOfFullCellsOfUnevenSizeIsRoundedAndSaysSo) {
  BodyConfig config = boxConfig({0.05, 0.05, 0.014}, 0.01);
  config.material.law = Law::kSprings;
  const Body body = build(config);
  EXPECT_EQ(body.lattice.nodes_per_axis, Vector3i(6, 6, 2));
  EXPECT_TRUE(contains(body.notes.at(0), "rounded to whole cells")) << body.notes[0];
  EXPECT_NEAR(signedVolume(body.skin.mesh), 0.05 * 0.05 * 0.01, 1e-9);
}

TEST(BuildModel, TheSkinOfEitherLatticeIsBoundByTheMappingAskedFor) {
  constexpr uint32_t kKinds =
      layout::kInCellBit | layout::kInterpolatedBit | layout::kOneNodeBit | layout::kAlongNormalBit;
  const std::vector<std::pair<Mapping, uint32_t>> expected = {{Mapping::kOneToOne, layout::kOneNodeBit},
                                                              {Mapping::kConstant, 0},
                                                              {Mapping::kInterpolated, layout::kInterpolatedBit},
                                                              {Mapping::kAlongNormal, layout::kAlongNormalBit}};
  BodyConfig config = boxConfig({0.05, 0.04, 0.032}, 0.01);  // the last cells of a lattice are partly filled
  for (config.structure = Structure::kLattice;; config.structure = Structure::kExplicit) {
    for (const auto& [mapping, bits] : expected) {
      config.mapping = mapping;
      const Skin skin = build(config).skin;
      size_t as_asked = 0;
      for (const layout::SkinBinding& binding : skin.bindings) as_asked += (binding.springs & kKinds) == bits ? 1 : 0;
      EXPECT_EQ(as_asked + skin.constant_vertices, skin.bindings.size()) << static_cast<int>(mapping);
      EXPECT_GT(as_asked, skin.bindings.size() / 2) << static_cast<int>(mapping);
    }
    config.mapping = Mapping::kAuto;
    for (const layout::SkinBinding& binding : build(config).skin.bindings)
      ASSERT_EQ((binding.springs & layout::kInCellBit) != 0, config.structure == Structure::kLattice);
    if (config.structure == Structure::kExplicit) break;
  }
}

TEST(BuildModel, ThePoseTurnsTheGeometryAndNotTheLattice) {
  BodyConfig config = boxConfig({0.06, 0.04, 0.02}, 0.005);
  config.material.law = Law::kSprings;  // cells are counted below
  config.rotation_deg = {0, 0, 90};
  EXPECT_TRUE((boundsOf(build(config).lattice).sizes() - Vector3d(0.04, 0.06, 0.02)).norm() < 0.0051);
  config.rotation_deg = {0, 0, 45};
  const Body turned = build(config);
  const double volume = 0.06 * 0.04 * 0.02;
  EXPECT_NEAR(signedVolume(turned.skin.mesh), volume, 1e-3 * volume);
  EXPECT_EQ(openEdges(turned.skin.mesh), 0u);
  size_t cells = 0;  // every cell adds an eighth of its mass to each corner
  for (const uint32_t slot : turned.lattice.active_slots) cells += massEighths(turned.lattice.nodes[slot]);
  EXPECT_NEAR(static_cast<double>(cells) / 8 * std::pow(0.005, 3), volume, 0.1 * volume);
}

TEST(BuildModel, AMeshIsPlacedByItsPose) {
  BodyConfig config = meshConfig(boxMesh({0, 0, 0}, {0.03f, 0.02f, 0.01f}), 0.005);
  config.position_m = {1, 1, 1};
  config.rotation_deg = {0, 0, 90};
  const Eigen::AlignedBox3d bounds = boundsOf(build(config).lattice);
  EXPECT_LT((bounds.min() - Vector3d(0.98, 1, 1)).norm(), 1e-6) << bounds.min().transpose();
  EXPECT_LT((bounds.max() - Vector3d(1, 1.03, 1.01)).norm(), 1e-6) << bounds.max().transpose();
}

TEST(BuildModel, MeshFilesAreRelativeToTheScene) {
  BodyConfig config = meshConfig(boxMesh({0, 0, 0}, {0.03f, 0.02f, 0.01f}), 0.005);
  EXPECT_EQ(build(config).lattice.active_slots.size(), 7u * 5u * 3u) << "absolute";
  Scene scene = sceneOf(config);
  const std::filesystem::path path = config.mesh_file;
  scene.folder = path.parent_path().string();
  scene.bodies[0].mesh_file = path.filename().string();
  EXPECT_EQ(buildModel(scene).activeNodes(), 7u * 5u * 3u) << "relative";
  config.mesh_file = "/nowhere/organ.obj";
  EXPECT_TRUE(contains(errorOf<MeshError>(config), "/nowhere/organ.obj"));
}

TEST(BuildModel, AnInsideOutMeshGetsAnOutwardSkin) {
  const TriangleMesh sphere = sphereMesh({0, 0, 0}, 0.03f, 16);
  const Body body = build(meshConfig(turnedInsideOut(sphere), 0.006));
  EXPECT_NEAR(signedVolume(body.skin.mesh), signedVolume(sphere), 1e-3 * signedVolume(sphere));
}

TEST(BuildModel, TheSkinIsTheInputOrExtracted) {
  BodyConfig config = meshConfig(sphereMesh({0, 0, 0}, 0.03f, 64), 0.006);
  config.skin = SkinSource::kInput;
  const size_t input_faces = build(config).skin.mesh.triangles.size();
  EXPECT_EQ(input_faces, 64u * 2 * 126);
  config.skin = SkinSource::kVolume;
  EXPECT_LT(build(config).skin.mesh.triangles.size(), input_faces / 4);
  BodyConfig phantom = phantomConfig(0.008);
  phantom.skin = SkinSource::kInput;
  EXPECT_TRUE(contains(errorOf<SceneError>(phantom), "needs source: mesh"));
}

TEST(BuildModel, TargetNodesDecideTheSpacing) {
  BodyConfig phantom = phantomConfig(0);
  BodyConfig mesh = meshConfig(sphereMesh({0, 0, 0}, 0.03f, 24), 0);
  for (BodyConfig* config : {&phantom, &mesh}) {
    config->target_nodes = 3000;
    EXPECT_NEAR(static_cast<double>(build(*config).lattice.active_slots.size()), 3000, 60) << config->name;
  }
  BodyConfig box = boxConfig({0.05, 0.05, 0.05}, 0);
  box.target_nodes = 1000;
  EXPECT_EQ(build(box).lattice.active_slots.size(), 1000u);
  box.target_nodes = 3;
  EXPECT_TRUE(
      contains(errorOf<LatticeError>(box), "target_nodes 3 cannot be reached: the nearest possible number is 8 nodes"));
}

TEST(BuildModel, SpacingOutOfRangeNamesTheBodyAndWhatWouldDo) {
  for (BodyConfig config :
       {boxConfig({0.05, 0.05, 0.05}, 2), phantomConfig(2), meshConfig(sphereMesh({0, 0, 0}, 0.03f, 8), 2)}) {
    const std::string large = errorOf<LatticeError>(config);
    EXPECT_TRUE(contains(large, "body '" + config.name + "'")) << large;
    EXPECT_TRUE(contains(large, "spacing_m must be at most")) << large;
    config.spacing_m = 1e-7;
    const std::string small = errorOf<LatticeError>(config);
    EXPECT_TRUE(contains(small, "spacing_m >=")) << small;
  }
}

TEST(BuildModel, AMeshInMillimetresThatDoesNotFitIsAskedForItsUnit) {
  const BodyConfig config = meshConfig(boxMesh({0, 0, 0}, {100, 60, 50}), 0.001);
  const std::string message = errorOf<LatticeError>(config);
  EXPECT_TRUE(contains(message, "organ.obj' is 100 m wide; should it be unit_scale_m=0.001 (millimetres)?")) << message;
}

TEST(BuildModel, AMeshWithoutVolumeIsRefusedByItsFile) {
  TriangleMesh plane;
  plane.positions_m = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  plane.triangles = {{0, 1, 2}, {0, 2, 3}};
  plane.parts = {0, 0};
  plane.part_names = {"plane"};
  const std::string message = errorOf<MeshError>(meshConfig(plane, 0.1));
  EXPECT_TRUE(contains(message, "organ.obj") && contains(message, "encloses no volume")) << message;
}

TEST(BuildModel, NotesStateTheDecisions) {
  TriangleMesh apart = joined(sphereMesh({0, 0, 0}, 0.02f, 16, 2), sphereMesh({0.1f, 0, 0}, 0.01f, 16), false);
  apart.part_names = {"large", "small"};
  const Body body = build(meshConfig(apart, 0.004));
  std::string notes;
  for (const std::string& note : body.notes) notes += note + '\n';
  for (const char* piece : {"2 parts imported", "1 holes closed", "nodes (0 fixed)", "springs, spacing 4 mm",
                            "the lattice consists of 2 separate pieces", "skin: "}) {
    EXPECT_TRUE(contains(notes, piece)) << piece << " is missing in\n" << notes;
  }
}

TEST(BuildModel, WallsThatAreThinnerThanACellAreNamed) {
  const auto wallNotes = [](double spacing_m, Law law = Law::kSprings) {
    std::string notes;
    BodyConfig config = phantomConfig(spacing_m);
    config.material.law = law;
    for (const std::string& note : build(config).notes) {
      if (contains(note, "walls thinner")) notes += note;
    }
    return notes;
  };
  EXPECT_EQ(wallNotes(0.0042), "");  // as thick as the thinnest
  const std::string notes = wallNotes(0.006);
  for (const char* piece : {"aorta 4.2 mm", "left_atrium 4.5 mm", "a cell of 6 mm", "a spacing_m of at most 0.0042"}) {
    EXPECT_TRUE(contains(notes, piece)) << notes;
  }
  EXPECT_FALSE(contains(notes, "left_ventricle")) << notes;
  EXPECT_EQ(wallNotes(0.006, Law::kNeoHookean), "") << "cells that are tissue in part have no holes";
}

TEST(BuildModel, StagesAreReportedPerBody) {
  std::set<std::string> stages;
  buildModel(sceneOf(boxConfig({0.03, 0.03, 0.03}, 0.01)), [&](const std::string& stage, double fraction) {
    stages.insert(stage);
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
  });
  for (const char* stage : {"slab: voxelise", "slab: build lattice", "slab: bind skin"}) {
    EXPECT_EQ(stages.count(stage), 1u) << stage;
  }
}

TEST(BuildModel, SeveralBodiesFollowEachOtherInTheSlots) {
  Scene scene;
  scene.bodies = {boxConfig({0.03, 0.03, 0.03}, 0.01), boxConfig({0.05, 0.03, 0.03}, 0.01)};
  scene.bodies[1].name = "other";
  const Model model = buildModel(scene);
  const Body &a = model.bodies.at(0), &b = model.bodies.at(1);
  EXPECT_EQ(model.slotOffset(0), 0u);
  EXPECT_EQ(model.slotOffset(1), a.lattice.bricks.size() * layout::kBrickSlots);
  EXPECT_EQ(model.slots(), model.slotOffset(1) + b.lattice.nodes.size());
  EXPECT_EQ(model.activeNodes(), 4u * 4 * 4 + 6u * 4 * 4);
  EXPECT_EQ(model.springs(), a.lattice.springs() + b.lattice.springs());
  EXPECT_EQ(model.skinVertices(), a.skin.mesh.positions_m.size() + b.skin.mesh.positions_m.size());
  EXPECT_EQ(model.skinTriangles(), a.skin.mesh.triangles.size() + b.skin.mesh.triangles.size());
}

TEST(BuildModel, TheRealHeartBecomesABody) {
  BodyConfig config = phantomConfig(0.006);
  config.source = TissueSource::kMesh;
  config.mesh_file = realData("VH_M_Heart.glb");
  if (config.mesh_file.empty()) GTEST_SKIP() << "VH_M_Heart.glb not found; set VISCERA_TEST_DATA";
  const Body body = build(config);
  for (const std::string& note : body.notes) std::cout << note << '\n';
  EXPECT_GT(body.lattice.active_slots.size(), 2000u);
  EXPECT_EQ(body.lattice.part_names.size(), 14u);
  EXPECT_GT(body.skin.mesh.triangles.size(), 100000u);
}

}  // namespace
}  // namespace viscera::test
