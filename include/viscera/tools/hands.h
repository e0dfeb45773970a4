// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "viscera/tools/stylus.h"

namespace viscera {

/// Turns stylus samples into motions, tick by tick: modes from buttons, jumps that are no motion (first sample).
class Tools {
 public:
  /// @param max_travel_m  how far a tip may move in a tick: what tissue could follow, the speed of its waves times the
  ///                      tick. A tip that is faster, or jumps, follows its pose at that speed (physics.md 5).
  explicit Tools(const std::vector<StylusConfig>& styluses,
                 double max_travel_m = std::numeric_limits<double>::infinity());
  ToolMotions advance(const StylusSamples& samples);
  void reset();
  const std::vector<StylusConfig>& configs() const { return configs_; }

 private:
  void holdBack(StylusMotion& motion) const;

  std::vector<StylusConfig> configs_;
  double max_travel_m_;
  std::array<StylusSample, layout::kMaxStyluses> last_{};
  std::array<ToolMode, layout::kMaxStyluses> mode_{};
};

}  // namespace viscera
