// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Tasks that the command judges: shipped ones with their shipped strokes.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "cli/small_scene.h"
#include "support/source_folder.h"
#include "support/temporary_folder.h"

namespace viscera {
namespace {

using namespace test;

std::string strokesOf(const std::string& task, const std::string& stylus) {
  return sourceFolder() + "/config/strokes/" + task + "_" + stylus + ".yaml";
}

std::string textIn(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

nlohmann::json judged(const std::string& task, const std::string& stylus, std::vector<std::string> more = {}) {
  more.insert(more.begin(),
              {"task", task, "--strokes", strokesOf(task, stylus), "--no-view", "--set", "solver.threads=1"});
  const Ending ending = viscera(more);
  EXPECT_EQ(ending.status, 0) << ending.err;
  const nlohmann::json result = lastLine(ending);
  return result.contains("tasks") && result["tasks"].size() == 1 ? result["tasks"][0] : nlohmann::json::object();
}

/// Returns a report without its date.
nlohmann::json undated(nlohmann::json report) {
  report["attempt"].erase("date");
  return report;
}
std::string undated(const std::string& text) {
  return std::regex_replace(text, std::regex("[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9:]{8}Z"), "DATE");
}

class ShippedTask : public ::testing::TestWithParam<const char*> {
 protected:
  static bool dividesVessel() { return std::string(GetParam()) == "clip_and_divide"; }
};

TEST_P(ShippedTask, IsPassedByAGoodUser) {
  const nlohmann::json result = judged(GetParam(), "good");
  EXPECT_EQ(result["state"], "passed") << result["why"];
  EXPECT_EQ(result["progress"], 1);
  EXPECT_GE(result["score"], result["pass_score"]);
  EXPECT_NEAR(
      result["score"],
      result["time_limit_s"].get<double>() - result["time_s"].get<double>() - result["penalties_s"].get<double>(),
      1e-9);
  if (dividesVessel()) {
    EXPECT_EQ(result["measures"]["blood_ml"]["value"], 0);
  }
}

/// A vessel of bile that is cut: the measure has a cost and a limit of its own.
TEST(SpiltBile, IsAMeasureOfTasks) {
  TemporaryFolder folder;
  const std::string task = folder.write("spill.yaml",
                                        "scene: bleeding_vessel\ntitle: Spill\ninstructions: Do not.\nkind: lift\n"
                                        "lift: {center_m: [0, 0, 0], radius_m: 0.01, up: [0, 0, 1], height_m: 0.02, "
                                        "hold_s: 1}\ntime_limit_s: 2.5\npass_score: 0\n"
                                        "measures: [{measure: bile_ml, cost_s: 3, most: 0.1}]\n");
  const Ending ending =
      viscera({"task", task, "--strokes", sourceFolder() + "/config/strokes/bleeding.yaml", "--no-view", "--set",
               "solver.threads=1", "--set", "bodies[0].material.bleeding.fluid=bile"});
  ASSERT_EQ(ending.status, 0) << ending.err;
  const nlohmann::json measures = lastLine(ending)["tasks"][0]["measures"];
  const double bile_ml = measures["bile_ml"]["value"];
  EXPECT_GT(bile_ml, 0.1);
  EXPECT_EQ(measures["bile_ml"]["failed"], true);
  EXPECT_NEAR(measures["bile_ml"]["cost_s"], 3 * bile_ml, 1e-9);
  EXPECT_EQ(measures["blood_ml"]["value"], 0);
}

TEST_P(ShippedTask, IsFailedByAClumsyOne) {
  const nlohmann::json result = judged(GetParam(), "clumsy");
  EXPECT_EQ(result["state"], "failed") << result["why"];
  EXPECT_NE(result["why"], "");
  if (dividesVessel()) {  // if no clip closes an end
    EXPECT_GT(result["measures"]["blood_ml"]["value"], 1);
    EXPECT_GT(result["measures"]["blood_ml"]["cost_s"], 10);
  }
}

INSTANTIATE_TEST_SUITE_P(Each, ShippedTask,
                         ::testing::Values("pattern_cut", "incision", "touch_targets", "gentle_lift", "close_wound",
                                           "clip_and_divide", "clip_duct"),
                         [](const auto& info) { return std::string(info.param); });

TEST(TaskCommand, ReplaysToTheSameScoreAndWritesAReport) {
  const TemporaryFolder folder;
  const std::string recording = folder.file("session.viscera"), out = folder.file("out"), again = folder.file("again");
  const nlohmann::json live = judged("touch_targets", "good", {"--record", recording, "--out", out, "--name", "Ann"});
  const Ending ending = viscera({"replay", recording, "--no-view", "--out", again, "--name", "Ann"});
  ASSERT_EQ(ending.status, 0) << ending.err;
  ASSERT_EQ(lastLine(ending)["tasks"].size(), 1u);
  EXPECT_EQ(undated(lastLine(ending)["tasks"][0]), undated(live));
  for (const char* file : {"report.csv", "report.html"})
    EXPECT_EQ(undated(textIn(out + "/report/" + file)), undated(textIn(again + "/report/" + file))) << file;
  for (const char* file : {"tools.csv", "kinematics.txt"})
    EXPECT_EQ(textIn(out + "/report/" + file), textIn(again + "/report/" + file)) << file;

  const nlohmann::json report = nlohmann::json::parse(textIn(out + "/report/report.json"));
  EXPECT_EQ(report, live);
  const std::string page = textIn(out + "/report/report.html");
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("http://", page.find("</style>")), page.find("http://www.w3.org/2000/svg")) << "no network";
  EXPECT_EQ(page.find("https://"), std::string::npos);
  EXPECT_NE(page.find("Touch in order"), std::string::npos);
}

/// Returns the result for a pad that is connected until its middle is cut.
/// @param material, stylus, keys  of the scene and the strokes
nlohmann::json dividedBy(const std::string& material, const std::string& stylus, const std::string& keys) {
  const TemporaryFolder folder;
  folder.write("pad.yaml", "bodies: [{source: box, box_size_m: [0.024, 0.024, 0.012], spacing_m: 0.003, material: {" +
                               material +
                               "}, fixed: [{shape: plane, point_m: [0, 0, -0.006], normal: [0, 0, 1]}]}]\n"
                               "styluses: [{name: right, idle: none, button2: none, " +
                               stylus + "}]\nsolver: {backend: cpu}\n");
  const std::string task =
      folder.write("divide.yaml",
                   "scene: pad.yaml\nkind: follow_line\nfollow_line: {path: [{position_m: [-0.003, "
                   "0, 0]}, {position_m: [0.003, 0, 0]}], normal: [0, 0, 1], corridor_m: 0.02}\n");
  const std::string strokes = folder.write("hand.yaml", "strokes: [{stylus: right, keys: [" + keys + "]}]\n");
  const Ending ending = viscera({"task", task, "--strokes", strokes, "--no-view", "--set", "solver.threads=1"});
  EXPECT_EQ(ending.status, 0) << ending.err;
  const nlohmann::json result = lastLine(ending);
  return result.contains("tasks") && result["tasks"].size() == 1 ? result["tasks"][0] : nlohmann::json::object();
}

TEST(TaskCommand, NoticesWhatHeatAndTearsDivide) {
  const nlohmann::json burnt =
      dividedBy("young_modulus_pa: 5000", "button1: cautery, cautery: {radius_m: 0.004, power_w: 60}",
                "{t_s: 0.1, position_m: [0, 0, 0.03], button1: true}, "
                "{t_s: 0.3, position_m: [0, 0, 0.0095], button1: true}, "
                "{t_s: 5, position_m: [0, 0, 0.0095], button1: true}");
  EXPECT_EQ(burnt["state"], "passed") << burnt["why"];
  const nlohmann::json torn =
      dividedBy("young_modulus_pa: 20000, tear: {toughness_j_per_m2: 5}", "button1: grab, grab: {radius_m: 0.005}",
                "{t_s: 0.1, position_m: [0, 0, 0.008]}, {t_s: 0.2, position_m: [0, 0, 0.006], button1: true}, "
                "{t_s: 1.2, position_m: [0, 0, 0.05], button1: true}");
  EXPECT_EQ(torn["state"], "passed") << torn["why"];
}

/// Returns the result of an operation on a pad: its top is touched, then a long blade frees it from its bottom.
/// @param keys  further keys of the task
Ending operationOnPad(const std::string& keys) {
  const TemporaryFolder folder;
  folder.write("pad.yaml",
               "bodies: [{name: pad, source: box, box_size_m: [0.024, 0.024, 0.012], spacing_m: 0.003, fixed: "
               "[{shape: plane, point_m: [0, 0, -0.006], normal: [0, 0, 1]}]}]\n"
               "styluses: [{name: right, idle: probe, button1: cut, button2: none, cut: {blade_length_m: 0.08, "
               "blade_side: both}}]\nsolver: {backend: cpu}\nenvironment: {gravity_m_per_s2: [0, 0, 0]}\n");
  const std::string task =
      folder.write("free.yaml",
                   "scene: pad.yaml\nkind: operation\noperation:\n  stages:\n"
                   "    - {title: Find, kind: touch_targets, touch_targets: {targets: [{position_m: [0, 0, 0.006]}]}}\n"
                   "    - {title: Free, kind: detach, detach: {position_m: [0, 0, 0.006]}}\n" +
                       keys);
  const std::string strokes = folder.write(
      "strokes.yaml",
      "strokes: [{stylus: right, keys: [{t_s: 0.1, position_m: [0, 0, 0.03]}, {t_s: 0.5, position_m: [0, 0, 0.009]}, "
      "{t_s: 0.9, position_m: [0, 0, 0.03]}, {t_s: 1.2, position_m: [0.04, 0, -0.0015], rotation_deg: [-90, 0, 0]}, "
      "{t_s: 1.3, position_m: [0.03, 0, -0.0015], rotation_deg: [-90, 0, 0], button1: true}, "
      "{t_s: 2.3, position_m: [-0.03, 0, -0.0015], rotation_deg: [-90, 0, 0], button1: true}]}]\n");
  return viscera({"task", task, "--strokes", strokes, "--no-view", "--set", "solver.threads=1"});
}

TEST(TaskCommand, OperationEndsWithItsLastStage) {
  const Ending ending = operationOnPad("");
  ASSERT_EQ(ending.status, 0) << ending.err;
  const nlohmann::json result = lastLine(ending)["tasks"][0];
  EXPECT_EQ(result["state"], "passed") << result["why"];
  EXPECT_EQ(result["kind"], "operation");
  EXPECT_GT(result["time_s"], 1.2);  // not with the touch alone
  EXPECT_FALSE(result["measures"].contains("spared_cuts"));
}

/// Returns the result of a task of two glued blocks, the upper one of which is grabbed and pulled up.
Ending pulledApart(const std::string& goal) {
  const TemporaryFolder folder;
  const std::string block =
      "source: box, box_size_m: [0.018, 0.018, 0.009], spacing_m: 0.003, material: "
      "{young_modulus_pa: 20000}, ";
  folder.write("glued.yaml",
               "bodies: [{name: low, " + block +
                   "fixed: [{shape: plane, point_m: [0, 0, -0.002], normal: [0, 0, 1]}]}, {name: high, "
                   "position_m: [0, 0, 0.009], " +
                   block +
                   "fixed: [{shape: plane, point_m: [-0.0085, 0, 0], normal: [1, 0, 0]}]}]\n"
                   "attachments: [{body_a: low, body_b: high, toughness_j_per_m2: 5, strength_pa: 3000}]\n"
                   "styluses: [{name: right, idle: none, button1: grab, grab: {radius_m: 0.008}}]\n"
                   "environment: {gravity_m_per_s2: [0, 0, 0]}\nsolver: {backend: cpu}\n");
  const std::string task = folder.write("part.yaml", "scene: glued.yaml\n" + goal);
  const std::string strokes = folder.write(
      "strokes.yaml",
      "strokes: [{stylus: right, keys: [{t_s: 0.1, at: {part: high}}, {t_s: 0.2, at: {part: high}, button1: true}, "
      "{t_s: 0.9, at: {part: high, offset_m: [0, 0, 0.02]}, button1: true}, {t_s: 1, at: {part: high, offset_m: [0, 0, "
      "0.02]}, button1: true}]}]\n");
  return viscera({"task", task, "--strokes", strokes, "--no-view", "--set", "solver.threads=1"});
}

TEST(TaskCommand, PlacesAreFreedAsTheirFibresPart) {
  const std::string near = "kind: expose\nexpose: {radius_m: 0.004, share: 0.6, places: ";
  const Ending freed = pulledApart(near + "[{at: {part: high, offset_m: [0.005, 0, -0.0045]}}]}\n");
  ASSERT_EQ(freed.status, 0) << freed.err;
  const nlohmann::json result = lastLine(freed)["tasks"][0];
  EXPECT_EQ(result["state"], "passed") << result["why"];
  EXPECT_GT(result["time_s"], 0.1);
  const Ending nothing = pulledApart(near + "[{position_m: [0.005, 0, 0.02]}]}\n");
  EXPECT_EQ(nothing.status, 1);
  EXPECT_NE(nothing.err.find("'expose.places[0]' must be within 'expose.radius_m'"), std::string::npos) << nothing.err;
  const Ending unknown = pulledApart(near + "[{at: {part: middle}}]}\n");
  EXPECT_EQ(unknown.status, 1);
  EXPECT_NE(unknown.err.find("'expose.places[0].at': 'part' and 'from' must be bodies or parts"), std::string::npos)
      << unknown.err;
}

/// Returns the result of a task to free the upper one of two blocks, which a blade divides from where it is held.
nlohmann::json cutFree(const std::string& attachments) {
  const TemporaryFolder folder;
  const std::string block = "source: box, box_size_m: [0.018, 0.018, 0.009], spacing_m: 0.003, ";
  folder.write("glued.yaml",
               "bodies: [{name: low, " + block +
                   "fixed: [{shape: plane, point_m: [0, 0, -0.002], normal: [0, 0, 1]}]}, {name: high, position_m: [0, "
                   "0, 0.009], " +
                   block + "fixed: [{shape: plane, point_m: [-0.0085, 0, 0], normal: [1, 0, 0]}]}]\n" + attachments +
                   "styluses: [{name: right, idle: none, button1: cut, cut: {blade_length_m: 0.03}}]\n"
                   "environment: {gravity_m_per_s2: [0, 0, 0]}\nsolver: {backend: cpu}\n");
  const std::string task = folder.write("free.yaml", "scene: glued.yaml\nkind: detach\ndetach: {at: {part: high}}\n");
  const std::string strokes = folder.write(
      "strokes.yaml",
      "strokes: [{stylus: right, keys: [{t_s: 0.1, position_m: [-0.0075, -0.03, 0.003]}, {t_s: 0.2, position_m: "
      "[-0.0075, -0.03, 0.003], button1: true}, {t_s: 0.6, position_m: [-0.0075, 0.03, 0.003], button1: true}]}]\n");
  const Ending ending = viscera({"task", task, "--strokes", strokes, "--no-view", "--set", "solver.threads=1"});
  EXPECT_EQ(ending.status, 0) << ending.err;
  return lastLine(ending)["tasks"][0];
}

TEST(TaskCommand, TissueThatFibresHoldIsNotCutFree) {
  EXPECT_EQ(cutFree("")["state"], "passed");
  EXPECT_EQ(cutFree("attachments: [{body_a: low, body_b: high}]\n")["state"], "failed");
}

TEST(TaskCommand, CutsInSparedPartsFailATask) {
  const Ending ending = operationOnPad("spared_parts: [pad]\nmeasures: [{measure: spared_cuts, most: 0}]\n");
  ASSERT_EQ(ending.status, 0) << ending.err;
  const nlohmann::json result = lastLine(ending)["tasks"][0];
  EXPECT_EQ(result["state"], "failed");
  EXPECT_EQ(result["failed_limit"], "spared_cuts");
  EXPECT_GT(result["measures"]["spared_cuts"]["value"], 0);
  EXPECT_LT(result["time_s"], 2);  // it ends with the first of them
  const Ending unknown = operationOnPad("spared_parts: [liver]\n");
  EXPECT_EQ(unknown.status, 1);
  EXPECT_NE(unknown.err.find("'spared_parts' must name bodies or parts, of pad, box; found 'liver'"), std::string::npos)
      << unknown.err;
}

/// Each stage has two of the four clips. The other two are not bad clips of it.
TEST(TaskCommand, ClipsOfOneStageAreNotBadClipsOfAnother) {
  const TemporaryFolder folder;
  const std::string task =
      folder.write("two.yaml",
                   "scene: practice_vessel\nkind: operation\noperation:\n  stages:\n"
                   "    - {kind: clip_and_divide, clip_and_divide: {clips: [{position_m: [-0.014, 0, 0]}, "
                   "{position_m: [0.014, 0, 0]}]}}\n"
                   "    - {kind: clip_and_divide, clip_and_divide: {clips: [{position_m: [-0.008, 0, 0]}, "
                   "{position_m: [0.008, 0, 0]}]}}\n"
                   "measures: [{measure: bad_clips, most: 0}]\n");
  const Ending ending = viscera(
      {"task", task, "--strokes", strokesOf("clip_and_divide", "good"), "--no-view", "--set", "solver.threads=1"});
  ASSERT_EQ(ending.status, 0) << ending.err;
  const nlohmann::json result = lastLine(ending)["tasks"][0];
  EXPECT_EQ(result["state"], "passed") << result["why"];
  EXPECT_EQ(result["measures"]["bad_clips"]["value"], 0);
}

TEST(TaskCommand, KinematicsHaveTheColumnsOfJigsaws) {
  constexpr double kRowDigits = 1e-6;  // as printed
  const TemporaryFolder folder;
  const std::string out = folder.file("out");
  judged("touch_targets", "good", {"--out", out});
  std::ifstream file(out + "/kinematics.txt");
  std::string line;
  std::vector<std::vector<double>> rows;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    rows.emplace_back(std::istream_iterator<double>(words), std::istream_iterator<double>());
    ASSERT_EQ(rows.back().size(), 76u);
  }
  EXPECT_EQ(rows.size(), static_cast<size_t>(6.4 * 30)) << "30 a second, of 6.4 s";
  const std::vector<double>& row = rows[30];  // 1 s: on the path up from the first mark
  for (const size_t right : {19u, 57u}) {     // master and slave; the left tool has no pose
    EXPECT_NEAR(row[right], -0.03, kRowDigits) << "x of the first mark";
    EXPECT_NEAR(row[right + 3], 1, kRowDigits);
    EXPECT_NEAR(row[right + 4], 0, kRowDigits);
    EXPECT_NEAR(row[right + 14], (row[right + 2] - rows[29][right + 2]) * 30, 1e-3) << "speed along z, m/s";
    EXPECT_NEAR(row[right + 18], 1, kRowDigits) << "button 1 is not pressed";
  }
  for (size_t i = 0; i < 19; ++i) EXPECT_EQ(row[i], 0);
}

TEST(TaskCommand, KinematicsSayHowFarJawsAreOpen) {
  constexpr double kDigits = 1e-6;  // as printed
  constexpr double kAngle_rad = 0.4;
  const TemporaryFolder folder;
  const std::string out = folder.file("out");
  const std::string strokes = folder.write(
      "closing.yaml",
      "strokes: [{stylus: left, keys: [{t_s: 0, position_m: [0, -0.3, 0], jaw_rad: 0.4}, {t_s: 0.5, position_m: [0, "
      "-0.3, 0], jaw_rad: 0.4}, {t_s: 1, position_m: [0, -0.3, 0], jaw_rad: 0}]}]");
  const Ending run = viscera({"run", "heart", "--no-view", "--set", "bodies[0].spacing_m=0.01", "--set",
                              "styluses[0].idle=grasper", "--strokes", strokes, "--seconds", "1", "--out", out});
  ASSERT_EQ(run.status, 0);
  std::ifstream file(out + "/kinematics.txt");
  std::vector<double> all{std::istream_iterator<double>(file), std::istream_iterator<double>()};
  ASSERT_GE(all.size(), 76u * 24);
  const double* early = &all[76 * 12];
  const double* late = &all[76 * 23];
  EXPECT_NEAR(early[18], kAngle_rad, kDigits) << "as the hand tells";
  EXPECT_NEAR(early[56], kAngle_rad, kDigits) << "as the jaws stand";
  EXPECT_LT(late[18], 0.5 * kAngle_rad);
  EXPECT_NEAR(late[56], late[18], 0.05) << "a tick later, if at all";
}

TEST(TaskCommand, ErrorsNameTheFileTheLineAndTheKey) {
  const TemporaryFolder folder;
  const auto complaint = [&](const std::string& file) {
    const std::vector<std::string> errors = complaints(viscera({"task", file, "--no-view"}));
    return errors.empty() ? "" : errors[0];
  };
  const std::string close =
      "kind: close_wound\nclose_wound: {path: [{position_m: [5, 0, 0]}, {position_m: [5, 1, 0]}]}\n";
  const std::string sutureless = complaint(folder.write("bare.yaml", "scene: practice_pad\n" + close));
  EXPECT_NE(sutureless.find("bare: 'kind' close_wound needs a scene with 'sutures'"), std::string::npos) << sutureless;
  const std::string away = complaint(folder.write("away.yaml", "scene: wound_pad\n" + close));
  EXPECT_NE(away.find("away: 'close_wound.path' has no tissue"), std::string::npos) << away;
  const std::string clipless = complaint(folder.write(
      "none.yaml", "scene: gauze\nkind: clip_and_divide\nclip_and_divide: {clips: [{position_m: [0, 0, 0]}, {}]}\n"));
  EXPECT_NE(clipless.find("none: 'kind' clip_and_divide needs a scene with a stylus that has mode clip"),
            std::string::npos)
      << clipless;
  const std::string spoilt = folder.write("spoilt.yaml", "scene: gauze\nkind: lift\nlift: {radius_m: -1}\n");
  const std::string error = complaint(spoilt);
  EXPECT_NE(error.find("spoilt.yaml:3: 'lift.radius_m'"), std::string::npos) << error;
  EXPECT_NE(error.find("1e-05 .. 1 m"), std::string::npos) << error;
  EXPECT_NE(complaint("nowhere").find("shipped task"), std::string::npos);
}

}  // namespace
}  // namespace viscera
