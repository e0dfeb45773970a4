// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptics/force_loop.h"
#include "viscera/haptics/simulated_device.h"
#include "viscera/model/scene/scene.h"
#include "viscera/session/session.h"

namespace viscera::bench {

/// Mean and range of values.
struct Probed {
  double least = 1e300, most = -1e300, sum = 0;
  int count = 0;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
    sum += value;
    ++count;
  }
  double mean() const { return count ? sum / count : 0; }
  double swing() const { return count ? 0.5 * (most - least) : 0; }
};

/// Force and depth in a time span, and the force of the ticks.
struct ProbedHold {
  Probed force, depth, ticks;
};

/// A held device, its driver, the session, and the force loop, all on one simulated clock.
class HeldTrial {
 protected:
  static constexpr double kPeriod_s = 1e-3;

  struct Setting {
    double mass_kg, delay_s, poses_hz;
    double rate_hz;  ///< rate of forces [Hz]; 0: once per tick
    double size_m;   ///< size of the tool, for the model's initial stiffness [m]
  };

  HeldTrial(const Scene& scene, const Setting& setting, const Vector3d& tip_m)
      : setting_(setting),
        scene_(scene),
        session_(scene_),
        device_(deviceOf(setting), tip_m),
        loop_({stylus()}, setting.rate_hz > 0, kStallTicks * session_.tick_s()) {}

  static SimulatedDeviceConfig deviceOf(const Setting& setting) {
    SimulatedDeviceConfig out;
    out.mass_kg = setting.mass_kg;
    out.delay_s = setting.delay_s;
    return out;
  }

  /// Updates the newest pose at the rate of the driver.
  void hear() {
    if (now_s_ + 0.5 * kPeriod_s < next_pose_s_) return;
    next_pose_s_ += 1 / setting_.poses_hz;
    const Vector3d device_m = device_.measured_m() + Vector3d(0, 0, base_m_);
    if (clutched_) offset_m_ = input_.tip_m - device_m;
    input_.tip_m = device_m + offset_m_;
    input_.pose_time = at(now_s_);
  }

  void tick() {
    if (now_s_ >= next_tick_s_ && !stalled_) {
      next_tick_s_ = now_s_ + session_.tick_s();
      StylusSamples samples;
      samples[0].valid = !reappears_;
      reappears_ = false;
      samples[0].pose = {input_.tip_m, turned_};
      const Frame frame = session_.step(samples, {});
      answer_ = {frame.contacts[0].reaction, samples[0].valid && !clutched_, frame.contacts[0]};
      answer_s_ = now_s_ + kComputing * session_.tick_s();
    }
    input_.tracked = !clutched_ && !reappears_;
    if (answer_s_ < 0 || now_s_ < answer_s_) return;
    loop_.put({answer_}, {input_}, at(now_s_));
    ticks_n_ = answer_.reaction.force_n.norm();
    ticked_ = true;
    answer_s_ = -1;
  }

  void tell() {
    if (!std::exchange(ticked_, false) && at(now_s_) < loop_.due()) return;
    sent_force_n_ = loop_.next({input_}, at(now_s_))[0].force_n;
    if (!input_.accepts_force) sent_force_n_.setZero();
    loop_.sent({sent_force_n_}, at(now_s_));
  }

  const Setting setting_;
  const Scene scene_;
  Session session_;
  SimulatedDevice device_;
  ForceLoop loop_;
  ForceLoop::Input input_;
  Vector3d sent_force_n_ = Vector3d::Zero();
  Quaterniond turned_ = Quaterniond::Identity();  ///< orientation of the stylus
  double now_s_ = 0, base_m_ = 0, ticks_n_ = 0;
  bool stalled_ = false, clutched_ = false, reappears_ = false;

 private:
  static constexpr double kHour_s = 3600, kStallTicks = 3;
  static constexpr double kComputing = 0.5;  ///< time to the result of a tick, relative to a tick

  ForceLoop::Stylus stylus() const {
    const BodyConfig& body = scene_.bodies[0];
    ForceLoop::Stylus out{ForceLimits::of(scene_.styluses[0]), {}};
    if (setting_.rate_hz > 0) out.servo.period_s = 1 / setting_.rate_hz;
    out.servo.tick_s = session_.tick_s();
    out.servo.round_trip_s = setting_.delay_s;
    out.servo.tissue = {body.material.young_modulus_pa, body.material.young_modulus_pa, body.material.poisson_ratio,
                        setting_.size_m};
    return out;
  }
  static SteadyTime at(double time_s) {
    return SteadyTime(std::chrono::nanoseconds(std::llround(1e9 * (kHour_s + time_s))));
  }

  ForceLoop::Tick answer_;
  Vector3d offset_m_ = Vector3d::Zero();
  double next_tick_s_ = 0, answer_s_ = -1, next_pose_s_ = 0;
  bool ticked_ = false;
};

}  // namespace viscera::bench
