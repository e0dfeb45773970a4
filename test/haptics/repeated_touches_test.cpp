// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Energy that a user gets back from tissue that is poked repeatedly.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "haptics/force_loop.h"
#include "viscera/haptics/simulated_device.h"

namespace viscera {
namespace {

constexpr double kTouchPeriod_s = 1e-3, kTouchTick_s = 1.0 / 60;
constexpr double kTouchLook_s = 0.5;
constexpr double kPokeSpeed_m_per_s = 0.12, kPokeWay_m = 0.009;
constexpr int kPokes = 8;
constexpr double kPokesEnd_s = 2 * kPokes * kPokeWay_m / kPokeSpeed_m_per_s;
constexpr double kFirst_n = 2.5;  ///< least peak force of a first poke into 660 N/m, by a hand of 300 N/m

struct Touched {
  double stiff_n_per_m, mass_kg, delay_s, poses_hz;
};

struct Outcome {
  double least_j = 0;  ///< least energy of the device's motors [J]
  double first_n = 0;  ///< largest force of the first poke [N]
  double held_n = 0;   ///< mean force of the last half second [N]
};

/// Runs a device held by a user at `hand_m(time_s)`, the height [m] above a wall of springs. The wall answers once per
/// tick, half a tick late.
Outcome touch(const Touched& how, const std::function<double(double)>& hand_m, double end_s) {
  SimulatedDeviceConfig config;
  config.mass_kg = how.mass_kg;
  config.delay_s = how.delay_s;
  SimulatedDevice device(config, {0, 0, hand_m(0)});
  ForceLoop::Stylus stylus{{5, 100, 0.2, 4}, {}};
  stylus.servo.tick_s = kTouchTick_s;
  stylus.servo.round_trip_s = how.delay_s;
  stylus.servo.tissue = {6e4, 6e4, 0.25, 0.008};
  ForceLoop loop({stylus}, true, 3 * kTouchTick_s);
  const auto at = [](double time_s) {
    return SteadyTime(std::chrono::hours(1)) + std::chrono::microseconds(std::llround(1e6 * time_s));
  };
  ForceLoop::Inputs inputs;
  inputs[0].tracked = inputs[0].accepts_force = true;
  Outcome out;
  ForceLoop::Ticks ticks;
  TickContact& contact = ticks[0].contact;
  ticks[0].tracked = true;
  Vector3d sent_n = Vector3d::Zero(), last = device.measured_m();
  double next_pose_s = 0, next_tick_s = 0, answer_s = 1e9;
  for (int i = 0; i * kTouchPeriod_s < end_s; ++i) {
    const double now_s = i * kTouchPeriod_s;
    if (now_s + 0.5 * kTouchPeriod_s >= next_pose_s) {
      next_pose_s += 1 / how.poses_hz;
      inputs[0].tip_m = device.measured_m();
      inputs[0].pose_time = at(now_s);
    }
    if (now_s >= next_tick_s) {
      next_tick_s += kTouchTick_s;
      answer_s = now_s + 0.5 * kTouchTick_s;
      contact = {};
      contact.from_m = last;
      contact.to_m = last = inputs[0].tip_m;
      const double push_n = -how.stiff_n_per_m * 0.5 * (contact.from_m.z() + contact.to_m.z());
      if (push_n > 0) contact.kind = TickContact::Kind::kPushes;
      contact.reaction.force_n = {0, 0, std::max(push_n, 0.0)};
      ticks[0].reaction = contact.reaction;
    }
    if (now_s >= answer_s) {
      loop.put(ticks, inputs, at(now_s));
      answer_s = 1e9;
    }
    if (at(now_s) >= loop.due()) {
      sent_n = loop.next(inputs, at(now_s))[0].force_n;
      loop.sent({sent_n}, at(now_s));
    }
    device.step(sent_n, {0, 0, hand_m(now_s)});
    out.least_j = std::min(out.least_j, device.energy_j());
    if (now_s < kPokeWay_m / kPokeSpeed_m_per_s * 2) out.first_n = std::max(out.first_n, sent_n.norm());
    if (now_s >= end_s - kTouchLook_s) out.held_n += sent_n.norm() * kTouchPeriod_s / kTouchLook_s;
  }
  return out;
}

/// Returns the height of a user that pokes kPokes times, and then stays up.
double poke_m(double time_s, double from_m) {
  const double gone = time_s / (kPokeWay_m / kPokeSpeed_m_per_s);
  return gone >= 2 * kPokes ? from_m : from_m - std::abs(std::remainder(gone, 2.0)) * kPokeWay_m;
}
Outcome pokes(const Touched& how, double from_m) {
  return touch(
      how, [=](double time_s) { return poke_m(time_s, from_m); }, kPokesEnd_s + 0.1);
}

std::string nameOf(const Touched& how) {
  return std::to_string(how.stiff_n_per_m) + " N/m, " + std::to_string(how.mass_kg) + " kg, " +
         std::to_string(1e3 * how.delay_s) + " ms, " + std::to_string(how.poses_hz) + " Hz";
}

/// Eight pokes gave back 24, 28, 58 and 153 mJ before energy was owed from touch to touch. The wanted 1 mJ is less than
/// a single poke gives back before any force knows of it (docs/haptics.md 6).
TEST(RepeatedTouches, GiveBackAQuarterOfWhatTheyDid) {
  constexpr struct {
    double poses_hz, most_j;  ///< energy that eight pokes may give back
  } kRates[] = {{1000, 8e-3}, {250, 11e-3}, {100, 19e-3}, {60, 36e-3}};
  for (const auto& [poses_hz, most_j] : kRates)
    for (const double stiff : {114.0, 348.0, 660.0, 800.0})
      for (const double mass_kg : {0.05, 0.2, 0.7, 2.0})
        for (const double delay_s : {0.0, 0.002, 0.005, 0.01})
          for (const double from_m : {0.0, 0.003}) {
            const Touched how{stiff, mass_kg, delay_s, poses_hz};
            EXPECT_GT(pokes(how, from_m).least_j, -most_j) << nameOf(how) << ", from " << from_m;
          }
}

/// The first poke owes nothing yet, so it is firm.
TEST(RepeatedTouches, TheFirstIsFirm) {
  for (const double delay_s : {0.0, 0.002, 0.005}) {
    const Touched how{660, 0.2, delay_s, 1000};
    EXPECT_GT(pokes(how, 0).first_n, kFirst_n) << nameOf(how);
  }
}

/// What is owed ends with the pokes: a slow press after them has its whole force.
TEST(RepeatedTouches, APressAfterThemHasItsWholeForce) {
  constexpr double kDepth_m = 0.004, kError = 0.02;  // relative error of static forces (docs/haptics.md 1)
  const auto press_m = [](double time_s) {
    return time_s < kPokesEnd_s + 0.2 ? poke_m(time_s, 0.002)
                                      : std::max(0.002 - 0.01 * (time_s - kPokesEnd_s - 0.2), -kDepth_m);
  };
  for (const double stiff : {348.0, 660.0, 800.0})
    for (const double poses_hz : {1000.0, 100.0})
      for (const double delay_s : {0.0, 0.002, 0.01}) {
        const Touched how{stiff, 0.2, delay_s, poses_hz};
        const double balance_n = kDepth_m / (1 / stiff + 1 / SimulatedDeviceConfig{}.hand_stiffness_n_per_m);
        EXPECT_NEAR(touch(how, press_m, kPokesEnd_s + 6).held_n, balance_n, kError * balance_n) << nameOf(how);
      }
}

}  // namespace
}  // namespace viscera
