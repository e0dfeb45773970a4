// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/haptics_trial.h"

#include <algorithm>
#include <cmath>
#include <vector>

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

/// @param settle_s  how long a hold takes
std::vector<Key> wayOf(double settle_s) {
  const double first = 1.1 + settle_s, second = first + 0.2 + settle_s;
  return {{0, 0.012},      {0.2, 0.004},          {0.4, 0.012},     {0.6, 0.003},          {1.1, -0.004},
          {first, -0.004}, {first + 0.2, -0.006}, {second, -0.006}, {second + 0.2, 0.012}, {second + 0.5, 0.012}};
}
constexpr double kTouches_s = 0.6;  ///< before it the tip is free
constexpr double kLeft_s = 0.05;    ///< after the way out the tip is free again
constexpr double kLook_s = 0.4;     ///< at the end of a hold
constexpr double kSettle_s = 1.5;   ///< a hold, and in it some times of a free device's ringing
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

}  // namespace

HapticOutcome runHapticTrial(const HapticTrial& trial) {
  const Scene scene = slab(trial.young_modulus_pa);
  Session session(scene);
  SimulatedDeviceConfig device_config;
  device_config.mass_kg = trial.mass_kg;
  device_config.delay_s = trial.delay_s;
  const double ring_s = 2 * trial.mass_kg / (device_config.damping_n_s_per_m + device_config.hand_damping_n_s_per_m);
  const std::vector<Key> way = wayOf(kSettle_s + kRings * ring_s);
  SimulatedDevice device(device_config, tipAt(heightAt(way, 0)));
  HapticServoConfig config;
  config.tick_s = session.tick_s();
  config.round_trip_s = trial.delay_s;
  config.tissue = {trial.young_modulus_pa, trial.young_modulus_pa, scene.bodies[0].material.poisson_ratio, kRadius_m};
  HapticServo servo(config);

  HapticOutcome out;
  Hold holds[2];
  double next_tick_s = 0, answer_s = -1;
  TickContact answer;
  Reaction told;
  const int periods = static_cast<int>(std::lround(way.back().time_s / kPeriod_s));
  for (int i = 0; i < periods; ++i) {
    const double now_s = i * kPeriod_s;
    const Vector3d tip_m = device.measured_m();
    if (now_s >= next_tick_s) {
      next_tick_s += session.tick_s();
      StylusSamples samples;
      samples[0].valid = true;
      samples[0].pose.position_m = tip_m;
      answer = session.step(samples, {}).contacts[0];
      answer_s = now_s + kComputing * session.tick_s();
    }
    if (answer_s >= 0 && now_s >= answer_s) {
      servo.put(answer, now_s);
      if (trial.rate_hz == 0) told = answer.reaction;
      answer_s = -1;
    }
    if (trial.rate_hz > 0) told = servo.step(tip_m, now_s, now_s);
    device.step(told.force_n, tipAt(heightAt(way, now_s)));
    out.least_energy_mj = std::min(out.least_energy_mj, 1e3 * device.energy_j());
    if (now_s < kTouches_s || now_s > way[8].time_s + kLeft_s) out.free_n = std::max(out.free_n, told.force_n.norm());
    for (int h = 0; h < 2; ++h) {
      const double end_s = way[h ? 7 : 5].time_s;
      if (now_s < end_s - kLook_s || now_s >= end_s) continue;
      holds[h].force.add(told.force_n.norm());
      holds[h].depth.add(kTop_m + kRadius_m - device.position_m().z());
      holds[h].ticks.add(answer.reaction.force_n.norm());
    }
  }
  out.depth_mm = 1e3 * holds[1].depth.mean();
  out.force_n = holds[1].force.mean();
  out.simulator_n = holds[1].ticks.mean();
  if (out.simulator_n > 0) out.static_error = std::abs(out.force_n - out.simulator_n) / out.simulator_n;
  out.stiffness_n_per_m =
      (holds[1].force.mean() - holds[0].force.mean()) / (holds[1].depth.mean() - holds[0].depth.mean());
  for (const Hold& hold : holds) {
    out.swing_n = std::max(out.swing_n, hold.force.swing());
    out.swing_mm = std::max(out.swing_mm, 1e3 * hold.depth.swing());
  }
  out.observed_mj = 1e3 * servo.passivity().least_j();
  out.share = servo.share();
  return out;
}

}  // namespace viscera::bench
