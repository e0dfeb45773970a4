// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "math/number_text.h"
#include "math/out_file.h"
#include "model/scene/tool_kinds.h"
#include "tasks/tool_log.h"

namespace viscera {

namespace {

// Columns as in Gao et al. 2014: left and right master, left and right slave, 19 numbers each.
constexpr double kJigsawsRate_hz = 30;
constexpr double kOpenJaw_rad = 1;  ///< for a tool without jaws with button 1 released; pressed: 0
constexpr size_t kArms = 2;

/// Returns the stylus that is the left or right arm: by name, else in order. SIZE_MAX: none.
size_t stylusOfArm(const std::vector<std::string>& styluses, size_t arm) {
  const char* const names[kArms] = {"left", "right"};
  const auto named = [&](const char* name) {
    return static_cast<size_t>(std::find(styluses.begin(), styluses.end(), name) - styluses.begin());
  };
  if (named(names[arm]) < styluses.size()) return named(names[arm]);
  const bool others_named = named(names[1 - arm]) < styluses.size();
  return !others_named && arm < styluses.size() ? arm : SIZE_MAX;
}

struct ArmPose {
  bool known = false;
  Pose pose;
  double jaw_rad = 0;
};

/// Writes position, rotation matrix row by row, velocity, angular velocity, gripper.
void writeArm(std::string& file, const ArmPose& now, const ArmPose& before, double span_s) {
  double out[19] = {};
  if (now.known) {
    const Eigen::Matrix3d turn = now.pose.orientation.toRotationMatrix();
    for (int i = 0; i < 3; ++i) out[i] = now.pose.position_m[i];
    for (int i = 0; i < 9; ++i) out[3 + i] = turn(i / 3, i % 3);
    if (before.known && span_s > 0) {
      const Vector3d speed = (now.pose.position_m - before.pose.position_m) / span_s;
      const Eigen::AngleAxisd rotation(now.pose.orientation * before.pose.orientation.conjugate());
      const double angle = rotation.angle() > M_PI ? rotation.angle() - 2 * M_PI : rotation.angle();
      for (int i = 0; i < 3; ++i) out[12 + i] = speed[i];
      for (int i = 0; i < 3; ++i) out[15 + i] = rotation.axis()[i] * angle / span_s;
    }
    out[18] = now.jaw_rad;
  }
  constexpr size_t kColumn = 14;
  for (const double value : out) {
    const std::string text = fixedText(value, 6);
    file.append(kColumn - std::min(kColumn, text.size()), ' ') += text;
  }
}

}  // namespace

void ToolRows::writeJigsaws(const std::string& path) const {
  std::string file;
  size_t before = SIZE_MAX;
  for (size_t frame = 0;; ++frame) {
    const size_t at = static_cast<size_t>(std::llround(static_cast<double>(frame) / kJigsawsRate_hz / tick_s));
    if (at >= rows.size()) break;
    const double span_s = before == SIZE_MAX ? 0 : static_cast<double>(at - before) * tick_s;
    for (const bool slave : {false, true}) {
      for (size_t arm = 0; arm < kArms; ++arm) {
        const size_t s = stylusOfArm(styluses, arm);
        const auto poseAt = [&](size_t row) {
          if (s == SIZE_MAX || row == SIZE_MAX) return ArmPose{};
          const StylusSample& sample = rows[row].samples[s];
          const StylusMotion& motion = rows[row].motions[s];
          const double by_button_rad = sample.button1 ? 0 : kOpenJaw_rad;
          const double angle_rad = sample.jaw_rad == kNoJaw ? by_button_rad : double{sample.jaw_rad};
          if (!slave) return ArmPose{sample.valid, sample.pose, angle_rad};
          return ArmPose{motion.present, motion.to, kindOf(motion.mode).jaws ? motion.opens_to_rad : by_button_rad};
        };
        writeArm(file, poseAt(at), poseAt(before), span_s);
      }
    }
    file += '\n';
    before = at;
  }
  writeFile(path, FileKind::kText, file);
}

}  // namespace viscera
