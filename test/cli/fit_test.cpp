// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/small_scene.h"
#include "support/source_folder.h"
#include "support/text.h"
#include "viscera/math/types.h"

namespace viscera {
namespace {

using namespace test;
using Json = nlohmann::json;

/// Returns an ellipsoid as a mesh file.
std::string ellipsoid(const Vector3d& size_m) {
  constexpr int kRings = 24, kSides = 48;
  std::string points, faces;
  const auto index = [&](int ring, int side) { return std::to_string(1 + ring * kSides + side % kSides); };
  for (int r = 0; r <= kRings; ++r) {
    for (int s = 0; s < kSides; ++s) {
      const double polar = M_PI * (r + 0.01) / (kRings + 0.02), around = 2 * M_PI * s / kSides;
      const Vector3d p = 0.5 * size_m.cwiseProduct(Vector3d(std::sin(polar) * std::cos(around),
                                                            std::sin(polar) * std::sin(around), std::cos(polar)));
      points += "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
      if (r == kRings) continue;
      faces += "f " + index(r, s) + " " + index(r + 1, s) + " " + index(r + 1, s + 1) + " " + index(r, s + 1) + "\n";
    }
  }
  return points + faces;
}

/// Organs for the built-in heart's session, which is not adapted to any of them.
struct Organ {
  const char* name;
  Vector3d size_m;
  std::string up_axis = "z";
};
const std::vector<Organ>& organs() {
  static const std::vector<Organ> list = {{"5 cm", {0.04, 0.036, 0.05}},
                                          {"20 cm", {0.16, 0.12, 0.2}},
                                          {"20 cm, lying", {0.2, 0.1, 0.07}},
                                          {"10 cm, y up", {0.08, 0.1, 0.07}, "y"}};
  return list;
}

class FitCommand : public ::testing::Test {
 protected:
  std::vector<std::string> options(const Organ& organ) const {
    return {"heart", "--mesh", folder_.write("organ.obj", ellipsoid(organ.size_m)), "--set",
            "bodies[0].up_axis=" + organ.up_axis};
  }
  /// Returns the output of a run of part of the demo's session.
  Json run(std::vector<std::string> arguments, const std::string& seconds, const std::string& strokes) const {
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"--no-view", "--seconds", seconds, "--strokes", strokes});
    const Ending ending = viscera(arguments);
    EXPECT_EQ(ending.status, 0) << ending.err;
    const std::vector<std::string> lines = linesOf(ending.out);
    return lines.empty() ? Json() : Json::parse(lines.back(), nullptr, false);
  }
  TemporaryFolder folder_;
  std::string demo_ = sourceFolder() + "/config/strokes/demo.yaml";
};

TEST_F(FitCommand, DemoDentsAndCutsOrgansOfOtherSizes) {
  constexpr int kLeast = 15;  // springs, with this few nodes: a stroke that only grazes the surface cuts fewer
  for (const Organ& organ : organs()) {
    SCOPED_TRACE(organ.name);
    std::vector<std::string> session = options(organ);
    session.insert(session.end(), {"--set", "bodies[0].target_nodes=2500"});  // runs fast
    const Json dent = run(session, "1.1", demo_), incision = run(session, "2.8", demo_);
    EXPECT_GT(dent["peak_force_n"], 0.0);
    EXPECT_EQ(dent["springs_cut"], 0);
    EXPECT_GE(incision["springs_cut"], kLeast);
    if (organ.up_axis == "z" && organ.size_m.x() < 0.2) continue;  // the whole demo, for the organ that is rotated most
    const Json flap = run(session, "6.2", demo_);
    EXPECT_GE(flap["springs_cut"].get<int>() - incision["springs_cut"].get<int>(), kLeast);
  }
}

TEST_F(FitCommand, WrittenSceneAndStrokesAreWhatWasRun) {
  std::vector<std::string> session = options(organs()[0]);
  session.insert(session.end(), {"--set", "bodies[0].target_nodes=3000"});  // runs fast
  const std::string scene = folder_.file("scene.yaml"), strokes = folder_.file("strokes.yaml");
  std::vector<std::string> fit = session, anchor = session;
  fit.insert(fit.begin(), "fit");
  fit.insert(fit.end(), {"--out", scene});
  anchor.insert(anchor.begin(), "anchor");
  anchor.insert(anchor.end(), {"--out", strokes, "--strokes", demo_});
  const Ending written = viscera(fit);
  EXPECT_EQ(written.status, 0) << written.err;
  EXPECT_TRUE(says(written.out, {"fitted to the organ's box", "0.04 x 0.036 x 0.05 m"}));
  EXPECT_EQ(viscera(anchor).status, 0);
  EXPECT_EQ(run({scene}, "0.1", strokes)["nodes"], run(session, "0.1", demo_)["nodes"]);
  const Json was = run(session, "1.1", demo_), is = run({scene}, "1.1", strokes);
  constexpr double kSame = 0.05;  // of a force: strokes are written with nine digits, and forces are sums in float32
  EXPECT_NEAR(is["peak_force_n"].get<double>(), was["peak_force_n"].get<double>(),
              kSame * was["peak_force_n"].get<double>());
}

TEST_F(FitCommand, TinyOrgansAndThinPlatesPlayWithoutAWord) {
  for (const Vector3d& size_m : {Vector3d(0.004, 0.0035, 0.005), Vector3d(0.1, 0.1, 0.0018)}) {
    const std::string mesh = folder_.write("organ.obj", ellipsoid(size_m));
    const Ending ending = viscera({"run", "heart", "--mesh", mesh, "--no-view", "--seconds", "0.02"});
    EXPECT_EQ(ending.status, 0) << ending.err;
    EXPECT_TRUE(says(ending.out, {"fitted to the organ's box"})) << ending.out;
  }
}

TEST_F(FitCommand, AFolderThatIsNotThereIsRefused) {
  std::vector<std::string> fit = options(organs()[0]);
  fit.insert(fit.begin(), "fit");
  fit.insert(fit.end(), {"--out", folder_.file("none/scene.yaml")});
  const Ending ending = viscera(fit);
  EXPECT_EQ(ending.status, 1);
  EXPECT_TRUE(says(ending.err, {"none/scene.yaml", "cannot be written"}));
}

}  // namespace
}  // namespace viscera
