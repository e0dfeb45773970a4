// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/small_scene.h"
#include "model/scene/tool_kinds.h"
#include "support/source_folder.h"
#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

using namespace test;
using Json = nlohmann::json;

/// The probe presses the block's side, then grabs and releases.
constexpr const char* kTouch =
    "strokes:\n"
    "  - stylus: left\n"
    "    keys:\n"
    "      - {t_s: 0, position_m: [0, -0.04, 0]}\n"
    "      - {t_s: 0.1, position_m: [0, -0.018, 0]}\n"
    "      - {t_s: 0.15, position_m: [0, -0.018, 0], button1: true}\n"
    "      - {t_s: 0.25, position_m: [0, -0.025, 0.002], button1: true}\n"
    "      - {t_s: 0.3, position_m: [0, -0.04, 0]}\n";

/// A stylus that grips the block's free end with button 1 and pulls it down.
constexpr const char* kPull =
    "strokes:\n"
    "  - stylus: left\n"
    "    keys:\n"
    "      - {t_s: 0, position_m: [0, 0, -0.02], button1: true}\n"
    "      - {t_s: 0.3, position_m: [0, 0, -0.03], button1: true}\n";

class BenchReference : public ::testing::Test {
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
  Ending reference(std::vector<std::string> options, const std::vector<std::string>& environment = {}) const {
    options.insert(options.begin(), {"bench", "reference", scene_});
    return viscera(options, environment);
  }
  double gpuError(const std::vector<std::string>& settings) const {
    std::vector<std::string> options = {"--compare", "--strokes", strokes_};
    for (const std::string& setting : settings) options.insert(options.end(), {"--set", setting});
    const Json metrics = lastLine(reference(options));
    EXPECT_GT(metrics["peak_force_n"], 0);
    return metrics["gpu_error"];
  }

  TemporaryFolder folder_;
  std::string scene_ = folder_.write("block.yaml", kBlockScene), strokes_ = folder_.write("touch.yaml", kTouch);
};

}  // namespace

TEST_F(BenchReference, NeedsNoGpuAndSaysTheSameThings) {
  const Json gpu = lastLine(run({"--strokes", strokes_, "--set", "solver.stability_monitor=false"}));
  const Json truth = lastLine(reference({"--strokes", strokes_}, {kNoDevice}));
  EXPECT_EQ(truth["backend"], "reference");
  EXPECT_EQ(truth["renderer"], "none");
  EXPECT_FALSE(truth.contains("gpu_error"));
  for (const auto& [key, value] : gpu.items()) {
    EXPECT_TRUE(truth.contains(key) || key == "tools") << key;  // "tools" exists in sessions only
  }
  for (const char* key : {"nodes", "springs", "springs_cut", "faces", "steps", "dt_s", "dt_safe_s", "simulated_s"})
    EXPECT_EQ(truth[key], gpu[key]) << key;
  for (const char* key : {"max_stretch", "max_speed_m_per_s", "peak_force_n"}) {
    EXPECT_NEAR(truth[key].get<double>() / gpu[key].get<double>(), 1, 1e-3) << key;  // float32, with a tool in contact
  }
}

TEST_F(BenchReference, GpuIsCloseToIt) {
  constexpr double kTouched = 1e-5;  // relative to the largest displacement: float32 with a tool in contact
  EXPECT_LT(gpuError({}), kTouched);
  EXPECT_LT(gpuError({"bodies[0].material.poisson_ratio=0.4"}), kTouched);
}

TEST_F(BenchReference, SuctionLetsGoAboveItsForceOnEveryBackend) {
  const std::string pull = folder_.write("pull.yaml", kPull);
  const auto stretch = [&](const std::string& max_force_n, const std::string& backend) {
    std::vector<std::string> options = {
        "--strokes", pull,
        "--set",     "styluses[0].button1=suction",
        "--set",     "styluses[0].suction={radius_m: 0.012, max_force_n: " + max_force_n + "}"};
    if (backend != "reference") options.insert(options.end(), {"--set", "solver.backend=" + backend});
    const Ending ending = backend == "reference" ? reference(options) : run(options);
    return lastLine(ending)["max_stretch"].get<double>();
  };
  for (const std::string backend : {"reference", "gpu", "cpu"}) {
    SCOPED_TRACE(backend);
    EXPECT_GT(stretch("1000", backend), 2 * stretch("0.05", backend));
  }
}

TEST_F(BenchReference, TakesNoOptionsOfPicturesAndStates) {
  for (const std::string option : {"--out", "--save", "--record", "--export"}) {
    const Ending ending = reference({option, folder_.file("out")});
    EXPECT_GT(ending.status, 100) << ending.err;
    const std::vector<std::string> errors = complaints(ending);
    ASSERT_EQ(errors.size(), 1u) << ending.err;
    EXPECT_TRUE(says(errors[0], {"command line", option, "`viscera bench reference --help`"}));
  }
}

TEST_F(BenchReference, RunSaysThatItIsACommandByItself) {
  const std::vector<std::vector<std::string>> old = {
      {"--reference"}, {"--compare"}, {"--reference", "--compare", "--strokes", strokes_}};
  for (const std::vector<std::string>& options : old) {
    const Ending ending = run(options, {kNoDevice});
    EXPECT_GT(ending.status, 100) << ending.err;
    EXPECT_EQ(ending.out, "");
    const std::vector<std::string> errors = complaints(ending);
    ASSERT_EQ(errors.size(), 1u) << ending.err;
    EXPECT_TRUE(says(errors[0], {"command line", options[0], "`viscera bench reference SCENE [--compare]`"}));
  }
  EXPECT_EQ(viscera({"run", "--help"}).out.find("--reference"), std::string::npos);
}

TEST_F(BenchReference, RefusesWhatRunRefuses) {
  const auto refusal = [&](const std::vector<std::string>& options) {
    const Ending ending = reference(options);
    EXPECT_EQ(ending.status, 1) << ending.err;
    const std::vector<std::string> errors = complaints(ending);
    EXPECT_EQ(errors.size(), 1u) << ending.err;
    return errors.empty() ? std::string() : errors[0];
  };
  EXPECT_TRUE(says(refusal({"--seconds", "nan"}), {"--seconds", "nan"}));
  EXPECT_TRUE(says(refusal({"--strokes", folder_.file("none.yaml")}), {folder_.file("none.yaml")}));
  EXPECT_TRUE(says(refusal({"--set", "bodies[0].spacing=1"}), {"override", "'bodies[0].spacing'"}));
}

/// Returns whether the tissue of a scene has processes that the reference does not support.
bool usesProcesses(const std::filesystem::path& file) {
  const Scene scene = loadScene(file.string());
  return hasSuturesOrClips(scene) || mayBurn(scene.styluses);
}

bool resistsBlades(const std::filesystem::path& scene) {
  const std::vector<BodyConfig> bodies = loadScene(scene.string()).bodies;
  return std::any_of(bodies.begin(), bodies.end(),
                     [](const BodyConfig& body) { return body.material.cut.toughness_j_per_m2 > 0; });
}

bool hasPressure(const std::filesystem::path& scene) {
  const std::vector<BodyConfig> bodies = loadScene(scene.string()).bodies;
  return std::any_of(bodies.begin(), bodies.end(), [](const BodyConfig& body) { return body.pressure.mean_pa > 0; });
}

/// Shipped scenes are used as they are, with two exceptions. Organs are coarser than for viewing. Blades that tissue
/// resists, sutures, needles, clips and pressure are removed, since the reference reports that it does not support
/// them; it accepts the scenes without them.
TEST_F(BenchReference, RefusesNoSceneThatComesWithIt) {
  size_t scenes = 0;
  for (const auto& file : std::filesystem::directory_iterator(sourceFolder() + "/config/scenes")) {
    if (file.path().extension() != ".yaml") continue;
    SCOPED_TRACE(file.path().filename().string());
    ++scenes;
    std::vector<std::string> options = {"bench", "reference", file.path().string(), "--seconds", "0.02"};
    const std::string name = file.path().stem().string();
    if (name.find("heart") != std::string::npos || name == "gallbladder") {
      const bool counted = name == "pig_heart_size";
      options.insert(options.end(), {"--set", counted ? "bodies[0].target_nodes=2000" : "bodies[0].spacing_m=0.01"});
    }
    if (usesProcesses(file.path())) options.insert(options.end(), {"--set", "sutures=[]", "--set", "styluses=[]"});
    if (resistsBlades(file.path())) options.insert(options.end(), {"--set", "bodies[0].material.cut={}"});
    if (hasPressure(file.path())) options.insert(options.end(), {"--set", "bodies[0].pressure={}"});
    const Json metrics = lastLine(viscera(options, {kNoDevice}));
    EXPECT_GT(metrics["nodes"], 0);
    EXPECT_EQ(metrics["nonfinite"], 0);
  }
  EXPECT_GE(scenes, 6u);
}

}  // namespace viscera
