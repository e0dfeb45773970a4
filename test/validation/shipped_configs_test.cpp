// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <optional>

#include "support/gpu_fixture.h"
#include "support/source_folder.h"
#include "tasks/task.h"
#include "viscera/model/model.h"
#include "viscera/session/session.h"
#include "viscera/tools/strokes.h"

namespace viscera {
namespace {

namespace fs = std::filesystem;

const fs::path kConfig = fs::path(test::sourceFolder()) / "config";
constexpr double kCoarseM = 0.008;  ///< quick to build, and still fine enough to resolve every wall of an organ

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

/// Returns the scene with every solid body made coarse.
Scene coarse(const fs::path& file) {
  Scene scene = loadScene(file.string());
  if (!scene.sutures.empty()) return scene;  // its channels are at fixed positions of the tissue
  for (BodyConfig& body : scene.bodies) {
    if (body.source == TissueSource::kSheet) continue;  // quick to build, and fixed along lines
    if (body.source == TissueSource::kTube) continue;   // refuses cells wider than its wall
    body.target_nodes = 0;
    body.spacing_m = std::max(body.spacing_m, kCoarseM);
  }
  return scene;
}

/// Returns whether every mesh file of the scene is present. Some scenes are for data that cannot be shipped.
bool isComplete(const Scene& scene) {
  return std::all_of(scene.bodies.begin(), scene.bodies.end(), [&](const BodyConfig& body) {
    return body.source != TissueSource::kMesh || fs::exists(fs::path(scene.folder) / body.mesh_file);
  });
}

class ShippedScene : public test::GpuTest, public ::testing::WithParamInterface<fs::path> {};

TEST_P(ShippedScene, LoadsAndBuilds) {
  const Scene scene = coarse(GetParam());
  if (!isComplete(scene)) GTEST_SKIP() << "a mesh file of " << GetParam() << " is not here";
  const Model model = buildModel(scene);
  EXPECT_EQ(model.bodies.size(), scene.bodies.size());
  for (const Body& body : model.bodies) {
    EXPECT_GT(body.lattice.active_slots.size(), 8u) << body.name;
    EXPECT_GT(body.skin.mesh.triangles.size(), 0u) << body.name;
  }
}

TEST_P(ShippedScene, RunsSomeTicksAsItsNameSaysWithoutATrip) {
  const Scene scene = coarse(GetParam());
  if (!isComplete(scene)) GTEST_SKIP() << "a mesh file of " << GetParam() << " is not here";
  EXPECT_EQ(scene.name, GetParam().stem().string());
  EXPECT_FALSE(scene.cameras.empty());
  EXPECT_FALSE(scene.styluses.empty());
  Session session(scene, context_);
  constexpr int kTicks = 6;  // 0.1 s: long enough for loose bodies to fall by 5 cm
  for (int tick = 0; tick < kTicks; ++tick) session.step({}, {});
  session.drain();
  EXPECT_EQ(session.extremes().roll_backs, 0u);
  EXPECT_EQ(session.extremes().nonfinite, 0u);
  const bool has_weight = scene.environment.gravity_m_per_s2.norm() > 0;
  EXPECT_TRUE(!has_weight || session.extremes().max_speed_m_per_s > 0) << "nothing moves";
}
INSTANTIATE_TEST_SUITE_P(Config, ShippedScene, ::testing::ValuesIn(filesIn("scenes")), nameOf);

bool resists(const BodyConfig& body) {
  return body.material.cut.toughness_j_per_m2 > 0 || body.material.cut.of_tissue;
}

bool cuts(const StylusConfig& stylus) {
  return stylus.idle == ToolMode::kCut || stylus.button1 == ToolMode::kCut || stylus.button2 == ToolMode::kCut;
}

TEST_P(ShippedScene, BladesInTissueThatResistsThemHaveAPoint) {
  const Scene scene = loadScene(GetParam().string());
  if (std::none_of(scene.bodies.begin(), scene.bodies.end(), resists)) return;
  for (const StylusConfig& stylus : scene.styluses)
    EXPECT_TRUE(!cuts(stylus) || stylus.cut.point_width_m > 0) << stylus.name << " stabs and feels nothing";
}

/// Moves straight in along the blade, 6 mm deep, at 5 cm/s. @returns the largest force against it [N]
double stab(const std::string& name) {
  const Scene scene = loadScene((kConfig / "scenes" / (name + ".yaml")).string(), {"solver.backend=cpu", "cameras=[]"});
  Session session(scene);
  const double top_m = 0.5 * scene.bodies[0].box_size_m.z();
  double most_n = 0;
  for (double z_m = top_m + 0.004; z_m > top_m - 0.006; z_m -= 0.05 * session.tick_s()) {
    StylusSamples samples;
    samples[1].valid = samples[1].button2 = true;
    samples[1].pose.position_m = {0.0003, 0.0005, z_m};
    most_n = std::max(most_n, session.step(samples, {}).reactions[1].force_n.z());
  }
  return most_n;
}

TEST(PracticeScenes, AStabIsFelt) {
  constexpr double kWork_n = 50 * 0.004;  // J times the point's width
  for (const char* scene : {"practice_skin", "skin_under_tension"}) {
    EXPECT_GT(stab(scene), 0.5 * kWork_n) << scene;
    EXPECT_LT(stab(scene), 2 * kWork_n) << scene;
  }
}

/// The scene of each strokes file that belongs to no task.
const std::map<std::string, std::string> kSceneOf = {{"demo", "heart"},
                                                     {"cut_cloth", "cloth_on_points"},
                                                     {"incision", "skin_under_tension"},
                                                     {"stab", "practice_skin"},
                                                     {"cautery", "cautery_pad"},
                                                     {"bleeding", "bleeding_vessel"},
                                                     {"hollow_vessel", "hollow_vessel"},
                                                     {"suture", "suture_pad"},
                                                     {"running_suture", "running_suture"}};

/// Returns the task of strokes TASK_good and TASK_clumsy; nothing for other files.
std::optional<TaskConfig> taskOf(const fs::path& strokes) {
  const std::string name = strokes.stem().string();
  const fs::path task = kConfig / "tasks" / (name.substr(0, name.rfind('_')) + ".yaml");
  if (!fs::exists(task)) return std::nullopt;
  return loadTask(task.string());
}

class ShippedStrokes : public ::testing::TestWithParam<fs::path> {};

TEST_P(ShippedStrokes, LoadAndFitTheirScene) {
  const std::optional<TaskConfig> task = taskOf(GetParam());
  const auto found = kSceneOf.find(GetParam().stem().string());
  ASSERT_TRUE(task || found != kSceneOf.end()) << GetParam() << " is for no task and no scene: name it in kSceneOf";
  const Scene scene = coarse(kConfig / "scenes" / ((task ? task->scene : found->second) + ".yaml"));
  Strokes strokes = loadStrokes(GetParam().string());
  for (const Stroke& stroke : strokes.strokes) {
    EXPECT_TRUE(std::any_of(scene.styluses.begin(), scene.styluses.end(),
                            [&](const StylusConfig& stylus) { return stylus.name == stroke.stylus; }))
        << scene.name << " has no stylus " << stroke.stylus;
  }
  EXPECT_TRUE(task || !strokes.marks.empty()) << "no pictures";  // those of a task are made by the report
  for (const Mark& mark : strokes.marks) EXPECT_LE(mark.time_s, strokes.duration_s()) << mark.name << " is never seen";
  resolveAnchors(strokes, buildModel(scene));
  EXPECT_FALSE(strokes.anchored());
}
INSTANTIATE_TEST_SUITE_P(Config, ShippedStrokes, ::testing::ValuesIn(filesIn("strokes")), nameOf);

}  // namespace
}  // namespace viscera
