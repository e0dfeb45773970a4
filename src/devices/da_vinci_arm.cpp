// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/da_vinci_arm.h"

#include <algorithm>
#include <cmath>

#include "math/number_text.h"

namespace viscera {
namespace {

constexpr double kRad = 3.14159265358979323846 / 180;
constexpr double kTurn = 2 * 3.14159265358979323846;
// Lengths [m]: the remote centre is behind the end of the shaft by insertion + shaft - rcc.
constexpr double kPsmRcc = 0.4318, kPsmShaft = 0.4162, kEcmRcc = 0.3822, kEcmShaft = 0.385495;
constexpr double kPitchToYaw = 0.0091, kYawToTip = 0.0102;
// The end of the PSM's shaft is 1 mm or more beyond the remote centre: closer, yaw and pitch turn about that end, and
// behind the centre two sets of joints have the same pose.
constexpr double kPsmLeastInsertion = 0.0166;
static_assert(kPsmLeastInsertion > kPsmRcc - kPsmShaft);
constexpr double kLimitRounding = 1e-9;  // rad or m: of joints that were computed from a pose
constexpr double kLeastSine = 1e-6;      // of the angle between the wrist's yaw axis and the line to the remote centre

using Eigen::Matrix3d;

Matrix3d aboutX(double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix();
}
Matrix3d aboutZ(double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
}
const double kQuarter = kTurn / 4;

/// Rotation from the tip's frame to that of the wrist's yaw joint.
Matrix3d tipInYaw() {
  Matrix3d out;
  out << 0, -1, 0, 0, 0, 1, -1, 0, 0;
  return out;
}

/// Returns the whole turns to add to an angle so that it is closest to another.
double turnsTo(double angle, double near) {
  return kTurn * std::round((near - angle) / kTurn);
}

}  // namespace

DaVinciArm::DaVinciArm(ArmJoints joints)
    : has_wrist_(joints == ArmJoints::kPsm), to_wrist_m_(has_wrist_ ? kPsmShaft - kPsmRcc : kEcmShaft - kEcmRcc) {
  names_ = {"yaw", "pitch", "insertion", "roll"};
  if (has_wrist_) {
    names_.insert(names_.end(), {"wrist_pitch", "wrist_yaw"});
    limits_ = {{-91.96 * kRad, 91.96 * kRad}, {-53 * kRad, 53 * kRad}, {kPsmLeastInsertion, 0.24},
               {-260 * kRad, 260 * kRad},     {-80 * kRad, 80 * kRad}, {-80 * kRad, 80 * kRad}};
  } else {
    limits_ = {{-91.96 * kRad, 91.96 * kRad}, {-45 * kRad, 66.4 * kRad}, {0, 0.254}, {-89 * kRad, 89 * kRad}};
  }
}

/// Returns the orientation of the insertion joint: its z points along the shaft, away from the remote centre.
Matrix3d DaVinciArm::insertionFrame(double yaw, double pitch) const {
  return aboutX(kQuarter) * aboutZ(yaw + kQuarter) * aboutX(-kQuarter) * aboutZ(pitch - kQuarter) * aboutX(kQuarter);
}

Pose DaVinciArm::tip(const Joints& q) const {
  Matrix3d turn = insertionFrame(q[0], q[1]);
  Vector3d place = turn * Vector3d(0, 0, q[2] + to_wrist_m_);
  turn *= aboutZ(q[3]);
  if (!has_wrist_) return {place, Quaterniond(turn)};
  turn *= aboutX(-kQuarter) * aboutZ(q[4] - kQuarter);
  place += turn * Vector3d(kPitchToYaw, 0, 0);
  turn *= aboutX(-kQuarter) * aboutZ(q[5] - kQuarter) * tipInYaw();
  return {place + turn * Vector3d(0, 0, kYawToTip), Quaterniond(turn)};
}

std::optional<DaVinciArm::Joints> DaVinciArm::reach(const Pose& tip, const Joints& near) const {
  const Matrix3d tip_turn = tip.orientation.toRotationMatrix();
  const Matrix3d yaw_turn = tip_turn * tipInYaw().transpose();
  Vector3d end = tip.position_m, outward = tip_turn.col(2);
  const Vector3d yaw_axis = yaw_turn.col(2);
  if (has_wrist_) {
    end -= kYawToTip * tip_turn.col(2);
    // The shaft is in the plane of the remote centre and the wrist's yaw axis, and the pitched link is across that
    // axis.
    outward = end - yaw_axis * yaw_axis.dot(end);
    if (outward.norm() <= kLeastSine * end.norm()) return std::nullopt;
    outward.normalize();
    end -= kPitchToYaw * outward;
  }
  const double depth = end.norm();
  if (!(depth > 0) || !std::isfinite(depth)) return std::nullopt;
  const Vector3d shaft = end / depth;
  Joints q(count());
  q[0] = std::atan2(shaft.x(), -shaft.z());
  q[1] = std::asin(std::clamp(-shaft.y(), -1.0, 1.0));
  q[2] = depth - to_wrist_m_;
  const Matrix3d insertion = insertionFrame(q[0], q[1]);
  const Vector3d across = insertion.transpose() * (has_wrist_ ? outward.cross(yaw_axis) : tip_turn.col(1));
  q[3] = std::atan2(-across.x(), across.y());
  q[3] += turnsTo(q[3], near[3]);
  if (has_wrist_) {
    const Matrix3d roll = insertion * aboutZ(q[3]);
    const Vector3d pitched = roll.transpose() * outward;
    q[4] = std::atan2(pitched.x(), pitched.z());
    const Matrix3d pitch = roll * aboutX(-kQuarter) * aboutZ(q[4] - kQuarter);
    const Vector3d yawed = pitch.transpose() * yaw_turn.col(0);
    q[5] = std::atan2(yawed.x(), yawed.z());
  }
  if (!isWithin(q)) return std::nullopt;
  return q;
}

bool DaVinciArm::isWithin(const Joints& joints) const {
  if (joints.size() != count()) return false;
  for (size_t i = 0; i < count(); ++i)
    if (!(joints[i] >= limits_[i].min - kLimitRounding && joints[i] <= limits_[i].max + kLimitRounding)) return false;
  return true;
}

std::string DaVinciArm::limitsText() const {
  std::string out;
  for (size_t i = 0; i < count(); ++i) {
    const bool is_length = i == kInsertion;
    const double unit = is_length ? 1 : kRad;
    out += (i ? ", " : "") + names_[i] + " " + numberText(limits_[i].min / unit) + " .. " +
           numberText(limits_[i].max / unit) + (is_length ? " m" : " deg");
  }
  return out;
}

DaVinciArm::Joints between(const DaVinciArm::Joints& from, const DaVinciArm::Joints& to, double share) {
  DaVinciArm::Joints out(from.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = from[i] + share * (to[i] - from[i]);
  return out;
}

}  // namespace viscera
