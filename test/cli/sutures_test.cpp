// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Sutures in the command.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/small_scene.h"
#include "support/temporary_folder.h"

namespace viscera {
namespace {

using namespace test;

constexpr const char* kSuture =
    "sutures: [{name: suture, usp: 4-0, path: [{position_m: [0.03, 0, 0]}], start: fixed}]\n";

TEST(SutureCommand, ExportsSutures) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("scene.yaml", std::string(kBlockScene) + kSuture), out = folder.file("out");
  const Ending run = viscera({"run", scene, "--no-view", "--seconds", "0.1", "--out", out, "--export", "sutures"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(readFile(out + "/export/sutures_000006.vtp").find("tension"), std::string::npos);
}

TEST(SutureCommand, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  const std::string bare = folder.write("bare.yaml", kBlockScene);
  const Ending none =
      viscera({"run", bare, "--no-view", "--seconds", "0.1", "--out", folder.file("out"), "--export", "sutures"});
  EXPECT_NE(none.status, 0);
  EXPECT_NE(none.err.find("--export sutures: the scene has no sutures"), std::string::npos) << none.err;
}

TEST(SutureCommand, IsReportedByTheReferenceToo) {
  const TemporaryFolder folder;
  const std::string scene = folder.write("scene.yaml", std::string(kBlockScene) + kSuture);
  const nlohmann::json metrics = lastLine(viscera({"bench", "reference", scene, "--seconds", "0.05"}));
  ASSERT_EQ(metrics["sutures"]["pieces"].size(), 1U);
  EXPECT_EQ(metrics["sutures"]["pieces"][0]["name"], "suture");
  EXPECT_GT(metrics["sutures"]["pieces"][0]["largest_n"], 0);
}

}  // namespace
}  // namespace viscera
