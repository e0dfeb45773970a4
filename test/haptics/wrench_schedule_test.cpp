// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/wrench_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace viscera {
namespace {

constexpr ForceLimits kWrenchScheduleLimits{5, 100, 0.2, 4};
constexpr double kWrenchScheduleTick_s = 0.01, kWrenchScheduleStall_s = 0.03;
constexpr double kWrenchScheduleRounding = 1e-9;  // of sums of steps in double, relative

Wrenches wrench(double force_n, double torque_nm = 0) {
  Wrenches out;
  out[0].force_n.x() = force_n;
  out[0].torque_nm.y() = torque_nm;
  return out;
}

/// A schedule and its clock.
class WrenchScheduleTest : public ::testing::Test {
 protected:
  WrenchSchedule schedule_{{kWrenchScheduleLimits}, kWrenchScheduleStall_s};
  SteadyTime now_ = SteadyTime(std::chrono::hours(1));

  static SteadyTime::duration span(double span_s) {
    return std::chrono::duration_cast<SteadyTime::duration>(std::chrono::duration<double>(span_s));
  }
  /// Advances the time and sends whenever something is due. @returns what was sent last
  Wrenches wait(double span_s) {
    const SteadyTime end = now_ + span(span_s);
    Wrenches last = schedule_.next(now_);
    while (schedule_.due() < end) {
      now_ = std::max(now_, schedule_.due()) + std::chrono::microseconds(1);
      last = schedule_.next(now_);
    }
    now_ = end;
    return last;
  }
  void put(const Wrenches& wanted) {
    schedule_.tick(now_);
    schedule_.request(wanted, {true}, now_);
  }
  /// Runs ticks with the same desired wrench.
  Wrenches ticks(int count, const Wrenches& wanted, double tick_s = kWrenchScheduleTick_s) {
    Wrenches last;
    for (int t = 0; t < count; ++t) {
      put(wanted);
      last = wait(tick_s);
    }
    return last;
  }
};

TEST_F(WrenchScheduleTest, SendsZeroUntilThereAreTicks) {
  EXPECT_EQ(wait(1)[0].force_n, Vector3d::Zero());
  EXPECT_FALSE(schedule_.stalled());
}

TEST_F(WrenchScheduleTest, ForceIsReachedBySmallSteps) {
  put(wrench(0.5));
  double before_n = schedule_.next(now_)[0].force_n.x();
  int steps = 1;
  while (before_n < 0.5) {
    now_ += span(WrenchSchedule::kSlewPeriod_s);
    const double force_n = schedule_.next(now_)[0].force_n.x();
    EXPECT_LE(force_n - before_n,
              kWrenchScheduleLimits.force_rate_n_per_s * WrenchSchedule::kSlewPeriod_s * (1 + kWrenchScheduleRounding));
    before_n = force_n;
    ++steps;
  }
  EXPECT_GE(steps, 2);
}

TEST_F(WrenchScheduleTest, StallPutsZeroOutCountsAndSlewsBackWhenTicksComeInTime) {
  EXPECT_EQ(ticks(20, wrench(1))[0].force_n.x(), 1);
  EXPECT_EQ(wait(0.05 - kWrenchScheduleTick_s)[0].force_n, Vector3d::Zero());
  EXPECT_TRUE(schedule_.stalled());
  EXPECT_EQ(schedule_.stalls(), 1u);
  EXPECT_EQ(wait(3)[0].force_n, Vector3d::Zero());
  EXPECT_EQ(ticks(1, wrench(1))[0].force_n, Vector3d::Zero());
  EXPECT_EQ(ticks(20, wrench(1))[0].force_n.x(), 1);
  EXPECT_EQ(schedule_.stalls(), 1u);
}

TEST_F(WrenchScheduleTest, SimulationThatIsAlwaysLateGivesNoForce) {
  EXPECT_EQ(ticks(50, wrench(1), 2 * kWrenchScheduleStall_s)[0].force_n, Vector3d::Zero());
}

TEST_F(WrenchScheduleTest, RestIsNoStall) {
  ticks(20, wrench(1));
  schedule_.rest(now_);
  EXPECT_EQ(wait(1)[0].force_n, Vector3d::Zero());
  EXPECT_EQ(schedule_.stalls(), 0u);
  EXPECT_EQ(ticks(20, wrench(1))[0].force_n.x(), 1);
}

TEST_F(WrenchScheduleTest, ReleaseEndsForcesForEverWithinItsTime) {
  ticks(50, wrench(5, 0.2));
  schedule_.release(now_);
  EXPECT_FALSE(schedule_.released());
  EXPECT_EQ(wait(WrenchSchedule::kRelease_s + 2 * WrenchSchedule::kSlewPeriod_s)[0].force_n, Vector3d::Zero());
  EXPECT_TRUE(schedule_.released());
  EXPECT_EQ(ticks(20, wrench(5))[0].force_n, Vector3d::Zero());
}

TEST_F(WrenchScheduleTest, SuspensionEndsForcesWithinTheTimeOfAnEndUntilItIsOver) {
  ticks(50, wrench(5, 0.2));
  schedule_.suspend(now_);
  EXPECT_FALSE(schedule_.silenced());
  EXPECT_EQ(wait(WrenchSchedule::kRelease_s + 2 * WrenchSchedule::kSlewPeriod_s)[0].force_n, Vector3d::Zero());
  EXPECT_TRUE(schedule_.silenced());
  EXPECT_FALSE(schedule_.released());
  EXPECT_EQ(ticks(20, wrench(5))[0].force_n, Vector3d::Zero()) << "of ticks meanwhile";
  schedule_.rest(now_);
  EXPECT_EQ(ticks(20, wrench(5))[0].force_n, Vector3d::Zero()) << "of ticks after a pause meanwhile";
  schedule_.resume(now_);
  EXPECT_GT(ticks(50, wrench(5))[0].force_n.x(), 0);
  schedule_.release(now_);
  schedule_.resume(now_);
  EXPECT_EQ(ticks(50, wrench(5))[0].force_n, Vector3d::Zero()) << "an end is for ever";
}

TEST_F(WrenchScheduleTest, PureTwistIsLimitedToo) {
  double before_nm = 0;
  for (int t = 0; t < 200; ++t) {
    put(wrench(0, 3));
    const SteadyTime before = now_;
    now_ += span(kWrenchScheduleTick_s);
    const double torque_nm = schedule_.next(now_)[0].torque_nm.norm();
    const double span_s = std::chrono::duration<double>(now_ - before).count();
    EXPECT_LE(torque_nm, kWrenchScheduleLimits.torque_nm * (1 + kWrenchScheduleRounding));
    EXPECT_LE(torque_nm - before_nm,
              kWrenchScheduleLimits.torque_rate_nm_per_s * span_s * (1 + kWrenchScheduleRounding));
    before_nm = torque_nm;
  }
  EXPECT_NEAR(before_nm, kWrenchScheduleLimits.torque_nm, kWrenchScheduleRounding);
}

/// What sustains a wrench, and what must end it, for all slew rates and limits.
struct Ending {
  const char* name;
  std::function<void(WrenchSchedule&, SteadyTime)> begin;
  double within_s;
};

TEST(WrenchScheduleEndings, NothingKeepsAWrenchUpWhateverSlewAndLimitsAre) {
  const Wrenches pushed = wrench(1.5, 0.1);
  const std::vector<Ending> endings = {
      {"rest", [](WrenchSchedule& it, SteadyTime now) { it.rest(now); }, WrenchSchedule::kLetGo_s},
      {"release", [](WrenchSchedule& it, SteadyTime now) { it.release(now); }, WrenchSchedule::kRelease_s},
      {"suspension", [](WrenchSchedule& it, SteadyTime now) { it.suspend(now); }, WrenchSchedule::kRelease_s},
      {"stall", [](WrenchSchedule&, SteadyTime) {}, kWrenchScheduleStall_s + WrenchSchedule::kRelease_s},
      {"hand lost", [&](WrenchSchedule& it, SteadyTime now) { it.request(pushed, {false}, now); },
       WrenchSchedule::kLetGo_s},
      {"rest, then release",
       [](WrenchSchedule& it, SteadyTime now) {
         it.rest(now);
         it.release(now);
       },
       WrenchSchedule::kRelease_s}};
  const std::vector<ForceLimits> all = {{5, 0, 0.2, 0}, {5, 0.1, 0.2, 0.1}, {0, 0, 0, 0},  {0, 0.1, 0, 0.1},
                                        {0, 100, 0, 4}, {5, 100, 0, 0},     {5, 0, 0.2, 4}};
  const auto span = [](double span_s) {
    return std::chrono::duration_cast<SteadyTime::duration>(std::chrono::duration<double>(span_s));
  };
  for (const Ending& ending : endings) {
    for (const ForceLimits& limits : all) {
      SCOPED_TRACE(std::string(ending.name) + ", " + std::to_string(limits.force_n) + " N, " +
                   std::to_string(limits.force_rate_n_per_s) + " N/s, " + std::to_string(limits.torque_nm) + " N m");
      WrenchSchedule schedule({kWrenchScheduleLimits}, kWrenchScheduleStall_s);
      SteadyTime now(std::chrono::hours(1));
      for (int t = 0; t < 100; ++t, now += span(WrenchSchedule::kSlewPeriod_s)) {
        schedule.tick(now);
        schedule.request(pushed, {true}, now);
        schedule.next(now);
      }
      schedule.setLimits(0, limits);
      const SteadyTime begun = now;
      ending.begin(schedule, now);
      Reaction out = schedule.next(now)[0];
      const SteadyTime end = begun + span(ending.within_s + 2 * WrenchSchedule::kSlewPeriod_s);
      for (const bool stylus_lost = schedule.live() && ending.within_s == WrenchSchedule::kLetGo_s; now < end;) {
        const double before_n = out.force_n.norm();
        now = std::max(now + std::chrono::microseconds(1), std::min(schedule.due(), end));
        if (stylus_lost) schedule.tick(now);  // ticks continue
        out = schedule.next(now)[0];
        EXPECT_LE(out.force_n.norm(), before_n * (1 + kWrenchScheduleRounding));
      }
      EXPECT_EQ(out.force_n, Vector3d::Zero());
      EXPECT_EQ(out.torque_nm, Vector3d::Zero());
      EXPECT_EQ(schedule.released(), std::string(ending.name).find("release") != std::string::npos);
    }
  }
}

TEST(WrenchScheduleEndings, ALimitOfNoTorqueLeavesTheForceAsItIs) {
  WrenchSchedule schedule({{5, 1000, 0, 4}}, kWrenchScheduleStall_s);
  SteadyTime now(std::chrono::hours(1));
  Reaction out;
  for (int t = 0; t < 100; ++t, now += std::chrono::milliseconds(2)) {
    schedule.tick(now);
    schedule.request(wrench(1.5, 0.1), {true}, now);
    out = schedule.next(now)[0];
  }
  EXPECT_EQ(out.force_n.x(), 1.5);
  EXPECT_EQ(out.torque_nm, Vector3d::Zero());
}

/// A million ticks of a random simulation: any wrench, pauses, late ticks and stalls. The output keeps the limits in
/// wall-clock time; in a stall it may fade out faster.
TEST_F(WrenchScheduleTest, NoLimitIsExceededInAMillionRandomTicks) {
  std::mt19937_64 random(12);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Reaction before = schedule_.next(now_)[0];
  SteadyTime sent = now_;
  const auto check = [&] {
    const Reaction out = schedule_.next(now_)[0];
    const double span_s = std::chrono::duration<double>(now_ - sent).count();
    ASSERT_LE(out.force_n.norm(), kWrenchScheduleLimits.force_n * (1 + kWrenchScheduleRounding));
    ASSERT_LE(out.torque_nm.norm(), kWrenchScheduleLimits.torque_nm * (1 + kWrenchScheduleRounding));
    if (!schedule_.stalled()) {
      ASSERT_LE(
          (out.force_n - before.force_n).norm(),
          kWrenchScheduleLimits.force_rate_n_per_s * span_s * (1 + kWrenchScheduleRounding) + kWrenchScheduleRounding);
      ASSERT_LE((out.torque_nm - before.torque_nm).norm(),
                kWrenchScheduleLimits.torque_rate_nm_per_s * span_s * (1 + kWrenchScheduleRounding) +
                    kWrenchScheduleRounding);
    } else {
      ASSERT_LE(out.force_n.norm(), before.force_n.norm() * (1 + kWrenchScheduleRounding));
      ASSERT_LE(out.torque_nm.norm(), before.torque_nm.norm() * (1 + kWrenchScheduleRounding));
    }
    before = out;
    sent = now_;
  };
  uint64_t live = 0;
  for (int t = 0; t < 1000000 && !HasFatalFailure(); ++t) {
    const double what = uniform(0, 1);
    Wrenches wanted;
    wanted[0].force_n = std::pow(10, uniform(-3, 3)) * Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    wanted[0].torque_nm = std::pow(10, uniform(-4, 2)) * Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    if (what < 0.001) wanted[0].force_n.x() = std::nan("");
    if (what > 0.999) {
      schedule_.rest(now_);
    } else {
      put(wanted);
    }
    if (what < 0.001) {
      before = {};  // non-finite tissue: zero at once, checked here and not against the limits
      ASSERT_EQ(schedule_.next(now_)[0].force_n, Vector3d::Zero());
      sent = now_;
    }
    const SteadyTime end = now_ + span(what > 0.99 ? uniform(0, 0.2) : uniform(0.005, 0.015));
    check();
    while (schedule_.due() < end && !HasFatalFailure()) {
      now_ = std::max(now_, schedule_.due()) + std::chrono::microseconds(static_cast<int>(uniform(1, 2000)));
      check();
    }
    now_ = std::max(now_, end);
    live += before.force_n.norm() > 0;
  }
  EXPECT_GT(schedule_.stalls(), 100u);
  EXPECT_GT(live, 100000u);  // forces were sent
}

}  // namespace
}  // namespace viscera
