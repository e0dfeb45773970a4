// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <set>

#include "cli/small_scene.h"
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
