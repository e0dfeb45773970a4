// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/suture/track_trials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "bench/suites/suture/sutures.h"

namespace viscera::bench {

namespace {

constexpr double kFriction = 0.3, kQuarter = kPi / 2;

/// Positions at equal distances along straight pieces of equal length that turn by `angle` at each of `corners` in x
/// and z, with a longer piece at each end. `at_m`: positions of the corners along it.
struct Corners {
  Corners(size_t corners, double angle, double piece_m, double end_m, double link_m) {
    const double all_m = 2 * end_m + piece_m * (static_cast<double>(corners) - 1);
    for (size_t k = 0; k < corners; ++k) at_m.push_back(end_m + piece_m * static_cast<double>(k));
    Vector3d at = Vector3d::Zero();
    double heading = 0, path_m = 0;
    size_t next = 0;
    positions.push_back(at);
    while (path_m + link_m < all_m) {  // a link over a corner is slightly shorter; the first substep corrects that
      path_m += link_m;
      while (next < corners && path_m > at_m[next]) {
        points.push_back(at + (link_m - (path_m - at_m[next])) * direction(heading));
        heading += angle;
        at = points.back() - (link_m - (path_m - at_m[next])) * direction(heading);
        ++next;
      }
      at += link_m * direction(heading);
      positions.push_back(at);
    }
  }
  static Vector3d direction(double heading) { return {std::cos(heading), 0, -std::sin(heading)}; }
  std::vector<Vector3d> positions, points;
  std::vector<double> at_m;
};

constexpr double kMass_kg = 2e-5;

/// Tissue that is a free mass at each of three channels.
struct FreeMasses {
  FreeMasses() { speeds.fill(Vector3d::Zero()); }
  ChainAround around(double link_m) {
    ChainAround out;
    for (size_t c = 0; c < positions.size(); ++c) {
      ChainSlide slide;
      slide.s = 20.3 + 17.8 * static_cast<double>(c);
      slide.mass_kg = kMass_kg;
      slide.friction = kFriction;
      slide.through_n = 1e-3;
      slide.most_n = 0.05;
      positions[c] = Vector3d(slide.s * link_m, 0, 0);
      out.slides.push_back(slide);
    }
    out.answer = [this](std::vector<ChainSlide>& slides) {
      for (size_t c = 0; c < slides.size(); ++c) {
        speeds[c] += (slides[c].impulse_ns - given[c]) / kMass_kg;
        given[c] = slides[c].impulse_ns;
        slides[c].to_m = positions[c] + kSubstep_s * speeds[c];
      }
    };
    return out;
  }
  std::array<Vector3d, 3> positions, speeds, given;
};

}  // namespace

TrackTrial drawnThroughTracks(size_t channels, double bending_share, double back_n) {
  constexpr double kLink_m = 5e-4, kPiece_m = 6e-3, kEnd_m = 0.03, kSpeed_m_per_s = 0.01;
  constexpr int kAll = 2000, kCounted = 800;  // eight links
  const Corners corners(channels, kQuarter / static_cast<double>(channels), kPiece_m, kEnd_m, kLink_m);
  ChainMaterial material = nylon(bending_share);
  material.mass_damping_per_s = 20;
  Chain chain(material, corners.positions);
  const auto last = static_cast<uint32_t>(chain.nodes() - 1);
  ChainAround around;
  for (size_t k = 0; k < channels; ++k) {
    ChainSlide slide;
    slide.s = corners.at_m[k] / kLink_m;
    slide.between_rest_m = k + 1 < channels ? kPiece_m : 0;
    slide.to_m = corners.points[k];
    slide.friction = kFriction;
    around.slides.push_back(slide);
  }
  around.holds = {holdAt(chain, last)};
  const Vector3d back = (chain.positions_m()[0] - chain.positions_m()[1]).normalized();
  const Vector3d ahead = (chain.positions_m()[last] - chain.positions_m()[last - 1]).normalized();
  std::vector<double> ratios;
  TrackTrial out;
  for (int k = 0; k < kAll; ++k) {
    around.holds[0].to_m += kSpeed_m_per_s * kSubstep_s * ahead;
    around.loads = {{0, std::min(1.0, k / 200.0) * back_n * back}};
    chain.step(kSubstep_s, around);
    out.iterations += static_cast<double>(chain.iterations()) / kAll;
    if (k >= kAll - kCounted) ratios.push_back(chain.tension_n(last - 2) / chain.tension_n(2));
  }
  const double mean = std::accumulate(ratios.begin(), ratios.end(), 0.0) / static_cast<double>(ratios.size());
  for (const double ratio : ratios) out.ripple = std::max(out.ripple, std::abs(ratio / mean - 1));
  out.ratio = mean / std::exp(kFriction * kQuarter);
  return out;
}

TissueTrial thrownThroughTissue() {
  constexpr double kLink_m = 5e-4;
  Chain chain(nylon(0.1), straight(80, kLink_m));
  std::vector<Vector3d> offset(chain.nodes());
  for (size_t i = 0; i < offset.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(offset.size());
    offset[i] = Vector3d(0.3, std::sin(9 * share), std::cos(5 * share));
  }
  chain.setVelocities(offset);
  FreeMasses tissue;
  ChainAround around = tissue.around(kLink_m);
  double size = 0;
  const auto momentum = [&] {
    Vector3d out = Vector3d::Zero();
    const auto add = [&](const Vector3d& p) {
      out += p;
      size += p.norm();
    };
    for (size_t i = 0; i < chain.nodes(); ++i) add(chain.mass_kg(i) * chain.velocities_m_per_s()[i]);
    for (const Vector3d& speed : tissue.speeds) add(kMass_kg * speed);
    return out;
  };
  TissueTrial out;
  Vector3d first = Vector3d::Zero();
  double exchanged_ns = 0, first_size = 0;
  for (int k = 0; k < 1000; ++k) {
    if (k == 3) {  // speeds that are compatible with its links
      size = 0;
      first = momentum();
      first_size = size;
    }
    tissue.given.fill(Vector3d::Zero());
    chain.step(kSubstep_s, around);
    for (size_t c = 0; c < tissue.positions.size(); ++c) {
      const ChainSlide& slide = around.slides[c];
      exchanged_ns += slide.impulse_ns.norm();
      tissue.positions[c] += kSubstep_s * tissue.speeds[c] + slide.torn_m;
      if (!slide.out)
        out.off_m = std::max(out.off_m,
                             (ChainPoint(slide.s, chain.nodes()).of(chain.positions_m()) - tissue.positions[c]).norm());
    }
  }
  const double changed = (momentum() - first).norm();
  out.momentum = changed / first_size;
  out.exchanged = changed / exchanged_ns;
  return out;
}

KnotTrial pulledKnot() {
  constexpr double kLink_m = 5e-4, kHolds_n = 0.2, kSpeed_m_per_s = 0.01;
  constexpr int kHeld = 400, kSlipping = 600, kCounted = 200;
  const std::array<Vector3d, 7> corners = {Vector3d(-0.015, 0, 0), {0, 0, 0}, {0.005, 0, 0.005}, {0, 0, 0.01},
                                           {-0.005, 0, 0.005},     {0, 0, 0}, {0.015, 0, 0}};
  std::vector<Vector3d> positions;
  double ahead_m = 0;  // to the next node, along a side
  for (size_t k = 0; k + 1 < corners.size(); ++k) {
    const Vector3d side = corners[k + 1] - corners[k];
    for (; ahead_m < side.norm(); ahead_m += kLink_m) positions.push_back(corners[k] + ahead_m * side.normalized());
    ahead_m -= side.norm();
  }
  ChainMaterial material = nylon(1e-3);
  material.mass_damping_per_s = 20;
  Chain chain(material, positions);
  const auto last = static_cast<uint32_t>(chain.nodes() - 1);
  ChainAround around;
  around.holds = {holdAt(chain, 0)};
  ChainKnot knot;
  knot.s1 = 30;
  knot.s2 = 30 + 0.02 * std::sqrt(2.0) / kLink_m;
  knot.tied = true;
  knot.holds_n = kHolds_n;
  around.knots = {knot};
  KnotTrial out;
  const auto step = [&] {
    chain.step(kSubstep_s, around);
    const ChainKnot& now = around.knots[0];
    out.worst_link = std::max(out.worst_link, chain.worstLink());
    const Vector3d one = ChainPoint(now.s1, chain.nodes()).of(chain.positions_m());
    out.off_m = std::max(out.off_m, (ChainPoint(now.s2, chain.nodes()).of(chain.positions_m()) - one).norm());
  };
  for (int k = 0; k < kHeld; ++k) {
    around.loads = {{last, Vector3d(0.9 * kHolds_n * std::min(1.0, k / 200.0), 0, 0)}};
    step();
  }
  out.moved = std::abs(around.knots[0].s2 - knot.s2);
  around.loads.clear();
  around.holds.push_back(holdAt(chain, last));
  for (int k = 0; k < kSlipping; ++k) {
    around.holds[1].to_m.x() += kSpeed_m_per_s * kSubstep_s;
    step();
    if (k < kSlipping - kCounted) continue;
    const double loop_n = chain.tension_n(static_cast<size_t>(around.knots[0].s2) - 5);
    out.slips += (chain.tension_n(last - 3) - loop_n) / kHolds_n / kCounted;
  }
  return out;
}

double iterationCost_us(size_t channels, size_t knots) {
  constexpr double kLink_m = 6.7e-4;
  constexpr int kTries = 20, kEach = 50;
  Chain chain(nylon(), straight(300, kLink_m));
  ChainAround around;
  around.holds = {holdAt(chain, 0)};
  for (size_t c = 0; c < channels; ++c) {
    ChainSlide slide;
    slide.s = 10.5 + 10 * static_cast<double>(c);
    slide.to_m = Vector3d(slide.s * kLink_m, 0, 0);
    around.slides.push_back(slide);
  }
  for (size_t c = 0; c < knots; ++c) {  // small knots: their points are pulled together and stay there
    ChainKnot knot;
    knot.s1 = 250 + 12 * static_cast<double>(c);
    knot.s2 = knot.s1 + 8;
    knot.tied = true;
    around.knots.push_back(knot);
  }
  for (int k = 0; k < 200; ++k) chain.step(kSubstep_s, around);
  double best_us = 1e9;
  for (int t = 0; t < kTries; ++t) {
    const double from_s = cpuTime_s();
    int iterations = 0;
    for (int k = 0; k < kEach; ++k) {
      chain.step(kSubstep_s, around);
      iterations += chain.iterations();
    }
    best_us = std::min(best_us, 1e6 * (cpuTime_s() - from_s) / iterations);
  }
  return best_us;
}

}  // namespace viscera::bench
