// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Needles and sutures that a device moves.
#include <algorithm>
#include <cmath>
#include <vector>

#include "bench/harness/specimens/clamp.h"
#include "bench/suites/pace/haptics_trial.h"
#include "bench/suites/pace/held_trial.h"

namespace viscera::bench {
namespace {

constexpr double kHapticsSutureTrialSpacing_m = 0.003, kHapticsSutureTrialThick_m = 0.009,
                 kHapticsSutureTrialTip_m = 0.006;
constexpr double kNeedle_m = 0.02;    ///< radius of its arc: large, because the device does not rotate it
constexpr double kTransfer_m = 0.02;  ///< height of a suture's end over the surface at which it is just taut
constexpr double kHapticsSutureTrialSettle_s = 1.5, kRings = 6, kHapticsSutureTrialSample_s = 0.4, kLeft_s = 0.05;
constexpr double kMotion_m_per_s = 0.09;  ///< speed while retracting

/// Intended height of the tip over the surface, or of a suture's end over its taut position [m].
struct HapticsSutureTrialKey {
  double time_s, height_m;
};
/// A time span that is evaluated: the end of a hold, or the largest forces of a motion.
struct Span {
  const char* name;
  bool held;
  double from_s, to_s;
};

/// A stroke, and the time spans that are evaluated.
struct Plan {
  std::vector<HapticsSutureTrialKey> path;
  std::vector<Span> spans;
  double touches_s = 0, left_s = 0;  ///< the tool is free before and after

  double now_s() const { return path.back().time_s; }
  void go(double to_m, double m_per_s) {
    path.push_back({now_s() + std::abs(to_m - path.back().height_m) / m_per_s, to_m});
  }
  void hold(const char* name, double settle_s) {
    path.push_back({now_s() + settle_s, path.back().height_m});
    spans.push_back({name, true, now_s() - kHapticsSutureTrialSample_s, now_s()});
  }
  void pass(const char* name, double to_m, double m_per_s) {
    const double from_s = now_s();
    go(to_m, m_per_s);
    spans.push_back({name, false, from_s, now_s()});
  }
  double at(double time_s) const {
    for (size_t i = 1; i < path.size(); ++i) {
      const HapticsSutureTrialKey &a = path[i - 1], &b = path[i];
      if (time_s < b.time_s)
        return a.height_m + (time_s - a.time_s) / (b.time_s - a.time_s) * (b.height_m - a.height_m);
    }
    return path.back().height_m;
  }
};

Plan planOf(HapticTool tool, double settle_s) {
  constexpr double kSlow = 0.02, kQuick = 0.04;
  Plan out;
  if (tool == HapticTool::kNeedle) {
    out.path = {{0, 0.012}, {0.2, 0.004}, {0.4, 0.012}, {0.6, 0.003}};
    out.touches_s = 0.6;
    out.go(-0.0004, kSlow);
    out.hold("skin, less", settle_s);
    out.go(-0.0008, kSlow);
    out.hold("skin", settle_s);
    out.pass("puncture", -0.0055, kSlow);
    out.hold("inside", settle_s);
    out.pass("far skin", -kHapticsSutureTrialThick_m - 0.004, kSlow);
    out.hold("through", settle_s);
  } else {
    out.path = {{0, 0}, {0.2, -0.008}, {0.4, -0.004}, {0.6, -0.008}};
    out.touches_s = 0.6;
    out.go(0.001, kQuick);
    out.hold("pulled, less", settle_s);
    out.go(0.002, kQuick);
    out.hold("pulled", settle_s);
  }
  out.pass("out", tool == HapticTool::kNeedle ? 0.012 : -0.008, kMotion_m_per_s);
  out.left_s = out.now_s() + kLeft_s;
  out.path.push_back({out.now_s() + 0.3, out.path.back().height_m});
  return out;
}

/// Returns a slab that is fixed at its four sides, and free above and below.
BodyConfig slab(double young_modulus_pa) {
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = Vector3d(0.036, 0.03, kHapticsSutureTrialThick_m);
  body.position_m = Vector3d(0, 0, -kHapticsSutureTrialThick_m / 2);
  body.spacing_m = kHapticsSutureTrialSpacing_m;
  body.material.young_modulus_pa = young_modulus_pa;
  for (const Vector3d& out : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0)}) {
    body.fixed.push_back(
        clampBehind(out.cwiseProduct(0.5 * body.box_size_m) - 0.1 * kHapticsSutureTrialSpacing_m * out, -out));
  }
  return body;
}

Vector3d tipAt(HapticTool tool, double height_m) {
  if (tool == HapticTool::kNeedle) return {0.0033, -0.0007, height_m};
  return {0.006, 0, kTransfer_m + height_m};
}

/// Adds a needle with its tip pointing down, at the device's initial position.
void addNeedle(SutureConfig& suture) {
  const double sideways_m = kNeedle_m * std::sqrt(0.5);  // of its tail, from the centre of its circle
  suture.needle.arc = NeedleArc::kThreeEighths;
  suture.needle.radius_m = kNeedle_m;
  suture.needle.rotation_deg = Vector3d(180, 0, 0);
  suture.position_m = tipAt(HapticTool::kNeedle, 0.012) + Vector3d(-kNeedle_m - sideways_m, 0, sideways_m);
  suture.path.push_back({suture.position_m + Vector3d(0, 0, 0.04)});
}

/// Adds a suture with one end fixed next to a bite of 9 mm, the other above it.
void addBite(SutureConfig& suture) {
  suture.start = SutureEnd::kFixed;
  suture.position_m = Vector3d(-0.009, 0, 0.004);
  suture.path.push_back({Vector3d(-0.0045, 0, 0.0008)});
  for (const Vector3d& mm : {Vector3d(-4.5, 0, -0.7), Vector3d(-4, 0, -3.5), Vector3d(-1.5, 0, -5.8),
                             Vector3d(1.5, 0, -5.8), Vector3d(4, 0, -3.5), Vector3d(4.5, 0, -0.7)}) {
    suture.path.push_back({1e-3 * mm});
    suture.channels.push_back({"", 1e-3 * mm});
  }
  suture.path.push_back({Vector3d(0.0045, 0, 0.0008)});
  suture.path.push_back({tipAt(HapticTool::kSuture, 0)});
}

Scene sceneOf(const HapticTrial& trial) {
  Scene scene;
  scene.environment.gravity_m_per_s2.setZero();
  scene.bodies.push_back(slab(trial.young_modulus_pa));
  const bool needle = trial.tool == HapticTool::kNeedle;
  scene.styluses.resize(1);
  scene.styluses[0].idle = needle ? ToolMode::kNeedle : ToolMode::kGrab;
  SutureConfig suture;
  suture.material = SutureMaterial::kSilk;
  suture.usp = SutureSize::kUsp4;
  if (needle)
    addNeedle(suture);
  else
    addBite(suture);
  scene.sutures.push_back(suture);
  scene.solver.backend = Backend::kCpu;
  scene.solver.threads = 1;
  return scene;
}

class SutureTrial : public HeldTrial {
 public:
  explicit SutureTrial(const HapticTrial& trial)
      : SutureTrial(trial, {trial.mass_kg, trial.delay_s, trial.poses_hz, trial.rate_hz, kHapticsSutureTrialTip_m}) {}

  std::vector<HapticStage> run() {
    for (int i = 0; i * kPeriod_s < plan_.now_s(); ++i) {
      now_s_ = i * kPeriod_s;
      hear();
      tick();
      tell();
      device_.step(sent_force_n_, tipAt(trial_.tool, plan_.at(now_s_)));
      sample();
    }
    std::vector<HapticStage> out;
    for (size_t s = 0; s < plan_.spans.size(); ++s)
      out.push_back({plan_.spans[s].name, plan_.spans[s].held, outcomeOf(s)});
    return out;
  }

 private:
  SutureTrial(const HapticTrial& trial, const Setting& setting)
      : HeldTrial(sceneOf(trial), setting, tipAt(trial.tool, trial.tool == HapticTool::kNeedle ? 0.012 : 0)),
        trial_(trial),
        plan_(planOf(trial.tool, settle_s(deviceOf(setting)))),
        samples_(plan_.spans.size()) {
    input_.accepts_force = true;
  }
  static double settle_s(const SimulatedDeviceConfig& device) {
    return kHapticsSutureTrialSettle_s +
           kRings * 2 * device.mass_kg / (device.damping_n_s_per_m + device.hand_damping_n_s_per_m);
  }

  /// Returns the depth of the tip, or the displacement of the pulled suture.
  double depth_m() const {
    const double height_m = device_.position_m().z() - tipAt(trial_.tool, 0).z();
    return trial_.tool == HapticTool::kNeedle ? -height_m : height_m;
  }

  void sample() {
    least_j_ = std::min(least_j_, device_.energy_j());
    const double size_n = sent_force_n_.norm();
    if (now_s_ < plan_.touches_s || now_s_ > plan_.left_s) free_n_ = std::max(free_n_, size_n);
    for (size_t s = 0; s < samples_.size(); ++s) {
      if (now_s_ < plan_.spans[s].from_s || now_s_ >= plan_.spans[s].to_s) continue;
      samples_[s].force.add(size_n);
      samples_[s].depth.add(depth_m());
      samples_[s].ticks.add(ticks_n_);
    }
  }

  HapticOutcome outcomeOf(size_t s) const {
    const ProbedHold& sample = samples_[s];
    HapticOutcome out;
    out.least_energy_mj = 1e3 * least_j_;
    out.free_n = free_n_;
    const ForceLoop::HapticStats stats = loop_.stats(0);
    out.observed_mj = 1e3 * stats.least_j;
    out.stiffness_scale = stats.stiffness_scale;
    double most_held_n = 0;
    for (size_t k = 0; k < samples_.size(); ++k)
      if (plan_.spans[k].held) most_held_n = std::max(most_held_n, samples_[k].force.mean());
    out.unheard_mj = 1e3 * (trial_.delay_s + 0.5 * kPeriod_s + 1 / trial_.poses_hz) * most_held_n * kMotion_m_per_s;
    out.depth_mm = 1e3 * sample.depth.mean();
    out.force_n = sample.force.most;
    out.simulator_n = sample.ticks.most;
    if (!plan_.spans[s].held) return out;
    out.force_n = sample.force.mean();
    out.simulator_n = sample.ticks.mean();
    if (out.simulator_n > 0) out.static_error = std::abs(out.force_n - out.simulator_n) / out.simulator_n;
    out.swing_n = sample.force.swing();
    out.swing_mm = 1e3 * sample.depth.swing();
    if (s == 1)
      out.stiffness_n_per_m =
          (sample.force.mean() - samples_[0].force.mean()) / (sample.depth.mean() - samples_[0].depth.mean());
    return out;
  }

  const HapticTrial trial_;
  const Plan plan_;
  std::vector<ProbedHold> samples_;
  double least_j_ = 0, free_n_ = 0;
};

}  // namespace

std::vector<HapticStage> runSutureTrial(const HapticTrial& trial) {
  return SutureTrial(trial).run();
}

}  // namespace viscera::bench
