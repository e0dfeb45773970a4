// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/thread/channel_trials.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bench/suites/thread/threads.h"

namespace viscera::bench {

namespace {

constexpr double kFriction = 0.3, kQuarter = kPi / 2;

/// Places at one distance along straight pieces of one length that turn by `angle` at each of `corners` in x and z,
/// with a longer piece at each end; `at_m`: of the corners along it.
struct Corners {
  Corners(size_t corners, double angle, double piece_m, double end_m, double link_m) {
    const double all_m = 2 * end_m + piece_m * (static_cast<double>(corners) - 1);
    for (size_t k = 0; k < corners; ++k) at_m.push_back(end_m + piece_m * static_cast<double>(k));
    Vector3d at = Vector3d::Zero();
    double heading = 0, way_m = 0;
    size_t next = 0;
    places.push_back(at);
    while (way_m + link_m < all_m) {  // a link over a corner is not quite as long: the first substep mends that
      way_m += link_m;
      while (next < corners && way_m > at_m[next]) {
        points.push_back(at + (link_m - (way_m - at_m[next])) * direction(heading));
        heading += angle;
        at = points.back() - (link_m - (way_m - at_m[next])) * direction(heading);
        ++next;
      }
      at += link_m * direction(heading);
      places.push_back(at);
    }
  }
  static Vector3d direction(double heading) { return {std::cos(heading), 0, -std::sin(heading)}; }
  std::vector<Vector3d> places, points;
  std::vector<double> at_m;
};

}  // namespace

ChannelTrial drawnThroughChannels(size_t channels, double bending_share, double back_n) {
  constexpr double kLink_m = 5e-4, kPiece_m = 6e-3, kEnd_m = 0.03, kSpeed_m_per_s = 0.01;
  constexpr int kAll = 2000, kCounted = 800;  // eight links
  const Corners corners(channels, kQuarter / static_cast<double>(channels), kPiece_m, kEnd_m, kLink_m);
  ChainMaterial material = nylon(bending_share);
  material.drag_per_s = 20;
  Chain chain(material, corners.places);
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
  const Vector3d back = (chain.places_m()[0] - chain.places_m()[1]).normalized();
  const Vector3d ahead = (chain.places_m()[last] - chain.places_m()[last - 1]).normalized();
  std::vector<double> ratios;
  ChannelTrial out;
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

}  // namespace viscera::bench
