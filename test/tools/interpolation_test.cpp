// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "tools/motion_packing.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/tools/stylus.h"

namespace viscera {
namespace {

constexpr int kSubsteps = 8;
constexpr double kInterpolationRoundingM = 1e-7;  ///< positions of about 1 m, as floats
constexpr double kRoundingRad = 1e-6;

/// Returns motions in which the first stylus probes, moves, and turns by a right angle about x. The second one does
/// nothing.
ToolMotions movingAndTurning() {
  ToolMotions motions;
  motions[0].mode = ToolMode::kProbe;
  motions[0].from.position_m = Vector3d(0.1, 0.2, 0.3);
  motions[0].to = {Vector3d(0.9, 0.2, -0.1), rotationFromDegrees({90, 0, 0})};
  return motions;
}

std::vector<layout::ToolMotion> substepsOf(const ToolMotions& motions, const std::vector<StylusConfig>& configs) {
  std::vector<layout::ToolMotion> out;
  interpolateMotions(motions, configs, kSubsteps, out);
  return out;
}

const layout::ToolMotion& at(const std::vector<layout::ToolMotion>& all, int substep, size_t stylus = 0) {
  return all.at(static_cast<size_t>(substep) * layout::kMaxStyluses + stylus);
}
Vector3d xyz(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}
Quaterniond turn(const layout::vec4& v) {
  return {v.w, v.x, v.y, v.z};
}

TEST(Interpolation, EverySubstepBeginsWhereTheOneBeforeEnded) {
  const auto all = substepsOf(movingAndTurning(), {StylusConfig{}});
  for (int s = 0; s + 1 < kSubsteps; ++s) {
    EXPECT_EQ(xyz(at(all, s).to), xyz(at(all, s + 1).from));
    EXPECT_EQ(xyz(at(all, s).blade_to), xyz(at(all, s + 1).blade_from));
  }
}

TEST(Interpolation, SubstepsSpanTheTickAtConstantSpeed) {
  const ToolMotions motions = movingAndTurning();
  const auto all = substepsOf(motions, {StylusConfig{}});
  const Vector3d begin = motions[0].from.position_m, end = motions[0].to.position_m;
  EXPECT_LT((xyz(at(all, 0).from) - begin).norm(), kInterpolationRoundingM);
  EXPECT_LT((xyz(at(all, kSubsteps - 1).to) - end).norm(), kInterpolationRoundingM);
  for (int s = 0; s < kSubsteps; ++s) {
    EXPECT_LT((xyz(at(all, s).to) - xyz(at(all, s).from) - (end - begin) / kSubsteps).norm(), kInterpolationRoundingM);
  }
}

TEST(Interpolation, OrientationTurnsAtConstantSpeed) {
  const auto all = substepsOf(movingAndTurning(), {StylusConfig{}});
  for (int s = 0; s < kSubsteps; ++s) {
    const Quaterniond expected = rotationFromDegrees({90.0 * (s + 1) / kSubsteps, 0, 0});
    EXPECT_LT(turn(at(all, s).orientation).angularDistance(expected), kRoundingRad);
  }
}

TEST(Interpolation, OrientationTakesTheShortWayWhateverTheSignOfItsQuaternion) {
  ToolMotions motions = movingAndTurning();
  motions[0].to.orientation.coeffs() *= -1;
  const auto all = substepsOf(motions, {StylusConfig{}});
  const Quaterniond half = rotationFromDegrees({45, 0, 0});
  EXPECT_LT(turn(at(all, kSubsteps / 2 - 1).orientation).angularDistance(half), kRoundingRad);
}

TEST(Interpolation, BladeLiesBackAlongTheShaftAheadOrOnBothSides) {
  struct Lies {
    BladeSide side;
    double low_m, high_m;
  };
  for (const Lies& lies :
       {Lies{BladeSide::kShaft, 0, 0.05}, {BladeSide::kAhead, -0.05, 0}, {BladeSide::kBoth, -0.05, 0.05}}) {
    StylusConfig config;
    config.cut.blade_length_m = 0.05;
    config.cut.blade_side = lies.side;
    for (const ToolMode mode : {ToolMode::kCut, ToolMode::kCutParticles}) {
      ToolMotions motions = movingAndTurning();
      motions[0].mode = mode;
      const auto all = substepsOf(motions, {config});
      const layout::ToolMotion &first = at(all, 0), &last = at(all, kSubsteps - 1);
      EXPECT_LT((xyz(first.from) - Vector3d(0.1, 0.2, 0.3 + lies.high_m)).norm(), kInterpolationRoundingM);
      EXPECT_LT((xyz(first.blade_from) - Vector3d(0.1, 0.2, 0.3 + lies.low_m)).norm(), kInterpolationRoundingM);
      // Turned by 90 degrees about x, z points along -y.
      EXPECT_LT((xyz(last.to) - Vector3d(0.9, 0.2 - lies.high_m, -0.1)).norm(), kInterpolationRoundingM);
      EXPECT_LT((xyz(last.blade_to) - Vector3d(0.9, 0.2 - lies.low_m, -0.1)).norm(), kInterpolationRoundingM);
    }
    const auto probing = substepsOf(movingAndTurning(), {config});
    EXPECT_LT((xyz(at(probing, 0).from) - Vector3d(0.1, 0.2, 0.3)).norm(), kInterpolationRoundingM)
        << "what does not cut acts at the tip";
  }
}

TEST(Interpolation, AnEraserReachesAroundItsBlade) {
  StylusConfig config;
  config.cut_particles.eraser_radius_m = 0.003;
  ToolMotions motions = movingAndTurning();
  motions[0].mode = ToolMode::kCutParticles;
  const auto all = substepsOf(motions, {config});
  EXPECT_FLOAT_EQ(at(all, 0).blade_from.w, 0.003f);
}

TEST(Interpolation, EachModeBringsItsOwnRadius) {
  StylusConfig config;
  config.probe.radius_m = 0.011;
  config.grab.radius_m = 0.022;
  config.grab.release_speed_m_per_s = 0.33;
  ToolMotions motions = movingAndTurning();
  const auto probing = substepsOf(motions, {config});
  EXPECT_EQ(at(probing, 0).info.x, layout::kModeProbe);
  EXPECT_FLOAT_EQ(at(probing, 0).from.w, 0.011f);
  motions[0].mode = ToolMode::kGrab;
  const auto grabbing = substepsOf(motions, {config});
  EXPECT_EQ(at(grabbing, 0).info.x, layout::kModeGrab);
  EXPECT_FLOAT_EQ(at(grabbing, 0).from.w, 0.022f);
  EXPECT_FLOAT_EQ(at(grabbing, 0).to.w, 0.33f);
}

TEST(Interpolation, StylusThatDoesNothingHasModeNoneInEverySubstep) {
  ToolMotions motions = movingAndTurning();
  StylusConfig first, second;
  second.name = "second";
  for (int s = 0; s < kSubsteps; ++s) {
    EXPECT_EQ(at(substepsOf(motions, {first, second}), s, 1).info.x, layout::kModeNone);
  }
  std::swap(motions[0], motions[1]);
  const auto all = substepsOf(motions, {first, second});
  for (int s = 0; s < kSubsteps; ++s) {
    EXPECT_EQ(at(all, s, 0).info.x, layout::kModeNone);
    EXPECT_EQ(at(all, s, 1).info.x, layout::kModeProbe);
  }
}

}  // namespace
}  // namespace viscera
