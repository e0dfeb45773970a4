// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "viscera/model/model.h"
#include "viscera/tools/strokes.h"

namespace viscera {
namespace {

namespace fs = std::filesystem;

const fs::path kConfig = fs::path(VISCERA_SOURCE_DIR) / "config";
constexpr double kCoarseM = 0.008;  ///< quick to build, and still fine enough for every wall of an organ to be there

std::vector<fs::path> filesIn(const char* folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(kConfig / folder)) out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

std::string nameOf(const ::testing::TestParamInfo<fs::path>& info) {
  std::string name = info.param.stem().string();
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
}

/// The scene with every body made coarse.
Scene coarse(const fs::path& file) {
  Scene scene = loadScene(file.string());
  for (BodyConfig& body : scene.bodies) {
    body.target_nodes = 0;
    body.spacing_m = std::max(body.spacing_m, kCoarseM);
  }
  return scene;
}

class ShippedScene : public ::testing::TestWithParam<fs::path> {};

TEST_P(ShippedScene, LoadsAndBuilds) {
  const Scene scene = coarse(GetParam());
  for (const BodyConfig& body : scene.bodies) {
    if (body.source == TissueSource::kMesh && !fs::exists(fs::path(scene.folder) / body.mesh_file)) {
      GTEST_SKIP() << "mesh file " << body.mesh_file << " of " << GetParam() << " is not here";
    }
  }
  const Model model = buildModel(scene);
  EXPECT_EQ(model.bodies.size(), scene.bodies.size());
  for (const Body& body : model.bodies) {
    EXPECT_GT(body.lattice.active_slots.size(), 8u) << body.name;
    EXPECT_GT(body.skin.mesh.triangles.size(), 0u) << body.name;
  }
}
INSTANTIATE_TEST_SUITE_P(Config, ShippedScene, ::testing::ValuesIn(filesIn("scenes")), nameOf);

class ShippedStrokes : public ::testing::TestWithParam<fs::path> {};

TEST_P(ShippedStrokes, LoadAndFitTheHeart) {
  const Scene heart = coarse(kConfig / "scenes" / "heart.yaml");
  Strokes strokes = loadStrokes(GetParam().string());
  for (const Stroke& stroke : strokes.strokes) {
    EXPECT_TRUE(std::any_of(heart.styluses.begin(), heart.styluses.end(),
                            [&](const StylusConfig& stylus) { return stylus.name == stroke.stylus; }))
        << "the heart has no stylus " << stroke.stylus;
  }
  for (const Mark& mark : strokes.marks) EXPECT_LE(mark.time_s, strokes.duration_s()) << mark.name << " is never seen";
  resolveAnchors(strokes, buildModel(heart));
  EXPECT_FALSE(strokes.anchored());
}
INSTANTIATE_TEST_SUITE_P(Config, ShippedStrokes, ::testing::ValuesIn(filesIn("strokes")), nameOf);

}  // namespace
}  // namespace viscera
