// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/strokes.h"

#include <gtest/gtest.h>

#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/math/error.h"

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
                   {"f.yaml:5: ", "unknown key 'strokes[0].keys[1].time'", "t_s, position_m"}));
  EXPECT_TRUE(says(keysRefusal("      - {t_s: -1}\n"), {"f.yaml:4: ", "'strokes[0].keys[0].t_s'", "0 .. 3600 s"}));
  EXPECT_TRUE(says(keysRefusal("      - {t_s: .nan}\n"), {"f.yaml:4: ", "'strokes[0].keys[0].t_s'", "0 .. 3600 s"}));
  EXPECT_TRUE(
      says(keysRefusal("      - {position_m: [0, .inf, 0]}\n"), {"f.yaml:4: ", "position_m'", "-100 .. 100 m"}));
  EXPECT_TRUE(says(keysRefusal("      - {rotation_deg: [0, 0]}\n"), {"f.yaml:4: ", "rotation_deg'", "3 numbers"}));
  EXPECT_TRUE(says(keysRefusal("      - {button1: pressed}\n"), {"f.yaml:4: ", "button1'", "true or false"}));
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

constexpr const char* kTwoHands =
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
  EXPECT_EQ(parseStrokes(kTwoHands, "f.yaml").duration_s(), 3);
}

TEST(Strokes, KeepTheirMarks) {
  const Strokes strokes = parseStrokes(kTwoHands, "f.yaml");
  ASSERT_EQ(strokes.marks.size(), 1u);
  EXPECT_EQ(strokes.marks[0].name, "touch");
  EXPECT_EQ(strokes.marks[0].time_s, 1.5);
}

TEST(Strokes, GoToTheStylusOfTheirName) {
  EXPECT_EQ(sample(kTwoHands, 2.5, 0).pose.position_m.x(), 7);
  EXPECT_LT(sample(kTwoHands, 2.5, 1).pose.position_m.x(), 1);
}

TEST(Strokes, StylusIsUnknownBeforeItsFirstKey) {
  EXPECT_FALSE(sample(kTwoHands, 0.999, 1).valid);
  EXPECT_TRUE(sample(kTwoHands, 1, 1).valid);
}

TEST(Strokes, PoseIsInterpolatedBetweenKeysAndHeldAfterTheLast) {
  constexpr double kRounding = 1e-12;
  const StylusSample quarter = sample(kTwoHands, 1.5, 1);
  EXPECT_LT((quarter.pose.position_m - Vector3d(0.05, 0, 0.1)).norm(), kRounding);
  EXPECT_LT(quarter.pose.orientation.angularDistance(rotationFromDegrees({0, 0, 22.5})), kRounding);
  const StylusSample after = sample(kTwoHands, 100, 1);
  EXPECT_TRUE(after.valid);
  EXPECT_LT((after.pose.position_m - Vector3d(0.2, 0, 0.4)).norm(), kRounding);
}

TEST(Strokes, ButtonsAreThoseOfTheLastKey) {
  EXPECT_TRUE(sample(kTwoHands, 2.999, 1).button1);
  EXPECT_FALSE(sample(kTwoHands, 3, 1).button1);
  EXPECT_TRUE(sample(kTwoHands, 100, 0).button2);
}

TEST(Strokes, LaterStrokeOfAStylusTakesOverWhenItBegins) {
  const std::string yaml =
      "strokes:\n"
      "  - {stylus: left, keys: [{t_s: 0, position_m: [1, 0, 0]}]}\n"
      "  - {stylus: left, keys: [{t_s: 5, position_m: [2, 0, 0]}]}\n";
  EXPECT_EQ(sample(yaml, 4.9).pose.position_m.x(), 1);
  EXPECT_EQ(sample(yaml, 5).pose.position_m.x(), 2);
}

}  // namespace
}  // namespace viscera
