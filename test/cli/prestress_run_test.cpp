// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// material.prestress from a scene file, with strokes and the final surface mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/small_scene.h"
#include "support/text.h"
#include "viscera/model/shape/mesh_import.h"

namespace viscera {
namespace {

using namespace test;
using Json = nlohmann::json;

/// A sheet that is fixed all around, and a blade along x that cuts through its middle.
constexpr const char* kSheet =
    "bodies:\n"
    "  - name: sheet\n"
    "    source: sheet\n"
    "    structure: surface\n"
    "    box_size_m: [0.1, 0.1, 0.01]\n"
    "    spacing_m: 0.002\n"
    "    material: {mass_damping_per_s: 150, prestress: {strain: 0.01}}\n"
    "    fixed:\n"
    "      - {shape: plane, point_m: [-0.048, 0, 0], normal: [1, 0, 0]}\n"
    "      - {shape: plane, point_m: [0.048, 0, 0], normal: [-1, 0, 0]}\n"
    "      - {shape: plane, point_m: [0, -0.048, 0], normal: [0, 1, 0]}\n"
    "      - {shape: plane, point_m: [0, 0.048, 0], normal: [0, -1, 0]}\n"
    "styluses: [{name: left, cut: {blade_length_m: 0.024}}]\n"
    "environment: {gravity_m_per_s2: [0, 0, 0]}\n"
    "solver: {backend: cpu}\n";
constexpr const char* kCut =
    "strokes:\n"
    "  - stylus: left\n"
    "    keys:\n"
    "      - {t_s: 0, position_m: [-0.012, 0, 0.02], rotation_deg: [0, 90, 0], button2: true}\n"
    "      - {t_s: 0.1, position_m: [-0.012, 0, -0.02], rotation_deg: [0, 90, 0], button2: true}\n"
    "      - {t_s: 0.4, position_m: [-0.012, 0, -0.06], rotation_deg: [0, 90, 0]}\n";

class PrestressRun : public ::testing::Test {
 protected:
  Json run(std::vector<std::string> options) {
    options.insert(options.begin(), {"run", folder_.write("sheet.yaml", kSheet), "--no-view"});
    const Ending ending = viscera(options);
    EXPECT_EQ(ending.status, 0) << ending.err;
    said_ = ending.out + ending.err;
    const std::vector<std::string> lines = linesOf(ending.out);
    return lines.empty() ? Json() : Json::parse(lines.back(), nullptr, false);
  }

  TemporaryFolder folder_;
  std::string said_;
};

TEST_F(PrestressRun, ACutGapesByTheLawAndTheLogSaysWhatBalances) {
  const std::string out = folder_.file("cut");
  const Json metrics = run({"--strokes", folder_.write("cut.yaml", kCut), "--out", out});
  EXPECT_TRUE(says(said_, {"prestress: 100 % of the requested strain is in balance"})) << said_;
  EXPECT_GT(metrics["springs_cut"], 0);
  EXPECT_EQ(metrics["roll_backs"], 0);
  // Vertices of the lips next to the blade: the closest to its plane in the middle of the cut.
  const TriangleMesh skin = importMesh(out + "/surface.ply", 1);
  float above = 1, below = -1;
  for (const Vector3f& at : skin.positions_m) {
    if (std::abs(at.x()) > 0.0015f) continue;
    if (at.y() > 0) above = std::min(above, at.y());
    if (at.y() < 0) below = std::max(below, at.y());
  }
  // 4 sigma a / E with sigma = E e / (1 - nu). The rim, four times as far away, reduces it by a tenth, and the coarse
  // spacing by some more.
  const double law_m = 4 * 0.012 * 0.01 / (1 - 1.0 / 3);
  EXPECT_GT(static_cast<double>(above - below), 0.75 * law_m);
  EXPECT_LT(static_cast<double>(above - below), 1.1 * law_m + 0.002);
}

TEST_F(PrestressRun, UncutItStaysAndResumedItGoesOnToTheBit) {
  const std::string strokes = folder_.write("cut.yaml", kCut), saved = folder_.file("state");
  const Json whole = run({"--strokes", strokes});
  run({"--strokes", strokes, "--seconds", "0.2", "--save", saved});
  EXPECT_EQ(run({"--strokes", strokes, "--resume", saved})["state_hash"], whole["state_hash"]);
  EXPECT_LT(run({"--seconds", "0.2"})["max_speed_m_per_s"].get<double>(), 1e-4);
}

}  // namespace
}  // namespace viscera
