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

/// Timed stages of the GPU's work.
enum class Stage {
  kCells,
  kStep,
  kCut,
  kMeasure,
  kReaction,
  kUpload,   ///< of a state on the host
  kSurface,  ///< of updating surface meshes, without the next two
  kNormals,  ///< of nodes
  kMapping,  ///< of vertices
  kRender,   ///< of drawing, without the next ones
  kTissue,   ///< drawing; without lighting where that has a pass of its own
  kLight,    ///< lighting of pixels with one surface
  kEdges,    ///< finding and lighting pixels with several
  kTools,    ///< and obstacles
  kOverlays,
  kResolve,   ///< image pixels from drawn ones
  kReadback,  ///< of surfaces and images
};
constexpr size_t kStages = 17;
const char* stageName(Stage stage);

/// Time that the GPU spends on each stage, from time stamps in its command stream, without waiting. While a clock
/// lives, it times every TimedStage of its thread. Without one a TimedStage costs a comparison.
class StageClock {
 public:
  /// @param marks  most time stamps in flight; with all in use, stages are not timed
  /// @throws GpuError  another clock lives on this thread
  explicit StageClock(int marks = 8192);
  /// Returns a clock that waits for the GPU at both ends of every stage, and takes the time on the host: for renderers
  /// that draw tile by tile, all stages of one image in parallel. @throws GpuError  as above
  static std::unique_ptr<StageClock> waiting();
  ~StageClock();
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

  struct Time {
    double seconds = 0;
    uint64_t count = 0;  ///< times that the stage was entered
  };
  /// Returns the times measured since the clock began. @param wait  for all that is in flight
  const std::array<Time, kStages>& collect(bool wait = false);
  uint64_t untimed() const { return untimed_; }  ///< stages not timed, as too many time stamps were in flight

 private:
  friend class TimedStage;
  static constexpr int kNothing = -1;
  struct Mark {
    uint32_t query = 0;
    int stage = kNothing;  ///< stage of the time from this mark to the next one
  };
  bool enter(Stage stage);
  void leave();
  void mark(int stage);
  void waitAndCount(int next);
  bool readOldest(bool wait);

  std::vector<Mark> marks_;  ///< ring
  size_t oldest_ = 0, in_flight_ = 0;
  bool waits_ = false;
  SteadyTime last_{};  ///< with waiting()
  uint64_t last_ns_ = 0;
  int last_stage_ = kNothing;  ///< of the mark read last
  std::vector<int> stack_;     ///< stages entered and not left
  std::array<Time, kStages> times_{};
  uint64_t untimed_ = 0;
};

/// Assigns the GPU commands given in its lifetime to a stage. Of nested stages the inner one counts.
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
