// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <set>

#include "cli/small_scene.h"
#include "support/temporary_folder.h"
#include "support/text.h"

namespace viscera {
namespace {

using namespace test;

nlohmann::json runGallbladder(std::vector<std::string> options) {
  options.insert(options.begin(), {"run", sourceFolder() + "/config/scenes/gallbladder.yaml", "--no-view", "--set",
                                   "solver.backend=cpu"});
  const Ending ending = viscera(options, {kNoDevice});
  EXPECT_EQ(ending.status, 0) << ending.err;
  return lastLine(ending);
}

TEST(Gallbladder, SceneRunsWithoutRollBacksToOneHash) {
  const auto first = runGallbladder({"--seconds", "0.5"}), second = runGallbladder({"--seconds", "0.5"});
  EXPECT_EQ(first["roll_backs"], 0);
  EXPECT_EQ(first["nonfinite"], 0);
  EXPECT_EQ(first["state_hash"], second["state_hash"]);
}

TEST(Gallbladder, EveryVariantRuns) {
  std::set<std::string> hashes;
  for (const char* seed : {"0", "1", "2", "3", "4", "42"}) {  // the anatomies by name, and a drawn one
    SCOPED_TRACE(seed);
    const auto metrics = runGallbladder({"--seconds", "0.1", "--set", "bodies[0].spacing_m=0.004", "--set",
                                         std::string("bodies[0].phantom_seed=") + seed});
    EXPECT_EQ(metrics["roll_backs"], 0);
    EXPECT_EQ(metrics["nonfinite"], 0);
    hashes.insert(metrics["state_hash"].get<std::string>());
  }
  EXPECT_EQ(hashes.size(), 6U) << "variants differ";
}

/// Returns a scene of liver and organ, each with parts and a spacing of its own, that fibres join.
std::string joinedSections(const std::string& of_liver) {
  const auto body = [](const std::string& name, const std::string& spacing_m, const std::string& labels,
                       const std::string& plane) {
    return "  - {name: " + name + ", phantom: gallbladder, phantom_length_m: 0.08, spacing_m: " + spacing_m +
           ", skin_spacing_m: 0.004, scan: {labels: [" + labels + "]}, fixed: [{shape: plane, " + plane + "}]}\n";
  };
  return "bodies:\n" +
         body("organ", "0.004",
              "gallbladder_bed, gallbladder, infundibulum, cystic_duct, common_hepatic_duct, common_bile_duct, "
              "hepatic_artery, cystic_artery",
              "point_m: [0, 0, -0.0575], normal: [0, 0, 1]") +
         body("liver", "0.008", of_liver, "point_m: [0, 0.0115, 0], normal: [0, -1, 0]") +
         "attachments: [{body_a: organ, body_b: liver, reach_m: 0.002}]\nsolver: {backend: cpu}\n";
}

TEST(Gallbladder, SectionsAreBodiesThatFibresJoin) {
  constexpr double kBed_m2 = 5e-4;  // a third of the contact of gallbladder and liver
  const TemporaryFolder folder;
  const Ending joined = viscera(
      {"run", folder.write("joined.yaml", joinedSections("liver, liver_capsule")), "--no-view", "--seconds", "0.05"},
      {kNoDevice});
  ASSERT_EQ(joined.status, 0) << joined.err;
  const nlohmann::json metrics = lastLine(joined);
  EXPECT_EQ(metrics["roll_backs"], 0);
  EXPECT_GT(metrics["attachments"]["on"][0]["attached_m2"], kBed_m2);
  const Ending half = viscera(
      {"run", folder.write("half.yaml", joinedSections("liver")), "--no-view", "--seconds", "0.05"}, {kNoDevice});
  EXPECT_EQ(half.status, 1);
  ASSERT_EQ(complaints(half).size(), 1U) << half.err;
  EXPECT_TRUE(says(complaints(half)[0], {"scan.labels", "'liver_capsule' is missing"})) << half.err;
}

TEST(Gallbladder, SeedOutOfRangeAndUnknownAnatomyAreErrors) {
  const auto refusal = [](const std::string& setting) {
    return viscera({"run", sourceFolder() + "/config/scenes/gallbladder.yaml", "--no-view", "--set", setting},
                   {kNoDevice});
  };
  for (const char* seed : {"-1", "1000001"}) {
    const Ending ending = refusal(std::string("bodies[0].phantom_seed=") + seed);
    EXPECT_EQ(ending.status, 1);
    ASSERT_EQ(complaints(ending).size(), 1U) << ending.err;
    EXPECT_TRUE(says(complaints(ending)[0], {"bodies[0].phantom_seed", seed, "1e+06"})) << ending.err;
  }
  const Ending ending = refusal("bodies[0].phantom=liver");
  EXPECT_EQ(ending.status, 1);
  ASSERT_EQ(complaints(ending).size(), 1U) << ending.err;
  EXPECT_TRUE(says(complaints(ending)[0], {"bodies[0].phantom", "heart", "gallbladder"})) << ending.err;
}

}  // namespace
}  // namespace viscera
