// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "viscera/math/types.h"

namespace viscera::gpu {

/// What the GPU works on, as far as it is timed.
enum class Stage {
  kCells,
  kStep,
  kCut,
  kMeasure,
  kReaction,
  kUpload,   ///< of a state on the host
  kSurface,  ///< of following the tissue what is in neither of the next two
  kNormals,  ///< of nodes
  kMapping,  ///< of vertices
  kRender,   ///< of drawing what is in none of the next ones
  kTissue,   ///< drawn; where it is lit in a pass of its own, without that
  kLight,    ///< pixels of one surface lit
  kEdges,    ///< pixels of several found and lit
  kTools,    ///< and obstacles
  kOverlays,
  kResolve,   ///< pixels made of those that were drawn
  kReadback,  ///< of surfaces and pictures
};
constexpr size_t kStages = 17;
const char* stageName(Stage stage);

/// Time that the GPU spends on each stage, from time stamps in its command stream: nothing waits for them. While a
/// clock lives, every TimedStage of its thread is timed by it; without one they cost a comparison.
class StageClock {
 public:
  /// @param marks  time stamps that may be under way; when all are, stages go untimed until some have come back
  /// @throws GpuError  another clock lives on this thread
  explicit StageClock(int marks = 8192);
  /// A clock that waits for the GPU at both ends of every stage, and takes the time on the host: for renderers that
  /// draw tile by tile, all stages of one picture side by side. @throws GpuError  as above
  static std::unique_ptr<StageClock> waiting();
  ~StageClock();
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

  struct Time {
    double seconds = 0;
    uint64_t count = 0;  ///< times that the stage was entered
  };
  /// What has come back since the clock began. @param wait  for all that is under way
  const std::array<Time, kStages>& collect(bool wait = false);
  uint64_t untimed() const { return untimed_; }  ///< stages left out, as too many time stamps were under way

 private:
  friend class TimedStage;
  static constexpr int kNothing = -1;
  struct Mark {
    uint32_t query = 0;
    int stage = kNothing;  ///< that the time from this mark to the next one belongs to
  };
  bool enter(Stage stage);
  void leave();
  void mark(int stage);
  void waitAndCount(int next);
  bool readOldest(bool wait);

  std::vector<Mark> marks_;  ///< ring
  size_t oldest_ = 0, under_way_ = 0;
  bool waits_ = false;
  SteadyTime last_{};  ///< where it waits
  uint64_t last_ns_ = 0;
  int last_stage_ = kNothing;  ///< of the mark read last
  std::vector<int> stack_;     ///< stages entered and not left
  std::array<Time, kStages> times_{};
  uint64_t untimed_ = 0;
};

/// The stage that the GPU commands given while this lives belong to. Of stages within stages the inner one counts.
class TimedStage {
 public:
  explicit TimedStage(Stage stage);
  ~TimedStage();
  TimedStage(const TimedStage&) = delete;
  TimedStage& operator=(const TimedStage&) = delete;

 private:
  StageClock* clock_;  ///< null: not timed
};

}  // namespace viscera::gpu
