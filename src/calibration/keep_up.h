// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace viscera {

struct Scene;

/// Does a session keep up whose lattices were made as fine as this machine was found to step (`spacing_m: auto`)? If
/// not, as other load has come since: which spacing would. Any thread.
class KeepUp {
 public:
  static constexpr int kReadings = 5;    ///< in a row before anything is said
  static constexpr double kSlow = 0.9;   ///< real-time factor below which a person notices
  static constexpr double kLeast = 1.1;  ///< times as coarse: less is not worth a session that begins again

  /// A session begins. @param asked  its scene, with `auto` or from coarser()   @param chosen  the same with numbers
  void begin(const Scene& asked, const Scene& chosen);
  /// A reading, once a second while ticks are made. What was said is said again after a reset.
  /// @param tick  since the start or the last reset   @returns what is to be said now, or nothing
  std::string note(double real_time_factor, uint64_t tick);
  /// The scene with lattices that would keep up: the time of a second goes with the fourth power of what is finer.
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
