// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/pace/haptics_trial.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "haptics/force_loop.h"
#include "viscera/session/session.h"

namespace viscera::bench {
namespace {

constexpr double kSpacing_m = 0.005, kTop_m = 0.02, kRadius_m = 0.008;
constexpr double kPeriod_s = 1e-3;
/// After the start of a tick its answer is there: half a tick of computing.
constexpr double kComputing = 0.5;
/// Where the hand wants the tip, m above the surface, at these times [s].
struct Key {
  double time_s, height_m;
};

/// When an event begins and is over, and when the hand has come back from it [s].
constexpr double kEvent_s = 1.4, kOver_s = kEvent_s + 0.15, kReturns_s = kOver_s + 0.2, kBack_s = kReturns_s + 1.5;
constexpr double kAway_m = 0.03, kBaseLeap_m = 0.015;

bool goesAway(HapticEvent event) {
  return event != HapticEvent::kNone && event != HapticEvent::kLeap;
}

/// @param settle_s  how long a hold takes
std::vector<Key> wayOf(double settle_s, HapticEvent event) {
  std::vector<Key> way = {{0, 0.012}, {0.2, 0.004}, {0.4, 0.012}, {0.6, 0.003}, {1.1, -0.004}};
  if (event != HapticEvent::kNone) way.push_back({kEvent_s, -0.004});
  if (goesAway(event)) {
    way.push_back({kOver_s, -0.004 + kAway_m});
    way.push_back({kReturns_s, -0.004 + kAway_m});
  }
  if (event != HapticEvent::kNone) way.push_back({kBack_s, -0.004});
  const double first = way.back().time_s + settle_s, second = first + 0.2 + settle_s;
  for (const Key& key :
       {Key{first, -0.004}, {first + 0.2, -0.006}, {second, -0.006}, {second + 0.2, 0.012}, {second + 0.5, 0.012}})
    way.push_back(key);
  return way;
}
/// Of wayOf(), from its end: where the holds end, and where the hand is free again.
constexpr size_t kHoldEnds[2] = {5, 3}, kOut = 2;
constexpr double kLeaves_m_per_s = 0.018 / 0.2;  ///< on the way out
constexpr double kTouches_s = 0.6;               ///< before it the tip is free
constexpr double kLeft_s = 0.05;                 ///< after the way out the tip is free again
constexpr double kLook_s = 0.4;                  ///< at the end of a hold
constexpr double kSettle_s = 1.5;                ///< a hold, and in it some times of a free device's ringing
constexpr double kRings = 6;

double heightAt(const std::vector<Key>& way, double time_s) {
  for (size_t i = 1; i < way.size(); ++i)
    if (time_s < way[i].time_s)
      return way[i - 1].height_m + (time_s - way[i - 1].time_s) / (way[i].time_s - way[i - 1].time_s) *
                                       (way[i].height_m - way[i - 1].height_m);
  return way.back().height_m;
}

/// A slab of tissue on bone.
Scene slab(double young_modulus_pa) {
  Scene scene;
  scene.name = "slab";
  scene.environment.gravity_m_per_s2.setZero();
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = Vector3d(0.05, 0.05, kTop_m);
  body.position_m = Vector3d(0, 0, kTop_m / 2);
  body.spacing_m = kSpacing_m;
  body.material.young_modulus_pa = young_modulus_pa;
  FixedConfig bone;
  bone.shape = FixedShape::kPlane;
  bone.point_m = Vector3d(0, 0, -kTop_m / 2 + 0.1 * kSpacing_m);
  bone.normal = Vector3d::UnitZ();
  body.fixed.push_back(bone);
  scene.bodies.push_back(body);
  scene.styluses.resize(1);
  scene.styluses[0].probe.radius_m = kRadius_m;
  scene.solver.backend = Backend::kCpu;
  scene.solver.threads = 1;
  return scene;
}

/// Mean and range of what is looked at.
struct Range {
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

struct Hold {
  Range force, depth, ticks;
};

Vector3d tipAt(double height_m) {
  return {0.0013, -0.0007, kTop_m + kRadius_m + height_m};
}

/// The hand, the device, what its driver tells, and the loop that answers it.
class Trial {
 public:
  explicit Trial(const HapticTrial& trial)
      : trial_(trial),
        scene_(slab(trial.young_modulus_pa)),
        session_(scene_),
        way_(wayOf(kSettle_s + kRings * ringOf(trial), trial.event)),
        device_(deviceOf(trial), tipAt(heightAt(way_, 0))),
        loop_({stylusOf(trial, scene_, session_)}, trial.rate_hz > 0, kStallTicks * session_.tick_s()) {}

  HapticOutcome run() {
    const int periods = static_cast<int>(std::lround(way_.back().time_s / kPeriod_s));
    for (int i = 0; i < periods; ++i) {
      now_s_ = i * kPeriod_s;
      befall();
      hear();
      tick();
      tell();
      device_.step(told_n_, tipAt(heightAt(way_, now_s_)));
      look();
    }
    return outcome();
  }

 private:
  static SimulatedDeviceConfig deviceOf(const HapticTrial& trial) {
    SimulatedDeviceConfig out;
    out.mass_kg = trial.mass_kg;
    out.delay_s = trial.delay_s;
    return out;
  }
  static double ringOf(const HapticTrial& trial) {
    const SimulatedDeviceConfig device = deviceOf(trial);
    return 2 * trial.mass_kg / (device.damping_n_s_per_m + device.hand_damping_n_s_per_m);
  }
  static ForceLoop::Stylus stylusOf(const HapticTrial& trial, const Scene& scene, const Session& session) {
    ForceLoop::Stylus out{ForceLimits::of(scene.styluses[0]), {}};
    if (trial.rate_hz > 0) out.servo.period_s = 1 / trial.rate_hz;
    out.servo.tick_s = session.tick_s();
    out.servo.round_trip_s = trial.delay_s;
    out.servo.tissue = {trial.young_modulus_pa, trial.young_modulus_pa, scene.bodies[0].material.poisson_ratio,
                        kRadius_m};
    return out;
  }
  static SteadyTime at(double time_s) {
    return SteadyTime(std::chrono::nanoseconds(std::llround(1e9 * (kHour_s + time_s))));
  }
  bool within(double from_s, double to_s) const { return now_s_ >= from_s && now_s_ < to_s; }

  /// What is wrong at this moment.
  void befall() {
    const HapticEvent event = trial_.event;
    stalled_ = event == HapticEvent::kStall && within(kEvent_s, kOver_s);
    hand_.listens = event != HapticEvent::kUnheard || !within(kEvent_s, kOver_s);
    clutched_ = event == HapticEvent::kClutch && (within(kEvent_s, kOver_s) || within(kReturns_s, kBack_s));
    const double base_m = event == HapticEvent::kLeap && within(kEvent_s, kReturns_s) ? kBaseLeap_m : 0;
    if (base_m != base_m_) appears_anew_ = true;
    base_m_ = base_m;
  }

  /// The newest pose, of a driver that tells so many a second.
  void hear() {
    if (now_s_ + 0.5 * kPeriod_s < next_pose_s_) return;
    next_pose_s_ += 1 / trial_.poses_hz;
    const Vector3d device_m = device_.measured_m() + Vector3d(0, 0, base_m_);
    if (clutched_) offset_m_ = hand_.tip_m - device_m;
    hand_.tip_m = device_m + offset_m_;
    hand_.told = at(now_s_);
  }

  void tick() {
    if (now_s_ >= next_tick_s_ && !stalled_) {
      next_tick_s_ = now_s_ + session_.tick_s();
      StylusSamples samples;
      samples[0].valid = !appears_anew_;
      appears_anew_ = false;
      samples[0].pose.position_m = hand_.tip_m;
      const Frame frame = session_.step(samples, {});
      answer_ = {frame.contacts[0].reaction, samples[0].valid && !clutched_, frame.contacts[0]};
      answer_s_ = now_s_ + kComputing * session_.tick_s();
    }
    hand_.tracked = !clutched_ && !appears_anew_;
    if (answer_s_ < 0 || now_s_ < answer_s_) return;
    loop_.put({answer_}, {hand_}, at(now_s_));
    ticks_n_ = answer_.reaction.force_n.norm();
    ticked_ = true;
    answer_s_ = -1;
  }

  void tell() {
    if (!std::exchange(ticked_, false) && at(now_s_) < loop_.due()) return;
    told_n_ = loop_.next({hand_}, at(now_s_))[0].force_n;
    if (!hand_.listens) told_n_.setZero();
    loop_.sent({told_n_}, at(now_s_));
  }

  double keyTime(size_t from_end) const { return way_[way_.size() - from_end].time_s; }

  void look() {
    out_.least_energy_mj = std::min(out_.least_energy_mj, 1e3 * device_.energy_j());
    const double size_n = told_n_.norm();
    if (now_s_ < kTouches_s || now_s_ > keyTime(kOut) + kLeft_s) out_.free_n = std::max(out_.free_n, size_n);
    for (int h = 0; h < 2; ++h) {
      const double end_s = keyTime(kHoldEnds[h]);
      if (!within(end_s - kLook_s, end_s)) continue;
      holds_[h].force.add(size_n);
      holds_[h].depth.add(kTop_m + kRadius_m - device_.position_m().z());
      holds_[h].ticks.add(ticks_n_);
    }
  }

  HapticOutcome outcome() {
    out_.depth_mm = 1e3 * holds_[1].depth.mean();
    out_.force_n = holds_[1].force.mean();
    out_.simulator_n = holds_[1].ticks.mean();
    if (out_.simulator_n > 0) out_.static_error = std::abs(out_.force_n - out_.simulator_n) / out_.simulator_n;
    out_.stiffness_n_per_m =
        (holds_[1].force.mean() - holds_[0].force.mean()) / (holds_[1].depth.mean() - holds_[0].depth.mean());
    for (const Hold& hold : holds_) {
      out_.swing_n = std::max(out_.swing_n, hold.force.swing());
      out_.swing_mm = std::max(out_.swing_mm, 1e3 * hold.depth.swing());
    }
    const double late_s = trial_.delay_s + 0.5 * kPeriod_s + 1 / trial_.poses_hz;
    const double leaves =
        std::max(holds_[1].force.mean() * kLeaves_m_per_s,
                 goesAway(trial_.event) ? holds_[0].force.mean() * kAway_m / (kOver_s - kEvent_s) : 0);
    out_.unheard_mj = 1e3 * late_s * leaves;
    const ForceLoop::Felt felt = loop_.felt(0);
    out_.observed_mj = 1e3 * felt.least_j;
    out_.share = felt.share;
    return out_;
  }

  static constexpr double kHour_s = 3600, kStallTicks = 3;

  const HapticTrial trial_;
  const Scene scene_;
  Session session_;
  const std::vector<Key> way_;
  SimulatedDevice device_;
  ForceLoop loop_;
  ForceLoop::Hand hand_;
  ForceLoop::Tick answer_;
  Vector3d offset_m_ = Vector3d::Zero(), told_n_ = Vector3d::Zero();
  double now_s_ = 0, next_tick_s_ = 0, answer_s_ = -1, next_pose_s_ = 0, base_m_ = 0, ticks_n_ = 0;
  bool stalled_ = false, clutched_ = false, appears_anew_ = false, ticked_ = false;
  HapticOutcome out_;
  Hold holds_[2];
};

}  // namespace

const char* nameOf(HapticEvent event) {
  switch (event) {
    case HapticEvent::kNone:
      break;
    case HapticEvent::kStall:
      return "stall";
    case HapticEvent::kLeap:
      return "leap";
    case HapticEvent::kClutch:
      return "clutch";
    case HapticEvent::kUnheard:
      return "unheard";
  }
  return "none";
}

HapticOutcome runHapticTrial(const HapticTrial& trial) {
  return Trial(trial).run();
}

}  // namespace viscera::bench
