// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "nodes/stylus_mailbox.h"
#include "nodes/wrench_schedule.h"
#include "viscera/haptics/haptic_servo.h"
#include "viscera/model/scene/scene.h"

namespace viscera::nodes {

/// What the private parameters of the simulator say of forces between two ticks.
struct HapticOptions {
  double rate_hz = 1000;   ///< 0: forces once per tick
  double delay_s = 0.002;  ///< of a device: from a pose measured there to the force that answers it
  int priority = 20;       ///< of the thread that answers, SCHED_FIFO; 0: as every other thread
};

/// The local models of all styluses (docs/haptics.md): ticks renew them, and the newest poses ask them at a rate of
/// their own. Knows neither topics nor threads: WrenchPublisher's thread calls it.
class HapticLoop {
 public:
  /// What a stylus felt since the start, for the diagnostics.
  struct Felt {
    double energy_j = 0, least_j = 0;  ///< given by the hand, as the passivity observer has it
    double share = 1;                  ///< of the stiffness that fast motion feels
    uint64_t answers = 0;              ///< periods
  };

  HapticLoop(const HapticOptions& options, const Scene& scene, const std::vector<const StylusMailbox*>& mailboxes);

  bool on() const { return options_.rate_hz > 0; }
  double period_s() const { return 1 / options_.rate_hz; }
  /// A tick's answer. @param tracked  a hand is there
  void put(size_t stylus, const TickContact& contact, bool tracked, SteadyTime now);
  /// There are no ticks: all begins anew.
  void rest(SteadyTime now);
  /// What is wanted now. @param received  out: when the poses came that it answers; 0: none
  Wrenches answers(SteadyTime now, std::array<SteadyTime, layout::kMaxStyluses>& received);
  /// What limits made of it.
  void sent(const Wrenches& wrenches);

  const HapticServo& servo(size_t stylus) const { return servos_[stylus]; }
  Felt felt(size_t stylus) const;

 private:
  double seconds(SteadyTime now) const { return std::chrono::duration<double>(now - begun_).count(); }

  HapticOptions options_;
  std::vector<const StylusMailbox*> mailboxes_;
  std::vector<HapticServo> servos_;  ///< [styluses]
  std::vector<uint64_t> answers_;
  SteadyTime begun_;
};

}  // namespace viscera::nodes
