// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/device_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "devices/device_map.h"
#include "math/decompositions.h"

namespace viscera {
namespace {

using Grade = Verdict::Grade;

constexpr double kSpan_s = 2, kRate_hz = 100;
const PosePort kPort;
const Quaterniond kNoTurn = Quaterniond::Identity();

DeviceProfile profileOf(const std::string& yaml = "about: a device\n", const Overrides& overrides = {}) {
  DeviceChoice choice;
  choice.stylus = "left";
  choice.overrides = overrides;
  return parseDevice(yaml, "device.yaml", choice);
}

/// Returns the poses of a device with this true profile that moves from one pose to another (tissue frame).
std::vector<ReceivedPose> course(const DeviceProfile& truth, const Pose& from, const Pose& to,
                                 const Quaterniond& base = kNoTurn) {
  const DeviceMap map(truth);
  std::vector<ReceivedPose> out;
  for (int i = 0; i <= static_cast<int>(kSpan_s * kRate_hz); ++i) {
    const double t = i / kRate_hz, s = std::clamp((t - 0.5) / (kSpan_s - 1), 0.0, 1.0);
    const Pose at{from.position_m + s * (to.position_m - from.position_m), from.orientation.slerp(s, to.orientation)};
    ReceivedPose heard;
    heard.came_s = t;
    heard.clock_s = 100 + t;
    heard.stamp_s = heard.clock_s - 0.001;
    heard.pose = map.fromBase({base.conjugate() * at.position_m, base.conjugate() * at.orientation});
    heard.frame = "base";
    out.push_back(heard);
  }
  return out;
}

const Pose kBegin{{0.01, -0.09, 0.02}, Quaterniond(0.9, 0.1, 0.3, -0.3).normalized()};

Pose after(Asked asked) {
  const Vector3d displacement = directionOf(asked);
  const bool turn = asked == Asked::kTurnLeft || asked == Asked::kTiltRight || asked == Asked::kTiltAway;
  if (turn)
    return {kBegin.position_m, Quaterniond(Eigen::AngleAxisd(kAskedTurn_rad, displacement)) * kBegin.orientation};
  return {kBegin.position_m + 0.9 * kAskedMotion_m * displacement, kBegin.orientation};
}

constexpr Asked kAll[] = {Asked::kRight,    Asked::kUp,        Asked::kTowards,
                          Asked::kTurnLeft, Asked::kTiltRight, Asked::kTiltAway};

DeviceMotions motionsOf(const DeviceProfile& truth, const Quaterniond& base = kNoTurn) {
  DeviceMotions out;
  for (Asked asked : kAll) out.of(asked) = motionOf(course(truth, kBegin, after(asked), base));
  return out;
}

/// Returns whether a verdict of this grade contains a text.
bool says(const std::vector<Verdict>& verdicts, Grade grade, const std::string& text) {
  return std::any_of(verdicts.begin(), verdicts.end(), [&](const Verdict& verdict) {
    return verdict.grade == grade && verdict.text.find(text) != std::string::npos;
  });
}

/// Returns whether a verdict says that no profile helps.
bool isBeyond(const std::vector<Verdict>& verdicts) {
  return std::any_of(verdicts.begin(), verdicts.end(), [](const Verdict& verdict) { return verdict.beyond_profile; });
}

Verdict judged(Asked asked, const DeviceProfile& truth, const DeviceProfile& profile) {
  return judgeMotion(asked, *motionOf(course(truth, kBegin, after(asked))), profile, kNoTurn);
}

TEST(DeviceCheck, EveryAxesAndUnitIsFoundWhateverTheProfileSays) {
  const DeviceProfile wrong = profileOf("about: a device\n", {"pose.axes=y z x"});
  for (const char* axes : {"x y z", "x -z y", "x -y -z", "-y x z", "z x y", "-x -y z"})
    for (const double unit_m : {1.0, 0.001, 0.01, 0.0254}) {
      DeviceProfile truth = profileOf();
      truth.pose.axes = axes;
      truth.pose.unit_m = unit_m;
      const FoundMap found = findMap(motionsOf(truth), wrong, kNoTurn);
      EXPECT_EQ(found.axes.value_or("none"), axes);
      EXPECT_EQ(found.turn_axes.value_or("none"), axes);
      EXPECT_EQ(found.unit_m.value_or(0), unit_m) << axes;
      DeviceChoice choice;
      choice.stylus = "left";
      const std::string text = correctedProfile("about: a device\n", correctionsOf(found, profileOf()), {"found"});
      const DeviceProfile mended = parseDevice(text, "mended.yaml", choice);
      EXPECT_EQ(text.rfind("# found\n", 0), 0u) << text;
      for (Asked asked : kAll) EXPECT_EQ(judged(asked, truth, mended).grade, Grade::kRight) << text;
    }
}

TEST(DeviceCheck, DriversThatTurnOrientationsOtherwiseAreFound) {
  const DeviceProfile truth = profileOf("{about: a, pose: {turn_axes: x -z y}}");
  const FoundMap found = findMap(motionsOf(truth), profileOf(), kNoTurn);
  EXPECT_EQ(found.axes.value_or("none"), "x y z");
  EXPECT_EQ(found.turn_axes.value_or("none"), "x -z y");
  EXPECT_EQ(correctionsOf(found, profileOf()), Overrides{"pose.turn_axes=\"x -z y\""});
  EXPECT_TRUE(correctionsOf(found, truth).empty());
}

TEST(DeviceCheck, WordsForWhatAWrongProfileDoes) {
  const DeviceProfile plain = profileOf(), up = profileOf("{about: a, pose: {axes: x -z y}}"),
                      round = profileOf("{about: a, pose: {axes: -x -y z}}");
  EXPECT_EQ(judged(Asked::kRight, plain, plain).text, "right: right, by 90.00 mm");
  EXPECT_EQ(judged(Asked::kRight, plain, round).text, "right: mirrored, the tool goes left");
  EXPECT_EQ(judged(Asked::kTowards, plain, round).text, "towards you: mirrored, the tool goes away from you");
  EXPECT_EQ(judged(Asked::kUp, up, plain).text, "up: axes are swapped, the tool goes away from you");
  EXPECT_EQ(judged(Asked::kTurnLeft, up, plain).text,
            "turn to the left: axes are swapped, the tool tilts to the right");
  EXPECT_EQ(judged(Asked::kTiltRight, plain, round).text, "tilt to the right: mirrored, the tool tilts to the left");
  EXPECT_EQ(judged(Asked::kTiltAway, plain, plain).text, "tilt away from you: right, by 46 degrees");
  const Quaterniond askew(Eigen::AngleAxisd(0.8, Vector3d::UnitZ()));
  const DeviceMotion motion = *motionOf(course(plain, kBegin, after(Asked::kRight)));
  EXPECT_NE(judgeMotion(Asked::kRight, motion, plain, askew).text.find("oblique"), std::string::npos);
}

TEST(DeviceCheck, ABaseThatTfTurnsByRightAnglesCounts) {
  const Quaterniond base(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()));
  const DeviceProfile truth = profileOf("{about: a, pose: {axes: x -z y, unit_m: 0.001}}");
  const FoundMap found = findMap(motionsOf(truth, base), profileOf(), base);
  EXPECT_EQ(found.axes.value_or("none"), "x -z y");
  EXPECT_EQ(found.unit_m.value_or(0), 0.001);
  EXPECT_TRUE(says(found.verdicts, Grade::kWrong, "moves 9000 cm: the device sends millimetres"));
}

TEST(DeviceCheck, WhatNoProfileMendsIsSaid) {
  DeviceMotions motions = motionsOf(profileOf());
  motions.right->displacement *= -1;
  FoundMap found = findMap(motions, profileOf(), kNoTurn);
  EXPECT_FALSE(found.axes);
  EXPECT_TRUE(says(found.verdicts, Grade::kWrong, "places: a mirror image"));
  EXPECT_TRUE(isBeyond(found.verdicts));
  motions = motionsOf(profileOf());
  for (auto* turn : {&motions.turn_left, &motions.tilt_right, &motions.tilt_away}) (*turn)->turn *= -1;
  found = findMap(motions, profileOf(), kNoTurn);
  EXPECT_FALSE(found.turn_axes);
  EXPECT_TRUE(says(found.verdicts, Grade::kWrong, "orientations: a mirror image"));
  EXPECT_TRUE(isBeyond(found.verdicts));
  const Quaterniond askew(Eigen::AngleAxisd(0.8, Vector3d::UnitZ()));
  found = findMap(motionsOf(profileOf()), profileOf(), askew);
  EXPECT_FALSE(found.axes);
  EXPECT_TRUE(says(found.verdicts, Grade::kWrong, "its base is rotated"));
  EXPECT_FALSE(isBeyond(found.verdicts)) << "register_stylus finds the base";
  motions = motionsOf(profileOf("{about: a, pose: {unit_m: 10}}"));
  found = findMap(motions, profileOf(), kNoTurn);
  EXPECT_FALSE(found.unit_m);
  EXPECT_TRUE(says(found.verdicts, Grade::kWrong, "none of metres"));
}

TEST(DeviceCheck, MotionsThatWereNotMadeAreUnclear) {
  const DeviceMotion still = *motionOf(course(profileOf(), kBegin, kBegin));
  EXPECT_TRUE(unclear(Asked::kTurnLeft, still, 0));
  EXPECT_TRUE(unclear(Asked::kRight, DeviceMotion{}, 0));
  const DeviceMotion right = *motionOf(course(profileOf(), kBegin, after(Asked::kRight)));
  EXPECT_FALSE(unclear(Asked::kRight, right, 0.001));
  EXPECT_TRUE(unclear(Asked::kRight, right, 0.02));
  EXPECT_FALSE(motionOf({}));
  std::vector<ReceivedPose> bad = course(profileOf(), kBegin, kBegin);
  for (ReceivedPose& heard : bad) heard.pose.orientation.coeffs().setZero();
  EXPECT_FALSE(motionOf(bad));
}

TEST(DeviceCheck, StreamOfAGoodDevice) {
  for (const Verdict& verdict : judgeStream(course(profileOf(), kBegin, kBegin), kSpan_s, kPort))
    EXPECT_EQ(verdict.grade, Grade::kRight) << verdict.text;
}

TEST(DeviceCheck, StreamOfABadDevice) {
  const std::vector<ReceivedPose> good = course(profileOf(), kBegin, kBegin);
  const auto spoilt = [&](auto spoil) {
    std::vector<ReceivedPose> heard = good;
    for (size_t i = 0; i < heard.size(); ++i) spoil(heard[i], i);
    return judgeStream(heard, kSpan_s, kPort);
  };
  EXPECT_TRUE(says(judgeStream({}, kSpan_s, kPort), Grade::kWrong, "no pose arrived"));
  EXPECT_TRUE(says(judgeStream(good, 8 * kSpan_s, kPort), Grade::kWrong, "rate: 13 poses a second, too low"));
  EXPECT_TRUE(says(judgeStream(good, 2 * kSpan_s, kPort), Grade::kNote, "rate: 50 poses a second, low"));
  using Heard = ReceivedPose;
  EXPECT_TRUE(says(spoilt([](Heard& it, size_t i) { it.came_s += i > 50 ? 0.1 : 0; }), Grade::kNote, "jitter"));
  EXPECT_TRUE(says(spoilt([](Heard& it, size_t i) { it.came_s += i > 50 ? 0.3 : 0; }), Grade::kWrong, "gaps"));
  EXPECT_TRUE(says(spoilt([](Heard& it, size_t) { it.stamp_s = 0; }), Grade::kWrong, "stamps: 0"));
  EXPECT_TRUE(says(spoilt([](Heard& it, size_t) { it.stamp_s = 5; }), Grade::kWrong, "always the same"));
  EXPECT_TRUE(says(spoilt([](Heard& it, size_t) { *it.stamp_s -= 2; }), Grade::kNote, "stale, 2.00 s"));
  EXPECT_TRUE(says(spoilt([](Heard& it, size_t) { it.stamp_s.reset(); }), Grade::kNote, "have none"));
  EXPECT_TRUE(says(spoilt([](Heard& it, size_t) { it.frame = ""; }), Grade::kNote, "poses name no frame"));
  PosePort named;
  named.frame = "Geomagic_base";
  EXPECT_TRUE(says(judgeStream(good, kSpan_s, named), Grade::kRight, "'Geomagic_base', as the profile says"));
  EXPECT_TRUE(says(spoilt([](Heard& it, size_t i) { it.frame = i % 2 ? "a" : "b"; }), Grade::kWrong, "'a' 'b'"));
  EXPECT_TRUE(says(spoilt([](Heard& it, size_t) { it.pose.orientation.coeffs() *= 2; }), Grade::kWrong, "quaternions"));
  EXPECT_TRUE(says(spoilt([](Heard& it, size_t) { it.pose.position_m.x() = std::numeric_limits<double>::quiet_NaN(); }),
                   Grade::kWrong, "not finite"));
  EXPECT_TRUE(says(spoilt([](Heard& it, size_t i) { it.pose.position_m.x() += 0.02 * static_cast<double>(i % 2); }),
                   Grade::kNote, "still: it moved"));
}

TEST(DeviceCheck, NoProfileHelpsADeviceWithoutAGoodPose) {
  const auto spoilt = [&](auto spoil, size_t from) {
    std::vector<ReceivedPose> heard = course(profileOf(), kBegin, kBegin);
    for (size_t i = from; i < heard.size(); ++i) spoil(heard[i]);
    return isBeyond(judgeStream(heard, kSpan_s, kPort));
  };
  const auto zero = [](ReceivedPose& it) { it.stamp_s = 0; };
  const auto same = [](ReceivedPose& it) { it.stamp_s = 5; };
  const auto odd = [](ReceivedPose& it) { it.pose.orientation.coeffs() *= 2; };
  const auto bad = [](ReceivedPose& it) { it.pose.position_m.x() = std::numeric_limits<double>::quiet_NaN(); };
  EXPECT_TRUE(spoilt(zero, 0) && spoilt(same, 0) && spoilt(odd, 0) && spoilt(bad, 0));
  EXPECT_FALSE(spoilt(zero, 50) || spoilt(same, 50) || spoilt(odd, 50) || spoilt(bad, 50)) << "some are used";
}

TEST(DeviceCheck, ShaftOfAnUprightHandleIsFound) {
  const Pose upright{{0, 0, 0}, kNoTurn};
  EXPECT_FALSE(findTip(upright, profileOf(), kNoTurn).orientation);
  for (const Vector3d& shaft : {Vector3d(1, 0, 0), Vector3d(0, -1, 0), Vector3d(0, 0, -1), Vector3d(0, 1, 0)}) {
    // an upright handle with another axis of its frame along its shaft
    const Quaterniond held = rotationBetween(shaft, Vector3d::UnitZ());
    const FoundTip found = findTip({{0, 0, 0}, held}, profileOf(), kNoTurn);
    EXPECT_EQ(found.verdict.grade, Grade::kWrong);
    ASSERT_TRUE(found.orientation);
    EXPECT_NEAR((held * *found.orientation * Vector3d::UnitZ()).z(), 1, 1e-12);
  }
  const FoundTip askew =
      findTip({{0, 0, 0}, Quaterniond(Eigen::AngleAxisd(0.8, Vector3d::UnitX()))}, profileOf(), kNoTurn);
  EXPECT_FALSE(askew.orientation);
  EXPECT_NE(askew.verdict.text.find("was it upright?"), std::string::npos);
}

std::vector<ReceivedButton> presses(const ButtonPort& port, std::initializer_list<int> values) {
  std::vector<ReceivedButton> out;
  for (int value : values) out.push_back({port, value});
  return out;
}

TEST(DeviceCheck, ButtonIsSeenWhereverItIs) {
  const ButtonPort first{ButtonType::kJoy, "left/button1", 0}, pedal{ButtonType::kJoy, "pedals", 3};
  EXPECT_EQ(judgeButton(presses(first, {1, 0}), first, "button1").text, "button1: seen on left/button1, number 0");
  EXPECT_EQ(judgeButton(presses(pedal, {0, 1, 1, 0}), first, "button1").text,
            "button1: not seen on left/button1, number 0, but on pedals, number 3");
  EXPECT_NE(judgeButton({}, first, "button1").text.find("no message arrived"), std::string::npos);
  EXPECT_FALSE(pressedButton(presses(pedal, {1, 1}), first));
  EXPECT_FALSE(pressedButton(presses(pedal, {0, 0}), first));
  EXPECT_EQ(pressedButton(presses(pedal, {2}), first)->index, 3);  // a click in CRTK
  std::vector<ReceivedButton> both = presses(pedal, {1, 0, 1, 0});
  for (const ReceivedButton& event : presses({ButtonType::kJoy, "other", 1}, {1, 0})) both.push_back(event);
  EXPECT_EQ(pressedButton(both, first)->topic, "other");  // pressed once, as prompted
  EXPECT_EQ(pressedButton(both, pedal)->topic, "pedals");
}

TEST(DeviceCheck, ForceIsToOpposeTheWayIn) {
  std::vector<ReceivedPose> heard;
  std::vector<ReceivedForce> out, in, none;
  for (int i = 0; i < 100; ++i) {
    ReceivedPose pose;
    pose.came_s = 0.01 * i;
    pose.pose.position_m = Vector3d(0, 0, 50 - 0.5 * i);  // mm, downwards
    heard.push_back(pose);
    const double n = std::max(0.0, 0.02 * (i - 40));
    out.push_back({0.01 * i, {0, 0, n}});
    in.push_back({0.01 * i, {0, 0, -n}});
    none.push_back({0.01 * i, {0, 0, 0}});
  }
  EXPECT_EQ(judgeForce(out, heard).grade, Grade::kRight);
  for (int i = 100; i < 130; ++i) {  // retracts faster than forces fade
    ReceivedPose pose;
    pose.came_s = 0.01 * i;
    pose.pose.position_m = Vector3d(0, 0, 10 * (i - 99));
    heard.push_back(pose);
    out.push_back({0.01 * i, {0, 0, std::max(0.0, 1 - 0.05 * (i - 99))}});
  }
  EXPECT_EQ(judgeForce(out, heard).grade, Grade::kRight);
  EXPECT_EQ(judgeForce(in, heard).grade, Grade::kWrong);
  EXPECT_EQ(judgeForce(none, heard).grade, Grade::kNote);
  EXPECT_EQ(judgeForce({}, heard).grade, Grade::kNote);
}

TEST(DeviceCheck, AProfileThatIsNoneIsNotWritten) {
  EXPECT_THROW(correctedProfile("about: a\n", {"pose.unit_m=-1"}, {}), DeviceError);
}

}  // namespace
}  // namespace viscera
