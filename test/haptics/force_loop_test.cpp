// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/force_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace viscera {
namespace {

constexpr double kForceLoopTick_s = 1.0 / 60, kStall_s = 3 * kForceLoopTick_s;
constexpr ForceLimits kLimits{5, 100, 0.2, 4};
constexpr double kForceLoopStiff_n_per_m = 500;

/// A device over a wall of springs at z = 0, a simulation with ticks, and a thread that sleeps until something is due.
class Rig {
 public:
  explicit Rig(double rate_hz = 1000, const ForceLimits& limits = kLimits)
      : loop_({stylus(rate_hz, limits)}, true, kStall_s) {
    inputs_[0].tracked = inputs_[0].accepts_force = true;
  }

  double time_s() const { return std::chrono::duration<double>(now_ - kBegin).count(); }
  bool ticks = true;
  double z_m = 0.01, speed_m_per_s = 0;  ///< height and velocity of the tip
  ForceLoop::Inputs& inputs() { return inputs_; }
  const ForceLoop& loop() const { return loop_; }
  struct Sent {
    double time_s, force_n;
  };
  std::vector<Sent> sent;
  double given_j = 0;  ///< true energy given by the user [J]

  /// Advances the time.
  void run(double span_s) {
    const SteadyTime end = now_ + span(span_s);
    while (now_ < end) {
      SteadyTime next = std::min(end, std::max(now_ + std::chrono::microseconds(2), loop_.due()));
      if (ticks) next = std::min(next, std::max(tick_due_, now_));
      next = std::min(next, pose_due_);
      advance(next);
      bool wake = now_ >= loop_.due();
      if (now_ >= pose_due_) {
        pose_due_ += std::chrono::milliseconds(1);
        inputs_[0].tip_m.z() = z_m;
        inputs_[0].pose_time = now_;
      }
      if (ticks && now_ >= tick_due_) {
        tick();
        wake = wake || !loop_.updating();
      }
      if (wake) send();
    }
  }

 private:
  static constexpr SteadyTime kBegin{std::chrono::hours(1)};
  static ForceLoop::Stylus stylus(double rate_hz, const ForceLimits& limits) {
    ForceLoop::Stylus out{limits, {}};
    out.servo.period_s = 1 / rate_hz;
    out.servo.tissue = {1e5, 1e5, 0.25, 0.008};
    return out;
  }
  static SteadyTime::duration span(double span_s) {
    return std::chrono::duration_cast<SteadyTime::duration>(std::chrono::duration<double>(span_s));
  }
  void advance(SteadyTime to) {
    const double offset_m = speed_m_per_s * std::chrono::duration<double>(to - now_).count();
    z_m += offset_m;
    if (!sent.empty()) given_j -= sent.back().force_n * offset_m;
    now_ = to;
  }
  void tick() {
    tick_due_ = now_ + span(kForceLoopTick_s);
    ForceLoop::Ticks all;
    TickContact& contact = all[0].contact;
    contact.from_m = {0, 0, last_z_m_};
    contact.to_m = {0, 0, last_z_m_ = z_m};
    const double push_n = -0.5 * kForceLoopStiff_n_per_m * (contact.from_m.z() + contact.to_m.z());
    if (push_n > 0) {
      contact.kind = TickContact::Kind::kPushes;
      contact.reaction.force_n = {0, 0, push_n};
    }
    all[0].tracked = inputs_[0].tracked;
    all[0].reaction = contact.reaction;
    loop_.put(all, inputs_, now_);
  }
  void send() {
    const double force_n = loop_.next(inputs_, now_)[0].force_n.z();
    loop_.sent({Vector3d(0, 0, inputs_[0].accepts_force ? force_n : 0)}, now_);
    sent.push_back({time_s(), inputs_[0].accepts_force ? force_n : 0});
  }

  ForceLoop loop_;
  ForceLoop::Inputs inputs_;
  SteadyTime now_ = kBegin, tick_due_ = kBegin, pose_due_ = kBegin;
  double last_z_m_ = 0.01;
};

/// Returns the longest time between two messages after a moment.
double longestGap_s(const Rig& rig, double from_s) {
  double gap_s = 0, last_s = from_s;
  for (const Rig::Sent& each : rig.sent) {
    if (each.time_s < from_s) continue;
    gap_s = std::max(gap_s, each.time_s - last_s);
    last_s = each.time_s;
  }
  return std::max(gap_s, rig.time_s() - last_s);
}

TEST(ForceLoop, AnswersAtItsRateAlsoAfterALimitHasActed) {
  for (const double rate_hz : {100.0, 200.0, 400.0, 499.0, 1000.0, 5000.0}) {
    Rig rig(rate_hz, {5, 2, 0.2, 4});  // a slew rate that limits every force for long
    rig.speed_m_per_s = -0.05;
    rig.run(0.3);
    rig.speed_m_per_s = 0;
    rig.run(3);  // about 2.5 N at 2 N/s
    const double from_s = rig.time_s();
    const uint64_t before = rig.loop().stats(0).updates;
    rig.run(1);
    EXPECT_NEAR(static_cast<double>(rig.loop().stats(0).updates - before), rate_hz, 0.02 * rate_hz);
    EXPECT_LT(longestGap_s(rig, from_s), 1.5 / rate_hz) << rate_hz << " Hz";
  }
}

/// 150 ms without ticks, in which the device moves away by 3 cm: the energy is that of the forces that acted.
TEST(ForceLoop, AStallLeavesNoEnergyBehind) {
  Rig rig;
  const auto poke = [&rig] {
    rig.speed_m_per_s = -0.05;
    rig.run(0.3);
    rig.speed_m_per_s = 0;
    rig.run(0.4);
  };
  poke();  // 5 mm deep
  const double felt_n = rig.sent.back().force_n;
  EXPECT_NEAR(felt_n, 2.5, 0.1);
  rig.ticks = false;
  rig.run(kStall_s + 2 * WrenchSchedule::kRelease_s);
  rig.speed_m_per_s = 0.2;
  rig.run(0.15);
  rig.speed_m_per_s = 0;
  EXPECT_EQ(rig.sent.back().force_n, 0);
  rig.ticks = true;
  rig.run(0.5);
  EXPECT_GT(rig.loop().stats(0).least_j, -1e-4);
  for (int again = 0; again < 3; ++again) {
    rig.speed_m_per_s = (0.01 - rig.z_m) / 0.3;
    rig.run(0.3);
    poke();
    EXPECT_NEAR(rig.sent.back().force_n, felt_n, 0.02 * felt_n);
    rig.speed_m_per_s = 0.05;
    rig.run(0.3);
  }
  EXPECT_NEAR(rig.loop().stats(0).energy_j, rig.given_j, 1e-3);
  EXPECT_GT(rig.loop().stats(0).least_j, -1e-3);
}

/// A driver that subscribes late, or again, starts at zero with the slew rate of its limits.
TEST(ForceLoop, WhoBeginsToListenFeelsNoLeap) {
  Rig rig(1000, {5, 10, 0.2, 4});
  rig.speed_m_per_s = -0.05;
  rig.run(0.3);
  rig.speed_m_per_s = 0;
  rig.run(1);
  EXPECT_NEAR(rig.sent.back().force_n, 2.5, 0.1);
  rig.inputs()[0].accepts_force = false;
  rig.run(0.5);
  rig.inputs()[0].accepts_force = true;
  const double from_s = rig.time_s();
  rig.run(0.2);
  double last_n = 0, last_s = from_s;
  for (const Rig::Sent& each : rig.sent) {
    if (each.time_s < from_s) continue;
    EXPECT_LE(each.force_n - last_n, 10 * (each.time_s - last_s) + 10 * kForceLoopTick_s) << each.time_s;
    last_n = each.force_n;
    last_s = each.time_s;
  }
  EXPECT_GT(last_n, 0.5);
}

TEST(ForceLoop, AStylusThatIsLostIsLetGoWithinATenthOfASecondWhateverTheSlew) {
  Rig rig(1000, {5, 0.1, 0.2, 4});
  rig.speed_m_per_s = -0.05;
  rig.run(0.3);
  rig.speed_m_per_s = 0;
  rig.run(5);
  EXPECT_GT(rig.sent.back().force_n, 0.3);
  rig.inputs()[0].tracked = false;
  rig.run(WrenchSchedule::kLetGo_s + 2 * kForceLoopTick_s);
  EXPECT_EQ(rig.sent.back().force_n, 0);
}

}  // namespace
}  // namespace viscera
