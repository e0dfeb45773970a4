// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/small_scene.h"
#include "model/scene/tool_kinds.h"
#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

using namespace test;
using Json = nlohmann::json;

/// The probe presses the block's side, then grabs and lets go.
constexpr const char* kTouch =
    "strokes:\n"
    "  - stylus: left\n"
    "    keys:\n"
    "      - {t_s: 0, position_m: [0, -0.04, 0]}\n"
    "      - {t_s: 0.1, position_m: [0, -0.018, 0]}\n"
    "      - {t_s: 0.15, position_m: [0, -0.018, 0], button1: true}\n"
    "      - {t_s: 0.25, position_m: [0, -0.025, 0.002], button1: true}\n"
    "      - {t_s: 0.3, position_m: [0, -0.04, 0]}\n";

/// A hand that takes the block's free end with button 1 and pulls it down.
constexpr const char* kPull =
    "strokes:\n"
    "  - stylus: left\n"
    "    keys:\n"
    "      - {t_s: 0, position_m: [0, 0, -0.02], button1: true}\n"
    "      - {t_s: 0.3, position_m: [0, 0, -0.03], button1: true}\n";

class RunReference : public ::testing::Test {
 protected:
  static Json lastLine(const Ending& ending) {
    EXPECT_EQ(ending.status, 0) << ending.err;
    const std::vector<std::string> lines = linesOf(ending.out);
    return lines.empty() ? Json() : Json::parse(lines.back(), nullptr, false);
  }
  Ending run(std::vector<std::string> options, const std::vector<std::string>& environment = {}) const {
    options.insert(options.begin(), {"run", scene_});
    return viscera(options, environment);
  }
  double gpuError(const std::vector<std::string>& settings) const {
    std::vector<std::string> options = {"--reference", "--compare", "--strokes", strokes_};
    for (const std::string& setting : settings) options.insert(options.end(), {"--set", setting});
    const Json metrics = lastLine(run(options));
    EXPECT_GT(metrics["peak_force_n"], 0);
    return metrics["gpu_error"];
  }

  TemporaryFolder folder_;
  std::string scene_ = folder_.write("block.yaml", kBlockScene), strokes_ = folder_.write("touch.yaml", kTouch);
};

}  // namespace

TEST_F(RunReference, NeedsNoGpuAndSaysTheSameThings) {
  const Json gpu = lastLine(run({"--strokes", strokes_, "--set", "solver.governor=false"}));
  const Json reference = lastLine(run({"--strokes", strokes_, "--reference"}, {kNoDevice}));
  EXPECT_EQ(reference["backend"], "reference");
  EXPECT_EQ(reference["renderer"], "none");
  for (const auto& [key, value] : gpu.items()) {
    EXPECT_TRUE(reference.contains(key) || key == "hands") << key;  // those are a session's, which it has not
  }
  for (const char* key : {"nodes", "springs", "springs_cut", "faces", "steps", "dt_s", "dt_safe_s", "simulated_s"})
    EXPECT_EQ(reference[key], gpu[key]) << key;
  for (const char* key : {"max_stretch", "max_speed_m_per_s", "peak_force_n"}) {
    EXPECT_NEAR(reference[key].get<double>() / gpu[key].get<double>(), 1, 1e-3) << key;  // float32, touched by a tool
  }
}

TEST_F(RunReference, GpuIsCloseToIt) {
  constexpr double kTouched = 1e-5;  // of the largest displacement: float32 while a tool presses, grabs and lets go
  EXPECT_LT(gpuError({}), kTouched);
  EXPECT_LT(gpuError({"bodies[0].material.poisson_ratio=0.4"}), kTouched);
}

TEST_F(RunReference, SuctionLetsGoAboveItsForceOnEveryBackend) {
  const std::string pull = folder_.write("pull.yaml", kPull);
  const auto stretch = [&](const std::string& max_force_n, const std::vector<std::string>& backend) {
    std::vector<std::string> options = {
        "--strokes", pull,
        "--set",     "styluses[0].button1=suction",
        "--set",     "styluses[0].suction={radius_m: 0.012, max_force_n: " + max_force_n + "}"};
    options.insert(options.end(), backend.begin(), backend.end());
    return lastLine(run(options))["max_stretch"].get<double>();
  };
  const std::vector<std::vector<std::string>> backends = {
      {"--reference"}, {"--set", "solver.backend=gpu"}, {"--set", "solver.backend=cpu"}};
  for (const std::vector<std::string>& backend : backends) {
    SCOPED_TRACE(backend.back());
    EXPECT_GT(stretch("1000", backend), 2 * stretch("0.05", backend));
  }
}

TEST_F(RunReference, RefusesPictures) {
  const Ending ending = run({"--reference", "--out", folder_.file("out")});
  EXPECT_EQ(ending.status, 1);
  const std::vector<std::string> errors = complaints(ending);
  ASSERT_EQ(errors.size(), 1u) << ending.err;
  EXPECT_TRUE(says(errors[0], {"--out", "--reference"}));
}

TEST_F(RunReference, SolvesImplicitEulerForPdAndMultigrid) {
  const auto hashOf = [&](const std::string& integrator) {
    return lastLine(run({"--reference", "--seconds", "0.05", "--set", "solver.integrator=" + integrator, "--set",
                         "solver.substeps=4"}))["state_hash"];
  };
  EXPECT_EQ(hashOf("pd"), hashOf("multigrid"));
}

bool resistsBlades(const std::filesystem::path& scene) {
  const std::vector<BodyConfig> bodies = loadScene(scene.string()).bodies;
  return std::any_of(bodies.begin(), bodies.end(),
                     [](const BodyConfig& body) { return body.material.cut.toughness_j_per_m2 > 0; });
}

/// Shipped scenes are what they are, but for hearts, which are coarser than a user would want to look at them, and for
/// blades that tissue resists, threads, needles and clips, which the reference says it has not: without them it takes
/// their scene too.
TEST_F(RunReference, RefusesNoSceneThatComesWithIt) {
  size_t scenes = 0;
  for (const auto& file : std::filesystem::directory_iterator(VISCERA_SOURCE_DIR "/config/scenes")) {
    if (file.path().extension() != ".yaml") continue;
    SCOPED_TRACE(file.path().filename().string());
    ++scenes;
    std::vector<std::string> options = {"run", file.path().string(), "--reference", "--seconds", "0.02"};
    const std::string name = file.path().stem().string();
    if (name.find("heart") != std::string::npos) {
      const bool counted = name == "pig_heart_size";
      options.insert(options.end(), {"--set", counted ? "bodies[0].target_nodes=2000" : "bodies[0].spacing_m=0.01"});
    }
    if (pushesAfterSubsteps(loadScene(file.path().string())))
      options.insert(options.end(), {"--set", "threads=[]", "--set", "styluses=[]"});
    if (resistsBlades(file.path())) options.insert(options.end(), {"--set", "bodies[0].material.cut={}"});
    const Json metrics = lastLine(viscera(options, {kNoDevice}));
    EXPECT_GT(metrics["nodes"], 0);
    EXPECT_EQ(metrics["nonfinite"], 0);
  }
  EXPECT_GE(scenes, 6u);
}

}  // namespace viscera
