// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/suture/suture_trials.h"

#include <algorithm>
#include <cmath>

#include "bench/suites/suture/sutures.h"
#include "solver/processes/suture/suture_contacts.h"

namespace viscera::bench {

namespace {

constexpr double kCalmSubstep_s = 5e-3;
const Vector3d kGravity(0, 0, -9.81);

/// Returns a material that comes to rest soon.
ChainMaterial calm(double bending_share = 1) {
  ChainMaterial out = nylon(bending_share);
  out.damping_s = 5e-3;
  out.mass_damping_per_s = 100;
  return out;
}

/// A suture with its first two nodes fixed: it begins in the middle of the first link.
struct Clamped {
  Clamped(const ChainMaterial& material, size_t nodes, double length_m)
      : chain(material, straight(nodes, length_m / (static_cast<double>(nodes) - 1.5))),
        last(static_cast<uint32_t>(nodes - 1)) {
    around.holds = {holdAt(chain, 0), holdAt(chain, 1)};
  }
  Vector3d tip() const { return chain.positions_m()[last] - Vector3d(chain.link_m() / 2, 0, 0); }
  Vector3d end() const { return (chain.positions_m()[last] - chain.positions_m()[last - 1]).normalized(); }
  Chain chain;
  ChainAround around;
  uint32_t last;
};

double speedOf(const Chain& chain) {
  double out = 0;
  for (const Vector3d& v : chain.velocities_m_per_s()) out = std::max(out, v.norm());
  return out;
}

/// A rod along y through a point, and the ground below a height.
class Ground {
 public:
  Ground(const Vector3d& axis_m, double radius_m, double height_m, double friction) {
    constexpr float kLong_m = 10, kTurn = 0.70710678F;
    const auto share = static_cast<float>(friction), radius = static_cast<float>(radius_m);
    const auto x = static_cast<float>(axis_m.x()), z = static_cast<float>(axis_m.z());
    layout::ObstacleMotion rod{}, plane{};
    rod.from = {x, 0, z, radius};
    rod.to = {x, 0, z, kLong_m};
    rod.from_orientation = rod.to_orientation = {kTurn, 0, 0, kTurn};
    rod.velocity.w = plane.velocity.w = share;
    rod.info.x = layout::kShapeCapsule;
    plane.from = plane.to = {0, 0, static_cast<float>(height_m), 0};
    plane.from_orientation = plane.to_orientation = {0, 0, 0, 1};
    plane.info.x = layout::kShapePlane;
    things_ = {rod, plane};
  }
  void touch(const Chain& chain, double dt_s, ChainAround& around) {
    const auto count = static_cast<uint32_t>(things_.size());
    finder_.find(chain, things_.data(), count, {}, dt_s, around.touches);
    around.entered = [&chain, this, count, dt_s](const std::vector<Vector3d>& ends_m,
                                                 std::vector<ChainTouch>& touches) {
      return finder_.catchUp(chain, things_.data(), count, dt_s, ends_m, touches);
    };
  }

 private:
  std::vector<layout::ObstacleMotion> things_;
  SutureContacts finder_;
};

}  // namespace

TipTrial bentByForce(double load, size_t nodes) {
  constexpr double kLength_m = 0.03;
  Clamped clamped(calm(), nodes, kLength_m);
  const double force_n = load * clamped.chain.material().bending_nm2 / (kLength_m * kLength_m);
  clamped.around.loads = {{clamped.last, Vector3d(0, 0, force_n)}};
  for (int k = 0; k < 400; ++k) clamped.chain.step(kCalmSubstep_s, clamped.around);
  return {clamped.tip().x() / kLength_m, clamped.tip().z() / kLength_m};
}

double bentByMoment(double turns, size_t nodes) {
  constexpr double kLength_m = 0.03;
  constexpr int kRise = 700, kAll = 1500;
  Clamped clamped(calm(), nodes, kLength_m);
  const double link_m = clamped.chain.link_m();
  // From one hinge to the next: the last link's direction rotates with its hinges, half a link short of the tip.
  const double moment_nm = turns * 2 * kPi * clamped.chain.material().bending_nm2 / (kLength_m - link_m / 2);
  double turned = 0, angle = 0;
  for (int k = 0; k < kAll; ++k) {
    const Vector3d end = clamped.end(), side(-end.z(), 0, end.x());
    const double force_n = std::min(1.0, static_cast<double>(k) / kRise) * moment_nm / link_m;
    clamped.around.loads = {{clamped.last, force_n * side}, {clamped.last - 1, -force_n * side}};
    clamped.chain.step(kCalmSubstep_s, clamped.around);
    const double now = std::atan2(clamped.end().z(), clamped.end().x());
    turned += std::remainder(now - angle, 2 * kPi);
    angle = now;
  }
  return turned / (2 * kPi);
}

CatenaryTrial hungUp(double width_m, size_t nodes) {
  constexpr double kLength_m = 0.2, kLimp = 1e-4;
  const double link_m = kLength_m / static_cast<double>(nodes - 1);
  std::vector<Vector3d> positions(nodes);  // a V with links of the right length
  for (size_t i = 0; i < nodes; ++i) {
    const double path_m = link_m * static_cast<double>(i);
    const double depth = std::sqrt(kLength_m * kLength_m - width_m * width_m) / kLength_m;
    positions[i] = Vector3d(path_m * width_m / kLength_m, 0, -depth * std::min(path_m, kLength_m - path_m));
  }
  Chain chain(calm(kLimp), positions);
  ChainAround around;
  around.gravity_m_per_s2 = kGravity;
  around.holds = {holdAt(chain, 0), holdAt(chain, static_cast<uint32_t>(nodes - 1))};
  for (int k = 0; k < 4000; ++k) chain.step(2e-3, around);
  double low = 1e-3, high = 10;  // of the catenary's parameter
  for (int k = 0; k < 200; ++k) {
    const double middle = (low + high) / 2;
    (2 * middle * std::sinh(width_m / (2 * middle)) > kLength_m ? low : high) = middle;
  }
  CatenaryTrial out;
  for (const Vector3d& position : chain.positions_m()) out.sag = std::max(out.sag, -position.z());
  out.exact_sag = low * (std::cosh(width_m / (2 * low)) - 1);
  out.tension = chain.tension_n(nodes / 2 - 1);
  out.exact_tension = chain.mass_kg(1) / link_m * -kGravity.z() * low;
  return out;
}

double drawnOverCylinder(double angle_deg) {
  constexpr double kRadius_m = 5e-3, kFriction = 0.3, kBack_n = 0.1, kSpeed_m_per_s = 0.01, kLink_m = 2.5e-4;
  constexpr double kFree_m = 0.02;
  const double angle = angle_deg * kPi / 180, round_m = kRadius_m + nylon().radius_m;
  std::vector<Vector3d> positions;  // straight, round by the angle, straight; the top is in the middle
  const auto at = [&](double path_m) {
    const double along = path_m / round_m, inside = std::clamp(along, -angle / 2, angle / 2);
    const double rest_m = (along - inside) * round_m;
    return Vector3d(round_m * std::sin(inside) + rest_m * std::cos(inside), 0,
                    round_m * std::cos(inside) - rest_m * std::sin(inside));
  };
  const int half = static_cast<int>((kFree_m + angle / 2 * round_m) / kLink_m);
  for (int i = -half; i <= half; ++i) positions.push_back(at(i * kLink_m));
  ChainMaterial material = nylon(1e-3);
  material.mass_damping_per_s = 20;
  Chain chain(material, positions);
  Ground cylinder(Vector3d::Zero(), kRadius_m, -1, kFriction);
  ChainAround around;
  const uint32_t last = static_cast<uint32_t>(positions.size() - 1);
  around.holds = {holdAt(chain, last)};
  const Vector3d back = (positions[0] - positions[1]).normalized(),
                 ahead = (positions[last] - positions[last - 1]).normalized();
  double before = 0, behind = 0;
  constexpr int kAll = 2000, kCounted = 500;
  for (int k = 0; k < kAll; ++k) {
    around.holds[0].to_m += kSpeed_m_per_s * kSubstep_s * ahead;
    around.loads = {{0, std::min(1.0, k / 200.0) * kBack_n * back}};
    cylinder.touch(chain, kSubstep_s, around);
    chain.step(kSubstep_s, around);
    if (k < kAll - kCounted) continue;
    before += chain.tension_n(2);
    behind += chain.tension_n(last - 2);
  }
  return behind / before / std::exp(kFriction * angle);
}

PullTrial pulledBy(double force_n) {
  constexpr size_t kNodes = 300;
  constexpr double kLink_m = 0.2 / 299, kBow_m = 0.01;
  constexpr int kAll = 2000, kRise = 400;
  std::vector<Vector3d> positions(kNodes, Vector3d::Zero());
  for (size_t i = 1; i < kNodes; ++i) {
    const double turn = static_cast<double>(i) * kLink_m / kBow_m;
    positions[i] = positions[i - 1] + kLink_m * Vector3d(std::cos(turn), 0.1, -std::sin(turn)).normalized();
  }
  Chain chain(nylon(), positions);
  ChainAround around;
  around.gravity_m_per_s2 = kGravity;
  around.holds = {holdAt(chain, 0)};
  PullTrial out;
  for (int k = 0; k < kAll; ++k) {
    const double now_n = force_n * std::min(1.0, static_cast<double>(k) / kRise);
    around.loads = {{kNodes - 1, Vector3d(now_n, 0, 0)}};
    chain.step(kSubstep_s, around);
    out.worst_link = std::max(out.worst_link, chain.worstLink());
    out.iterations += static_cast<double>(chain.iterations()) / kAll;
    out.most_iterations = std::max<double>(out.most_iterations, chain.iterations());
  }
  out.tension = chain.tension_n(kNodes / 2) / force_n;
  return out;
}

FlightTrial thrown() {
  constexpr size_t kNodes = 300;
  constexpr double kLink_m = 0.2 / 299, kCoil_m = 0.012;
  std::vector<Vector3d> positions(kNodes, Vector3d::Zero()), speeds(kNodes);
  for (size_t i = 0; i < kNodes; ++i) {
    const double turn = static_cast<double>(i) * kLink_m / kCoil_m, share = static_cast<double>(i) / kNodes;
    if (i > 0) positions[i] = positions[i - 1] + kLink_m * Vector3d(std::cos(turn), -std::sin(turn), 0.1).normalized();
    speeds[i] = Vector3d(std::sin(7 * share), std::cos(11 * share), 0.3);
  }
  Chain chain(nylon(), positions);
  chain.setVelocities(speeds);
  ChainAround around;
  double speed = 0, spin = 0;
  const auto sums = [&] {
    std::pair<Vector3d, Vector3d> out{Vector3d::Zero(), Vector3d::Zero()};
    for (size_t i = 0; i < kNodes; ++i) {
      const Vector3d p = chain.mass_kg(i) * chain.velocities_m_per_s()[i];
      out.first += p;
      out.second += chain.positions_m()[i].cross(p);
      speed += p.norm();
      spin += chain.positions_m()[i].cross(p).norm();
    }
    return out;
  };
  for (int k = 0; k < 3; ++k) chain.step(kSubstep_s, around);  // speeds that are compatible with its links
  const auto first = sums();
  FlightTrial out;
  for (int k = 0; k < 4000; ++k) {
    chain.step(kSubstep_s, around);
    out.worst_link = std::max(out.worst_link, chain.worstLink());
  }
  const double speed_before = speed, spin_before = spin;
  const auto last = sums();
  out.momentum = (last.first - first.first).norm() / speed_before;
  out.angular = (last.second - first.second).norm() / spin_before;
  return out;
}

ModeTrial plucked(double length_m) {
  constexpr size_t kNodes = 60;
  constexpr double kClampedMode = 3.51602;  // first root of 1 + cos cosh, squared
  constexpr int kPeriods = 6;
  const ChainMaterial material = nylon();
  const double line_kg_per_m = material.density_kg_per_m3 * kPi * material.radius_m * material.radius_m;
  const double omega = kClampedMode / (length_m * length_m) * std::sqrt(material.bending_nm2 / line_kg_per_m);
  Clamped bent(calm(), kNodes, length_m);
  bent.around.loads = {{bent.last, Vector3d(0, 0, 0.06 * material.bending_nm2 / (length_m * length_m))}};
  for (int k = 0; k < 400; ++k) bent.chain.step(kCalmSubstep_s, bent.around);
  Chain chain(material, bent.chain.positions_m());
  ChainAround around;
  around.holds = {holdAt(chain, 0), holdAt(chain, 1)};
  std::vector<double> times, peaks;
  double one = 0, two = 0, time_s = 0;  // heights before
  while (peaks.size() <= kPeriods && time_s < 10) {
    chain.step(kSubstep_s, around);
    const double now = chain.positions_m().back().z();
    if (time_s > 0 && one > two && one >= now && one > 0) {
      const double off = (two - now) / 2 / (two - 2 * one + now);
      times.push_back(time_s + off * kSubstep_s);
      peaks.push_back(one - (two - now) / 4 * off);
    }
    two = one;
    one = now;
    time_s += kSubstep_s;
  }
  ModeTrial out;
  out.exact_hz = omega / (2 * kPi);
  out.expected_damping = omega * material.damping_s / 2;
  out.hz = kPeriods / (times.back() - times.front());
  out.damping = std::log(peaks.front() / peaks.back()) / (2 * kPi * kPeriods);
  return out;
}

double substepCost_us(size_t nodes) {
  constexpr int kTries = 20, kEach = 50;
  Chain chain(nylon(), straight(nodes, 6.7e-4));
  ChainAround around;
  around.gravity_m_per_s2 = kGravity;
  around.holds = {holdAt(chain, 0)};
  for (int k = 0; k < 100; ++k) chain.step(kSubstep_s, around);
  double best_s = 1;
  for (int t = 0; t < kTries; ++t) {
    const double from_s = cpuTime_s();
    for (int k = 0; k < kEach; ++k) chain.step(kSubstep_s, around);
    best_s = std::min(best_s, (cpuTime_s() - from_s) / kEach);
  }
  return 1e6 * best_s;
}

StressTrial drawnAbout(double seconds, double bending_share) {
  constexpr size_t kNodes = 200;
  constexpr double kSpeed_m_per_s = 1, kReach_m = 0.03, kForce_n = 20, kCylinder_m = 0.005, kHeight_m = -0.03;
  constexpr double kLink_m = 6.7e-4;
  ChainMaterial material = nylon(bending_share);
  material.mass_damping_per_s = 4;  // about that of air
  Chain chain(material, straight(kNodes, kLink_m));
  const Vector3d axis_m(0.06, 0, -0.006);
  Ground ground(axis_m, kCylinder_m, kHeight_m, 0.2);
  ChainAround around;
  around.gravity_m_per_s2 = kGravity;
  around.holds = {holdAt(chain, 0), holdAt(chain, kNodes - 1)};
  around.holds[1].most_n = kForce_n;
  const Vector3d middle_m = around.holds[1].to_m;
  uint32_t seed = 1;
  const auto random = [&seed] {
    seed = seed * 1664525U + 1013904223U;
    return static_cast<double>(seed >> 8) / 16777216.0 - 0.5;
  };
  Vector3d offset(-0.8, 0.1, 0.6);
  StressTrial out;
  const int all = static_cast<int>(seconds / kSubstep_s), rest = static_cast<int>(4 / kSubstep_s);
  double phase = 0, from_s = cpuTime_s();
  for (int k = 0; k < all + rest; ++k) {
    if (k < all) phase += kSubstep_s * kSpeed_m_per_s / kReach_m;
    if (phase > 2 * kPi) {
      phase -= 2 * kPi;
      offset = Vector3d(-1 + random(), 2 * random(), 2 * random()).normalized();
    }
    around.holds[1].to_m = middle_m + kReach_m * std::sin(phase) * offset;
    ground.touch(chain, kSubstep_s, around);
    chain.step(kSubstep_s, around);
    out.worst_link = std::max(out.worst_link, chain.worstLink());
    out.bad += chain.worstLink() > 1e-3;
    out.iterations += chain.iterations();
    out.most_iterations = std::max<double>(out.most_iterations, chain.iterations());
    out.most_force_n = std::max(out.most_force_n, around.holds[1].impulse_ns.norm() / kSubstep_s);
    for (const Vector3d& position : chain.positions_m()) {
      out.nonfinite += !position.allFinite();
      const double from_axis_m = std::hypot(position.x() - axis_m.x(), position.z() - axis_m.z());
      out.deepest_m = std::max({out.deepest_m, kCylinder_m - from_axis_m, kHeight_m - position.z()});
    }
    if (k + 1 == all) out.substep_us = 1e6 * (cpuTime_s() - from_s) / all;
  }
  out.substeps = all + rest;
  out.iterations /= out.substeps;
  out.rest_speed_m_per_s = speedOf(chain);
  return out;
}

}  // namespace viscera::bench
