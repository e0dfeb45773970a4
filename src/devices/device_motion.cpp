// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "devices/device_check.h"
#include "devices/millimetres.h"
#include "math/decompositions.h"

namespace viscera {
namespace {

using Grade = Verdict::Grade;

constexpr double kDegPerRad = 180 / 3.14159265358979323846;
/// Cosine of 41 degrees: users move no straighter than that without a ruler, and axes are 90 degrees apart.
constexpr double kAlong = 0.75;
constexpr double kTrembles = 8;  ///< least ratio of a requested motion to the tremor
constexpr double kShare = 0.15;  ///< share of the motion at its beginning and its end that counts as rest
constexpr double kLeastTurn_rad = 0.25;
constexpr double kUnitFactor = 3.2;  ///< 10 cm by eye are 3 to 32 cm; units differ by a larger factor
constexpr double kMirror = 0.5;      ///< least advantage of a reflection, in sums of cosines
constexpr double kUnsaid = 1e-9;     ///< negligible length, in device units

struct Unit {
  double unit_m;
  const char* name;
};
constexpr Unit kUnits[] = {{1, "metres"}, {0.001, "millimetres"}, {0.01, "centimetres"}, {0.0254, "inches"}};

bool isTurn(Asked asked) {
  return asked == Asked::kTurnLeft || asked == Asked::kTiltRight || asked == Asked::kTiltAway;
}

const char* nameOf(Asked asked) {
  switch (asked) {
    case Asked::kRight:
      return "right";
    case Asked::kUp:
      return "up";
    case Asked::kTowards:
      return "towards you";
    case Asked::kTurnLeft:
      return "turn to the left";
    case Asked::kTiltRight:
      return "tilt to the right";
    case Asked::kTiltAway:
      break;
  }
  return "tilt away from you";
}

/// Describes the direction of a displacement.
std::string directionText(const Vector3d& displacement) {
  const char* const words[3][2] = {{"left", "right"}, {"towards you", "away from you"}, {"down", "up"}};
  Eigen::Index axis;
  displacement.cwiseAbs().maxCoeff(&axis);
  return words[axis][displacement[axis] > 0];
}

/// Describes the rotation about an axis.
std::string turnText(const Vector3d& axis) {
  const char* const words[3][2] = {{"tilts away from you", "tilts towards you"},
                                   {"tilts to the left", "tilts to the right"},
                                   {"turns to the right", "turns to the left"}};
  Eigen::Index main;
  axis.cwiseAbs().maxCoeff(&main);
  return words[main][axis[main] > 0];
}

std::string degrees(double cosine) {
  return rounded(kDegPerRad * std::acos(std::clamp(cosine, -1.0, 1.0)), 0) + " degrees";
}

Eigen::Matrix3d turnAxesOf(const DeviceProfile& profile) {
  const std::string& axes = profile.pose.turn_axes.empty() ? profile.pose.axes : profile.pose.turn_axes;
  return axesOf(axes, "pose.turn_axes");
}

std::string axesText(const Eigen::Matrix3d& axes) {
  std::string out;
  for (int row = 0; row < 3; ++row) {
    Eigen::Index column;
    axes.row(row).cwiseAbs().maxCoeff(&column);
    out += (row ? " " : "") + std::string(axes(row, column) < 0 ? "-" : "") + static_cast<char>('x' + column);
  }
  return out;
}

struct Pair {
  Vector3d heard, wanted;  ///< unit vectors: measured by the device, and desired
};

struct Fit {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double sum = -10, least = -1;  ///< sum and smallest of the cosines
};

Fit fitOf(const Eigen::Matrix3d& axes, const std::vector<Pair>& pairs) {
  Fit out{axes, 0, 1};
  for (const Pair& pair : pairs) {
    const double cosine = (axes * pair.heard).dot(pair.wanted);
    out.sum += cosine;
    out.least = std::min(out.least, cosine);
  }
  return out;
}

/// Returns the best of the 24 rotations, or of the 24 reflections, that map axes to axes.
Fit bestFit(const std::vector<Pair>& pairs, bool mirrored) {
  Fit best;
  int order[3] = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
      for (int row = 0; row < 3; ++row) axes(row, order[row]) = (signs >> row & 1) ? -1 : 1;
      if ((axes.determinant() < 0) != mirrored) continue;
      const Fit fit = fitOf(axes, pairs);
      if (fit.sum > best.sum) best = fit;
    }
  } while (std::next_permutation(order, order + 3));
  return best;
}

/// Returns the axes that fit these motions. @param now  axes of the profile, which stay if they fit
std::optional<std::string> axesFor(const std::vector<Pair>& pairs, const Eigen::Matrix3d& now, const char* what,
                                   std::vector<Verdict>& verdicts) {
  if (pairs.size() < 2) return std::nullopt;
  if (fitOf(now, pairs).least >= kAlong) return axesText(now);
  const Fit best = bestFit(pairs, false), mirror = bestFit(pairs, true);
  if (pairs.size() == 3 && mirror.sum > best.sum + kMirror) {
    verdicts.push_back(
        {Grade::kWrong,
         std::string(what) +
             ": a mirror image. One of the three motions had the wrong direction; repeat them. If the result "
             "stays, the device's axes are left-handed, or its orientations are inverted: only its "
             "driver can correct that",
         true});
    return std::nullopt;
  }
  if (best.least < kAlong) {
    verdicts.push_back(
        {Grade::kWrong, std::string(what) + ": no axes of the device are parallel to yours (the best match is off by " +
                            degrees(best.least) +
                            "), so its base is rotated. register_stylus finds `base` (docs/devices.md)"});
    return std::nullopt;
  }
  return axesText(best.axes);
}

}  // namespace

Vector3d directionOf(Asked asked) {
  switch (asked) {
    case Asked::kRight:
      return Vector3d::UnitX();
    case Asked::kUp:
    case Asked::kTurnLeft:
      return Vector3d::UnitZ();
    case Asked::kTowards:
      return -Vector3d::UnitY();
    case Asked::kTiltRight:
      return Vector3d::UnitY();
    case Asked::kTiltAway:
      break;
  }
  return -Vector3d::UnitX();
}

std::optional<DeviceMotion>& DeviceMotions::of(Asked asked) {
  switch (asked) {
    case Asked::kRight:
      return right;
    case Asked::kUp:
      return up;
    case Asked::kTowards:
      return towards;
    case Asked::kTurnLeft:
      return turn_left;
    case Asked::kTiltRight:
      return tilt_right;
    case Asked::kTiltAway:
      break;
  }
  return tilt_away;
}

std::optional<DeviceMotion> motionOf(const std::vector<ReceivedPose>& heard) {
  std::vector<Pose> good;
  for (const ReceivedPose& it : heard) {
    const double norm = it.pose.orientation.norm();
    if (!it.pose.position_m.allFinite() || !(std::abs(norm - 1) < 0.1)) continue;
    good.push_back(it.pose);
    good.back().orientation.normalize();
  }
  if (good.size() < kFewestPoses) return std::nullopt;
  const size_t count = std::max<size_t>(1, static_cast<size_t>(kShare * static_cast<double>(good.size())));
  Vector3d begin = Vector3d::Zero(), end = Vector3d::Zero();
  for (size_t i = 0; i < count; ++i) {
    begin += good[i].position_m / static_cast<double>(count);
    end += good[good.size() - 1 - i].position_m / static_cast<double>(count);
  }
  Quaterniond turned = good.back().orientation * good.front().orientation.conjugate();
  if (turned.w() < 0) turned.coeffs() *= -1;
  const Eigen::AngleAxisd turn(turned);
  return DeviceMotion{end - begin, turn.angle() * turn.axis(), {end, good.back().orientation}};
}

std::optional<std::string> unclear(Asked asked, const DeviceMotion& motion, double tremble) {
  if (isTurn(asked) && motion.turn.norm() < kLeastTurn_rad)
    return "it turned by " + rounded(kDegPerRad * motion.turn.norm(), 0) +
           " degrees only; about 45 are needed. If you turned it that far, the device sends no orientations";
  if (!isTurn(asked) && motion.displacement.norm() < std::max(kUnsaid, kTrembles * tremble))
    return std::string("its position did not change, or not more than its noise");
  return std::nullopt;
}

Verdict judgeMotion(Asked asked, const DeviceMotion& motion, const DeviceProfile& profile, const Quaterniond& base) {
  const bool turn = isTurn(asked);
  const Vector3d moved = turn ? Vector3d(base * (turnAxesOf(profile) * motion.turn))
                              : Vector3d(base * (axesOf(profile.pose.axes, "pose.axes") * motion.displacement));
  const double cosine = moved.normalized().dot(directionOf(asked));
  const std::string name = nameOf(asked);
  const std::string does = turn ? turnText(moved) : "goes " + directionText(moved);
  if (cosine >= kAlong) {
    const double size = profile.pose.unit_m * moved.norm();
    return {Grade::kRight, name + ": right, by " +
                               (turn ? rounded(kDegPerRad * moved.norm(), 0) + " degrees" : millimetres(size) + " mm")};
  }
  if (cosine <= -kAlong) return {Grade::kWrong, name + ": mirrored, the tool " + does};
  if ((moved.normalized().cwiseAbs()).maxCoeff() >= kAlong)
    return {Grade::kWrong, name + ": axes are swapped, the tool " + does};
  return {Grade::kWrong, name + ": oblique, the tool moves " + degrees(cosine) + " off"};
}

FoundMap findMap(const DeviceMotions& motions, const DeviceProfile& profile, const Quaterniond& base) {
  FoundMap out;
  std::vector<Pair> offsets, turns;
  std::vector<double> lengths;
  const auto take = [&](const std::optional<DeviceMotion>& motion, Asked asked) {
    if (!motion) return;
    const Vector3d wanted = base.conjugate() * directionOf(asked);
    (isTurn(asked) ? turns : offsets)
        .push_back({(isTurn(asked) ? motion->turn : motion->displacement).normalized(), wanted});
    if (!isTurn(asked)) lengths.push_back(motion->displacement.norm());
  };
  take(motions.right, Asked::kRight);
  take(motions.up, Asked::kUp);
  take(motions.towards, Asked::kTowards);
  take(motions.turn_left, Asked::kTurnLeft);
  take(motions.tilt_right, Asked::kTiltRight);
  take(motions.tilt_away, Asked::kTiltAway);
  out.axes = axesFor(offsets, axesOf(profile.pose.axes, "pose.axes"), "places", out.verdicts);
  out.turn_axes = axesFor(turns, turnAxesOf(profile), "orientations", out.verdicts);
  if (lengths.empty()) return out;
  std::nth_element(lengths.begin(), lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2), lengths.end());
  const double length = lengths[lengths.size() / 2];
  const auto off = [&](double unit_m) { return std::abs(std::log(length * unit_m / kAskedMotion_m)); };
  if (off(profile.pose.unit_m) < std::log(kUnitFactor)) {
    out.unit_m = profile.pose.unit_m;
    return out;
  }
  const Unit& unit = *std::min_element(std::begin(kUnits), std::end(kUnits),
                                       [&](const Unit& a, const Unit& b) { return off(a.unit_m) < off(b.unit_m); });
  const std::string said = "unit: when the device moves 10 cm, the tool moves " +
                           rounded(100 * length * profile.pose.unit_m, length * profile.pose.unit_m < 1 ? 2 : 0) +
                           " cm";
  if (off(unit.unit_m) < std::log(kUnitFactor)) {
    out.unit_m = unit.unit_m;
    out.verdicts.push_back({Grade::kWrong, said + ": the device sends " + unit.name});
  } else {
    out.verdicts.push_back({Grade::kWrong, said + ", which fits none of metres, centimetres, millimetres, inches"});
  }
  return out;
}

FoundTip findTip(const Pose& upright, const DeviceProfile& profile, const Quaterniond& base) {
  const Quaterniond device = base * Quaterniond(turnAxesOf(profile)) * upright.orientation;
  const Vector3d shaft = device * profile.tip.orientation * Vector3d::UnitZ();
  if (shaft.z() >= kAlong) return {{Grade::kRight, "shaft of an upright handle: points up, right"}, std::nullopt};
  const Vector3d up = device.conjugate() * Vector3d::UnitZ();  // in the handle's frame
  Eigen::Index axis;
  const double along = up.cwiseAbs().maxCoeff(&axis);
  const std::string said = "shaft of an upright handle: the tool's points " + directionText(shaft);
  if (along < kAlong)
    return {{Grade::kWrong, said + ", and no axis of the handle's frame is parallel to it; was it upright?"},
            std::nullopt};
  const Vector3d to = (up[axis] < 0 ? -1 : 1) * Vector3d::Unit(axis);
  const bool over = to.z() < -0.5;  // half a turn about x, as in profiles of the dVRK
  return {{Grade::kWrong, said}, over ? Quaterniond(0, 1, 0, 0) : rotationBetween(Vector3d::UnitZ(), to)};
}

}  // namespace viscera
