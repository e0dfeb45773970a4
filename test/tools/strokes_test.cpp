// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/strokes.h"

#include <gtest/gtest.h>

#include <random>

#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/stylus_config.h"

namespace viscera {
namespace {

using test::says;

std::string refusal(const std::string& yaml) {
  return test::messageOf<StrokesError>([&] { parseStrokes(yaml, "f.yaml"); });
}
std::string keysRefusal(const std::string& keys) {
  return refusal("strokes:\n  - stylus: left\n    keys:\n" + keys);
}

std::vector<StylusConfig> leftAndRight() {
  std::vector<StylusConfig> configs(2);
  configs[0].name = "left";
  configs[1].name = "right";
  return configs;
}

StylusSample sample(const std::string& yaml, double time_s, size_t stylus = 0) {
  return parseStrokes(yaml, "f.yaml").at(time_s, leftAndRight())[stylus];
}

TEST(StrokesFile, BadKeyIsRefusedWithFileLineKeyAndRange) {
  EXPECT_TRUE(says(keysRefusal("      - {t_s: 0}\n      - {time: 1}\n"),
                   {"f.yaml:5: ", "unknown key 'strokes[0].keys[1].time'", "t_s, at, button1, position_m"}));
  EXPECT_TRUE(says(keysRefusal("      - {t_s: -1}\n"), {"f.yaml:4: ", "'strokes[0].keys[0].t_s'", "0 .. 3600 s"}));
  EXPECT_TRUE(says(keysRefusal("      - {t_s: .nan}\n"), {"f.yaml:4: ", "'strokes[0].keys[0].t_s'", "0 .. 3600 s"}));
  EXPECT_TRUE(
      says(keysRefusal("      - {position_m: [0, .inf, 0]}\n"), {"f.yaml:4: ", "position_m'", "-100 .. 100 m"}));
  EXPECT_TRUE(says(keysRefusal("      - {rotation_deg: [0, 0]}\n"), {"f.yaml:4: ", "rotation_deg'", "3 numbers"}));
  EXPECT_TRUE(says(keysRefusal("      - {button1: pressed}\n"), {"f.yaml:4: ", "button1'", "true or false"}));
}

TEST(StrokesFile, KeysRelativeToPartsNeedAPartAndNoPosition) {
  const Strokes strokes = parseStrokes(
      "strokes: [{stylus: left, keys: [{at: {part: duct, from: neck, along: 0.3, offset_m: [1, 2, 3]}}]}]", "f.yaml");
  ASSERT_TRUE(strokes.strokes[0].keys[0].at);
  EXPECT_EQ(strokes.strokes[0].keys[0].at->from, "neck");
  EXPECT_TRUE(strokes.anchored());
  EXPECT_TRUE(says(keysRefusal("      - {at: {along: 0.3}}\n"), {"f.yaml:4: ", "keys[0]", "'at' needs 'part'"}));
  EXPECT_TRUE(says(keysRefusal("      - {at: {part: duct}, position_m: [0, 0, 0]}\n"), {"keys[0]", "'position_m'"}));
  EXPECT_TRUE(says(keysRefusal("      - {at: {part: duct, along: 2}}\n"), {"keys[0].at.along'", "0 .. 1"}));
}

TEST(StrokesFile, TimesThatDoNotIncreaseAreRefusedWithTheLine) {
  EXPECT_TRUE(says(keysRefusal("      - {t_s: 1}\n      - {t_s: 2}\n      - {t_s: 2}\n"),
                   {"f.yaml:6: ", "strokes[0]", "keys[2]", "'t_s' must be greater", "found 2"}));
}

TEST(StrokesFile, StrokeThatLacksSomethingIsRefusedWithTheLine) {
  EXPECT_TRUE(says(refusal("strokes:\n  - keys: [{}]\n"), {"f.yaml:2: ", "strokes[0]", "'stylus'"}));
  EXPECT_TRUE(says(refusal("strokes:\n  - stylus: left\n"), {"f.yaml:2: ", "strokes[0]", "'keys'"}));
  EXPECT_TRUE(
      says(refusal("strokes:\n  - {stylus: left, keys: [{}], anchor: {from_m: [1, 1, 1], towards_m: [1, 1, 1]}}\n"),
           {"f.yaml:2: ", "strokes[0]", "anchor", "must differ"}));
  EXPECT_TRUE(says(refusal("strokes: []\n"), {"f.yaml", "at least one stroke"}));
}

TEST(StrokesFile, BadMarkIsRefusedWithTheLine) {
  const std::string stroke = "strokes: [{stylus: left, keys: [{}]}]\nmarks:\n";
  EXPECT_TRUE(says(refusal(stroke + "  - {t_s: 1}\n"), {"f.yaml:3: ", "'name'"}));
  EXPECT_TRUE(says(refusal(stroke + "  - {name: ../../etc/passwd, t_s: 1}\n"), {"f.yaml:3: ", "'name'", "'/'"}));
  EXPECT_TRUE(says(refusal(stroke + "  - {name: dent, t_s: 4000}\n"), {"f.yaml:3: ", "'marks[0].t_s'", "0 .. 3600 s"}));
}

TEST(StrokesFile, FileThatCannotBeUsedIsNamed) {
  const test::TemporaryFolder folder;
  const auto loading = [](const std::string& path) {
    return test::messageOf<StrokesError>([&] { loadStrokes(path); });
  };
  EXPECT_TRUE(says(loading(folder.file("none.yaml")), {folder.file("none.yaml"), "cannot be read"}));
  EXPECT_TRUE(says(loading(folder.path()), {folder.path(), "is a folder"}));
  EXPECT_TRUE(says(loading(folder.write("empty.yaml", "")), {folder.file("empty.yaml")}));
  EXPECT_TRUE(says(loading(folder.write("list.yaml", "- a\n")), {folder.file("list.yaml") + ":1: "}));
  EXPECT_TRUE(says(loading(folder.write("broken.yaml", "strokes:\n  - {stylus: [\n")), {"broken.yaml:3: "}));
}

constexpr const char* kTwoTools =
    "strokes:\n"
    "  - stylus: right\n"
    "    keys:\n"
    "      - {t_s: 1, position_m: [0, 0, 0], button1: true}\n"
    "      - {t_s: 3, position_m: [0.2, 0, 0.4], rotation_deg: [0, 0, 90]}\n"
    "  - stylus: left\n"
    "    keys:\n"
    "      - {t_s: 2, position_m: [7, 0, 0], button2: true}\n"
    "marks: [{name: touch, t_s: 1.5}]\n";

TEST(Strokes, LastAsLongAsTheirLastKey) {
  EXPECT_EQ(parseStrokes(kTwoTools, "f.yaml").duration_s(), 3);
}

TEST(Strokes, KeepTheirMarks) {
  const Strokes strokes = parseStrokes(kTwoTools, "f.yaml");
  ASSERT_EQ(strokes.marks.size(), 1u);
  EXPECT_EQ(strokes.marks[0].name, "touch");
  EXPECT_EQ(strokes.marks[0].time_s, 1.5);
}

TEST(Strokes, GoToTheStylusOfTheirName) {
  EXPECT_EQ(sample(kTwoTools, 2.5, 0).pose.position_m.x(), 7);
  EXPECT_LT(sample(kTwoTools, 2.5, 1).pose.position_m.x(), 1);
}

TEST(Strokes, StylusIsUnknownBeforeItsFirstKey) {
  EXPECT_FALSE(sample(kTwoTools, 0.999, 1).valid);
  EXPECT_TRUE(sample(kTwoTools, 1, 1).valid);
}

TEST(Strokes, PoseIsInterpolatedBetweenKeysAndHeldAfterTheLast) {
  constexpr double kRounding = 1e-12;
  const StylusSample quarter = sample(kTwoTools, 1.5, 1);
  EXPECT_LT((quarter.pose.position_m - Vector3d(0.05, 0, 0.1)).norm(), kRounding);
  EXPECT_LT(quarter.pose.orientation.angularDistance(rotationFromDegrees({0, 0, 22.5})), kRounding);
  const StylusSample after = sample(kTwoTools, 100, 1);
  EXPECT_TRUE(after.valid);
  EXPECT_LT((after.pose.position_m - Vector3d(0.2, 0, 0.4)).norm(), kRounding);
}

TEST(Strokes, ButtonsAreThoseOfTheLastKey) {
  EXPECT_TRUE(sample(kTwoTools, 2.999, 1).button1);
  EXPECT_FALSE(sample(kTwoTools, 3, 1).button1);
  EXPECT_TRUE(sample(kTwoTools, 100, 0).button2);
}

TEST(Strokes, LaterStrokeOfAStylusTakesOverWhenItBegins) {
  const std::string yaml =
      "strokes:\n"
      "  - {stylus: left, keys: [{t_s: 0, position_m: [1, 0, 0]}]}\n"
      "  - {stylus: left, keys: [{t_s: 5, position_m: [2, 0, 0]}]}\n";
  EXPECT_EQ(sample(yaml, 4.9).pose.position_m.x(), 1);
  EXPECT_EQ(sample(yaml, 5).pose.position_m.x(), 2);
}

constexpr const char* kRecorded =
    "tick_hz: 100\n"
    "ticks: 12\n"
    "input_reset: [3, 9]\n"
    "strokes:\n"
    "  - stylus: left\n"
    "    samples: |\n"
    "      2 0.1 0 0 0 0 0 1 0 0\n"
    "      3 0.2 0 0 0 0 0 1 1 0\n"
    "      7 0.3 0 0 0 0 0 1 0 1\n";

std::string recordedRefusal(const std::string& before, const std::string& after) {
  std::string yaml = kRecorded;
  const size_t at = yaml.find(before);
  EXPECT_NE(at, std::string::npos) << before;
  return refusal(yaml.replace(at, before.size(), after));
}

TEST(RecordedStrokes, AreThoseOfTheirTickAndAbsentInOthers) {
  const auto at = [](int tick) { return sample(kRecorded, tick * 0.01); };
  EXPECT_FALSE(at(1).valid);
  EXPECT_EQ(at(2).pose.position_m.x(), 0.1);
  EXPECT_EQ(at(3).pose.position_m.x(), 0.2);
  EXPECT_TRUE(at(3).button1);
  EXPECT_FALSE(at(4).valid);
  EXPECT_TRUE(at(7).button2);
  EXPECT_FALSE(at(8).valid);
  EXPECT_EQ(sample(kRecorded, 0.0299).pose.position_m.x(), 0.1);  // between ticks: no interpolation
}

TEST(RecordedStrokes, TicksAreFoundAgainByTheirTimesAtAnyRate) {
  for (const double hz : {1.0, 30.0, 59.94, 60.0, 100.0, 333.3, 1000.0}) {
    Strokes strokes;
    strokes.tick_hz = hz;
    strokes.ticks = 3600 * 30;
    strokes.strokes.emplace_back().stylus = "left";
    for (uint64_t tick = 1; tick <= strokes.ticks; tick += 97) {
      strokes.strokes[0].samples = {{tick, Pose{}, false, false}};
      const double tick_s = 1 / hz;  // as a session computes it
      ASSERT_TRUE(strokes.at(static_cast<double>(tick) * tick_s, leftAndRight())[0].valid) << tick << " at " << hz;
    }
  }
}

TEST(RecordedStrokes, LastAsLongAsTheyWereRecorded) {
  const Strokes strokes = parseStrokes(kRecorded, "f.yaml");
  EXPECT_EQ(strokes.duration_s(), 0.12);
  EXPECT_TRUE(strokes.inputReset(3) && strokes.inputReset(9));
  EXPECT_FALSE(strokes.inputReset(4));
}

TEST(RecordedStrokes, ComeBackToTheBit) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  Strokes was;
  was.tick_hz = 1000.0 / 7;
  was.ticks = 400;
  was.input_reset = {1, 300};
  was.recorded = {"heart", "bodies[0].spacing_m=0.004;environment.gravity_m_per_s2=[0,0,0]", "0000000000012345"};
  was.strokes.resize(2);
  was.strokes[0].stylus = "left";
  was.strokes[1].stylus = "right";  // a stylus that was never tracked
  for (uint64_t tick = 1; tick <= 300; ++tick) {
    const Vector3d position(anywhere(random), 1e-9 * anywhere(random), 1e-310 * anywhere(random));
    const Quaterniond turn = Quaterniond(anywhere(random), anywhere(random), anywhere(random), anywhere(random));
    const float jaw_rad = tick % 5 == 0 ? kNoJaw : static_cast<float>(std::abs(anywhere(random)));
    was.strokes[0].samples.push_back({tick, {position, turn.normalized()}, tick % 3 == 0, tick % 2 == 0, jaw_rad});
  }
  const Strokes is = parseStrokes(strokesYaml(was), "f.yaml");
  EXPECT_EQ(is.tick_hz, was.tick_hz);
  EXPECT_EQ(is.ticks, was.ticks);
  EXPECT_EQ(is.input_reset, was.input_reset);
  EXPECT_EQ(is.recorded.scene, was.recorded.scene);
  EXPECT_EQ(is.recorded.overrides, was.recorded.overrides);
  EXPECT_EQ(is.recorded.state_hash, was.recorded.state_hash);
  ASSERT_EQ(is.strokes.size(), 2u);
  EXPECT_TRUE(is.strokes[1].samples.empty());
  ASSERT_EQ(is.strokes[0].samples.size(), was.strokes[0].samples.size());
  for (size_t i = 0; i < is.strokes[0].samples.size(); ++i) {
    const Stroke::Sample &a = was.strokes[0].samples[i], &b = is.strokes[0].samples[i];
    EXPECT_EQ(a.tick, b.tick);
    EXPECT_EQ(a.pose.position_m, b.pose.position_m);
    EXPECT_EQ(a.pose.orientation.coeffs(), b.pose.orientation.coeffs());
    EXPECT_EQ(a.button1, b.button1);
    EXPECT_EQ(a.button2, b.button2);
    EXPECT_EQ(a.jaw_rad, b.jaw_rad);
  }
}

TEST(Strokes, JawsGoEvenlyBetweenKeysThatTellThemAndAreUnknownElsewhere) {
  const std::string keys =
      "strokes:\n  - stylus: left\n    keys:\n      - {t_s: 0, jaw_rad: 0.6}\n      - {t_s: 1, jaw_rad: 0.2}\n"
      "      - {t_s: 2}\n      - {t_s: 3}\n";
  const Strokes strokes = parseStrokes(keys, "f.yaml");
  std::vector<StylusConfig> styluses(1);
  styluses[0].name = "left";
  EXPECT_FLOAT_EQ(strokes.at(0.25, styluses)[0].jaw_rad, 0.5F);
  EXPECT_FLOAT_EQ(strokes.at(1.5, styluses)[0].jaw_rad, 0.2F);
  EXPECT_EQ(strokes.at(2.5, styluses)[0].jaw_rad, kNoJaw);
  const Strokes again = parseStrokes(strokesYaml(strokes), "f.yaml");
  EXPECT_FLOAT_EQ(again.at(0.25, styluses)[0].jaw_rad, 0.5F);
  try {
    parseStrokes("strokes:\n  - stylus: left\n    keys:\n      - {t_s: 0, jaw_rad: 4}\n", "f.yaml");
    FAIL() << "no jaw opens so far";
  } catch (const StrokesError& error) {
    EXPECT_NE(std::string(error.what()).find("jaw_rad"), std::string::npos) << error.what();
  }
}

TEST(RecordedStrokes, BadLinesAreRefusedWithTheirNumber) {
  EXPECT_TRUE(says(recordedRefusal("7 0.3 0", "7 0.3"), {"f.yaml:9: ", "tick x y z qx qy qz qw", "found '7 0.3 0 0"}));
  EXPECT_TRUE(says(recordedRefusal("2 0.1", "2 nan"), {"f.yaml:7: "}));
  EXPECT_TRUE(says(recordedRefusal("2 0.1", "2 1e9"), {"f.yaml:7: ", "-100 .. 100 m"}));
  EXPECT_TRUE(says(recordedRefusal("2 0.1", "0 0.1"), {"f.yaml:7: "}));
  EXPECT_TRUE(says(recordedRefusal("2 0.1", "-2 0.1"), {"f.yaml:7: "}));
  EXPECT_TRUE(says(recordedRefusal("3 0.2", "2 0.2"), {"f.yaml:8: ", "greater than the one before"}));
  EXPECT_TRUE(says(recordedRefusal("1 1 0\n", "1 2 0\n"), {"f.yaml:8: ", "buttons 0 or 1"}));
  EXPECT_TRUE(says(recordedRefusal("1 0 1\n", "0.9 0 1\n"), {"f.yaml:9: ", "length 1"}));
  EXPECT_TRUE(says(recordedRefusal("1 0 1\n", "1 0 1 4\n"), {"f.yaml:9: ", "0 .. 3.1416 rad"}));
  EXPECT_TRUE(says(recordedRefusal("1 0 1\n", "1 0 1 -1\n"), {"f.yaml:9: "}));
  EXPECT_TRUE(says(recordedRefusal("1 0 1\n", "1 0 1 nan\n"), {"f.yaml:9: "}));
  EXPECT_TRUE(says(recordedRefusal("1 0 1\n", "1 0 1 0 0\n"), {"f.yaml:9: "}));
}

TEST(RecordedStrokes, WhatDoesNotFitIsRefused) {
  EXPECT_TRUE(says(recordedRefusal("tick_hz: 100\n", ""), {"f.yaml: ", "'tick_hz'"}));
  EXPECT_TRUE(says(recordedRefusal("ticks: 12\n", ""), {"f.yaml: ", "'ticks'"}));
  EXPECT_TRUE(says(recordedRefusal("ticks: 12\n", "ticks: 6\n"), {"f.yaml: ", "'left'", "tick 7", "'ticks' is 6"}));
  EXPECT_TRUE(says(recordedRefusal("[3, 9]", "[9, 3]"), {"f.yaml: ", "'input_reset'"}));
  EXPECT_TRUE(says(recordedRefusal("[3, 9]", "[0]"), {"f.yaml:3: ", "'input_reset'"}));
  EXPECT_TRUE(says(recordedRefusal("    samples", "    keys: [{}]\n    samples"),
                   {"f.yaml:5: ", "cannot be combined with 'keys'"}));
  EXPECT_TRUE(says(recordedRefusal("samples: |", "samples: []\n    stylus2: |"),
                   {"f.yaml:6: ", ".samples'", "a block of lines"}));
  const Strokes strokes = parseStrokes(kRecorded, "f.yaml");
  EXPECT_TRUE(
      says(test::messageOf<StrokesError>([&] { strokes.requireTickRate(60); }), {"f.yaml: ", "100 Hz", "60 Hz"}));
  EXPECT_NO_THROW(strokes.requireTickRate(100));
}

}  // namespace
}  // namespace viscera
