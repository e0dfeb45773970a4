// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_event.h"

#include <zlib.h>

#include <algorithm>
#include <type_traits>

#include "model/scene/tool_kinds.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

/// Reads or writes a flag, whatever byte a file has there.
void persistFlag(Archive& archive, bool& flag) {
  uint8_t byte = flag ? 1 : 0;
  archive.value(byte);
  flag = byte != 0;
}

/// Reads or writes a sample as its bytes in memory, so that no field is forgotten; times are of another clock.
void persistSample(Archive& archive, StylusSample& sample) {
  static_assert(std::is_trivially_destructible_v<StylusSample>);
  bool flags[] = {sample.valid, sample.button1, sample.button2};
  for (bool& flag : flags) persistFlag(archive, flag);
  sample.received = {};
  archive.value(sample);
  sample.received = {};
  sample.valid = flags[0];
  sample.button1 = flags[1];
  sample.button2 = flags[2];
}

bool isPose(const Pose& pose) {
  return pose.position_m.allFinite() && pose.orientation.coeffs().allFinite() && pose.orientation.norm() > 0;
}

}  // namespace

void SessionEvent::persist(Archive& archive, size_t styluses) {
  archive.value(kind);
  switch (kind) {
    case Kind::kStep:
      for (size_t s = 0; s < std::min(styluses, samples.size()); ++s) persistSample(archive, samples[s]);
      return;
    case Kind::kMeasured:
      archive.value(tick);
      return archive.value(measured);
    case Kind::kToolMode:
      archive.value(index);
      archive.value(when);
      return archive.value(mode);
    case Kind::kForceLimits:
      archive.value(index);
      return archive.value(limits);
    case Kind::kObstacleFrame:
    case Kind::kCameraFrame:
      archive.value(index);
      return archive.value(pose);
    case Kind::kOverlays:
      archive.value(index);
      return archive.value(overlays);
    case Kind::kTask:
      archive.list(task);
      return archive.list(task_yaml);
    case Kind::kTie:
      archive.value(index);
      return archive.value(tie);
    default:  // a reset, for example, has no data; unknown kinds are rejected
      return;
  }
}

void SessionEvent::require(const Scene& scene) const {
  bool sound = kind <= Kind::kTie && isPose(pose);
  for (const StylusSample& sample : samples) {
    const bool jaw = sample.jaw_rad == kNoJaw || (sample.jaw_rad >= 0 && sample.jaw_rad <= kWidestJaw_rad);
    sound = sound && jaw && (!sample.valid || isPose(sample.pose));
  }
  if (kind == Kind::kToolMode || kind == Kind::kForceLimits) sound = sound && index < scene.styluses.size();
  if (kind == Kind::kObstacleFrame) sound = sound && index < scene.obstacles.size();
  if (kind == Kind::kTie)
    sound = sound && tie.knot > KnotKind::kNone && static_cast<size_t>(tie.knot) < kKnotNames.size() &&
            tie.tension_n > 0 && tie.holds_n >= 0 && !scene.sutures.empty() && tie.to >= TieTo::kOtherTail &&
            tie.to <= TieTo::kStrand && tie.strand_m.allFinite();
  if (kind == Kind::kToolMode) {
    const auto known = [this](const ToolKind& tool) { return tool.mode == mode; };
    sound = sound && when <= ToolSwitch::kButton2 && when >= ToolSwitch::kIdle &&
            std::any_of(std::begin(kToolKinds), std::end(kToolKinds), known);
  }
  if (!sound) throw Error("an event that is impossible in its scene");
}

void SessionEvent::apply(Session& session) const {
  const std::vector<CameraConfig>& cameras = session.scene().cameras;
  switch (kind) {
    case Kind::kReset:
      return session.reset();
    case Kind::kClearInput:
      return session.resetInput();
    case Kind::kToolMode:
      return session.setToolMode(index, when, mode);
    case Kind::kForceLimits:
      return session.setForceLimits(index, limits);
    case Kind::kObstacleFrame:
      return session.setObstacleFrame(index, pose);
    case Kind::kCameraFrame:
      if (index < cameras.size() && !cameras[index].frame.empty()) session.setCameraFrame(index, pose);
      return;
    case Kind::kOverlays:
      if (index < cameras.size()) session.setOverlays(index, overlays);
      return;
    case Kind::kTask:
      return session.recordTask(task, task_yaml);
    case Kind::kTie:
      return session.tieSuture(index, tie);
    default:
      return;
  }
}

uint32_t fingerprintOf(const layout::TickStats& stats) {
  const uint32_t exact[] = {stats.springs_cut, stats.nonfinite,  stats.max_stretch_bits, stats.max_speed_bits,
                            stats.grabbed[0],  stats.grabbed[1], stats.touched[0],       stats.touched[1]};
  return static_cast<uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(exact), sizeof exact));
}

}  // namespace viscera
