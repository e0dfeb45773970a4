// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace viscera {

struct Scene;

/// Watches whether a session with `spacing_m: auto` keeps up with the clock. If it does not, as other load has come
/// since, reports which spacing would. Any thread may call it.
class AdaptiveResolution {
 public:
  static constexpr int kReadings = 5;    ///< in a row before anything is reported
  static constexpr double kSlow = 0.9;   ///< real-time factor below which a user notices
  static constexpr double kLeast = 1.1;  ///< least coarsening that is worth restarting a session

  /// Begins a session. @param asked  its scene, with `auto` or from coarser()   @param chosen  the same with numbers
  void begin(const Scene& asked, const Scene& chosen);
  /// Takes a reading, once a second while ticks are made. Repeats a report after a reset.
  /// @param tick  since the start or the last reset   @returns a message to report now, or nothing
  std::string record(double real_time_factor, uint64_t tick);
  /// Returns the scene with lattices that would keep up: computing time goes with the fourth power of the inverse
  /// spacing.
  /// @param asked  of begin()
  /// @throws Error  no body has `spacing_m: auto`, the session keeps up, or its walls allow no coarser lattice
  Scene coarser(const Scene& asked) const;

 private:
  bool isSlow() const;
  double wanted_m() const;

  mutable std::mutex mutex_;
  std::vector<size_t> bodies_;  ///< with spacing_m: auto
  double spacing_m_ = 0, wanted_factor_ = 1;
  std::vector<double> factors_;  ///< the last kReadings
  bool said_ = false;
  uint64_t tick_ = 0;
};

}  // namespace viscera
