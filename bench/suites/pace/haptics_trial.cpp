// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/pace/haptics_trial.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bench/harness/specimens/block_on_bone.h"
#include "bench/suites/pace/held_trial.h"

namespace viscera::bench {
namespace {

constexpr double kHapticsTrialSpacing_m = 0.005, kTop_m = 0.02, kRadius_m = 0.008;
/// Intended height of the tip above the surface [m] at a time [s].
struct HapticsTrialKey {
  double time_s, height_m;
};

/// Beginning and end of an event, and the time at which the user has returned from it [s].
constexpr double kEvent_s = 1.4, kOver_s = kEvent_s + 0.15, kReturns_s = kOver_s + 0.2, kBack_s = kReturns_s + 1.5;
constexpr double kAway_m = 0.03, kBaseLeap_m = 0.015;
constexpr double kTouches_s = 0.6;  ///< time before which the tip is free

constexpr int kPokes = 8;
constexpr double kPokeSpeed_m_per_s = 0.12, kPokeDepth_m = 0.009, kPokeTop_m = 0.003;
constexpr double kPoke_s = kPokeDepth_m / kPokeSpeed_m_per_s;  ///< duration of one stroke, down or up

bool happensInAHold(HapticEvent event) {
  return event != HapticEvent::kNone && event != HapticEvent::kPokes;
}
bool goesAway(HapticEvent event) {
  return happensInAHold(event) && event != HapticEvent::kLeap;
}

/// Returns the user's stroke. @param settle_s  duration of a hold
std::vector<HapticsTrialKey> pathOf(double settle_s, HapticEvent event) {
  std::vector<HapticsTrialKey> path = {{0, 0.012}, {0.2, 0.004}, {0.4, 0.012}, {kTouches_s, kPokeTop_m}};
  for (int i = 0; event == HapticEvent::kPokes && i < kPokes; ++i) {
    path.push_back({path.back().time_s + kPoke_s, kPokeTop_m - kPokeDepth_m});
    path.push_back({path.back().time_s + kPoke_s, kPokeTop_m});
  }
  path.push_back({path.back().time_s + 0.5, -0.004});
  if (happensInAHold(event)) path.push_back({kEvent_s, -0.004});
  if (goesAway(event)) {
    path.push_back({kOver_s, -0.004 + kAway_m});
    path.push_back({kReturns_s, -0.004 + kAway_m});
  }
  if (happensInAHold(event)) path.push_back({kBack_s, -0.004});
  const double first = path.back().time_s + settle_s, second = first + 0.2 + settle_s;
  for (const HapticsTrialKey& key : {HapticsTrialKey{first, -0.004},
                                     {first + 0.2, -0.006},
                                     {second, -0.006},
                                     {second + 0.2, 0.012},
                                     {second + 0.5, 0.012}})
    path.push_back(key);
  return path;
}
/// Indices into pathOf(), from its end: the ends of the holds, and the end of the retraction.
constexpr size_t kHoldEnds[2] = {5, 3}, kOut = 2;
constexpr double kLeaves_m_per_s = 0.018 / 0.2;  ///< speed while retracting
constexpr double kHapticsTrialLeft_s = 0.05;     ///< time after the retraction at which the tip is free again
constexpr double kHapticsTrialSample_s = 0.4;    ///< time at the end of a hold that is evaluated
constexpr double kHapticsTrialSettle_s = 1.5;    ///< duration of a hold, in addition to the ringing of the device
constexpr double kHapticsTrialRings = 6;

double heightAt(const std::vector<HapticsTrialKey>& path, double time_s) {
  for (size_t i = 1; i < path.size(); ++i)
    if (time_s < path[i].time_s)
      return path[i - 1].height_m + (time_s - path[i - 1].time_s) / (path[i].time_s - path[i - 1].time_s) *
                                        (path[i].height_m - path[i - 1].height_m);
  return path.back().height_m;
}

/// Returns a slab of tissue on bone.
Scene hapticsTrialSlab(double young_modulus_pa) {
  Scene scene;
  scene.name = "slab";
  scene.environment.gravity_m_per_s2.setZero();
  scene.bodies.push_back(blockOnBone(Vector3d(0.05, 0.05, kTop_m), kHapticsTrialSpacing_m, young_modulus_pa));
  scene.styluses.resize(1);
  scene.styluses[0].probe.radius_m = kRadius_m;
  scene.solver.backend = Backend::kCpu;
  scene.solver.threads = 1;
  return scene;
}

Vector3d tipAt(double height_m) {
  return {0.0013, -0.0007, kTop_m + kRadius_m + height_m};
}

class HapticsTrialRun : public HeldTrial {
 public:
  explicit HapticsTrialRun(const HapticTrial& trial)
      : HapticsTrialRun(trial, {trial.mass_kg, trial.delay_s, trial.poses_hz, trial.rate_hz, kRadius_m}) {}

  HapticOutcome run() {
    const int periods = static_cast<int>(std::lround(path_.back().time_s / kPeriod_s));
    for (int i = 0; i < periods; ++i) {
      now_s_ = i * kPeriod_s;
      befall();
      hear();
      tick();
      tell();
      device_.step(sent_force_n_, tipAt(heightAt(path_, now_s_)));
      sample();
    }
    return outcome();
  }

 private:
  HapticsTrialRun(const HapticTrial& trial, const Setting& setting)
      : HapticsTrialRun(trial, setting, offsets(trial, setting)) {}
  HapticsTrialRun(const HapticTrial& trial, const Setting& setting, const std::vector<HapticsTrialKey>& path)
      : HeldTrial(hapticsTrialSlab(trial.young_modulus_pa), setting, tipAt(heightAt(path, 0))),
        trial_(trial),
        path_(path) {}
  static std::vector<HapticsTrialKey> offsets(const HapticTrial& trial, const Setting& setting) {
    const SimulatedDeviceConfig device = deviceOf(setting);
    const double ring_s = 2 * trial.mass_kg / (device.damping_n_s_per_m + device.hand_damping_n_s_per_m);
    return pathOf(kHapticsTrialSettle_s + kHapticsTrialRings * ring_s, trial.event);
  }
  bool within(double from_s, double to_s) const { return now_s_ >= from_s && now_s_ < to_s; }

  /// Applies the event at the current time.
  void befall() {
    const HapticEvent event = trial_.event;
    stalled_ = event == HapticEvent::kStall && within(kEvent_s, kOver_s);
    input_.accepts_force = event != HapticEvent::kUnheard || !within(kEvent_s, kOver_s);
    clutched_ = event == HapticEvent::kClutch && (within(kEvent_s, kOver_s) || within(kReturns_s, kBack_s));
    const double base_m = event == HapticEvent::kLeap && within(kEvent_s, kReturns_s) ? kBaseLeap_m : 0;
    if (base_m != base_m_) reappears_ = true;
    base_m_ = base_m;
  }

  double keyTime(size_t from_end) const { return path_[path_.size() - from_end].time_s; }

  void sample() {
    out_.least_energy_mj = std::min(out_.least_energy_mj, 1e3 * device_.energy_j());
    const double size_n = sent_force_n_.norm();
    if (now_s_ < kTouches_s || now_s_ > keyTime(kOut) + kHapticsTrialLeft_s)
      out_.free_n = std::max(out_.free_n, size_n);
    if (trial_.event == HapticEvent::kPokes && within(kTouches_s, kTouches_s + 2 * kPokes * kPoke_s))
      poked_n_ = std::max(poked_n_, size_n);
    for (int h = 0; h < 2; ++h) {
      const double end_s = keyTime(kHoldEnds[h]);
      if (!within(end_s - kHapticsTrialSample_s, end_s)) continue;
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
    for (const ProbedHold& hold : holds_) {
      out_.swing_n = std::max(out_.swing_n, hold.force.swing());
      out_.swing_mm = std::max(out_.swing_mm, 1e3 * hold.depth.swing());
    }
    const double late_s = trial_.delay_s + 0.5 * kPeriod_s + 1 / trial_.poses_hz;
    const double leaves =
        std::max({holds_[1].force.mean() * kLeaves_m_per_s, poked_n_ * kPokeSpeed_m_per_s,
                  goesAway(trial_.event) ? holds_[0].force.mean() * kAway_m / (kOver_s - kEvent_s) : 0});
    out_.unheard_mj = 1e3 * late_s * leaves;
    const ForceLoop::HapticStats stats = loop_.stats(0);
    out_.observed_mj = 1e3 * stats.least_j;
    out_.stiffness_scale = stats.stiffness_scale;
    return out_;
  }

  const HapticTrial trial_;
  const std::vector<HapticsTrialKey> path_;
  HapticOutcome out_;
  ProbedHold holds_[2];
  double poked_n_ = 0;  ///< largest force of the pokes [N]
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
    case HapticEvent::kPokes:
      return "pokes";
    case HapticEvent::kUnheard:
      return "unheard";
  }
  return "none";
}

HapticOutcome runHapticTrial(const HapticTrial& trial) {
  return HapticsTrialRun(trial).run();
}

}  // namespace viscera::bench
