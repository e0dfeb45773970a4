// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/tissue_jump.h"

#include <algorithm>
#include <limits>

#include "math/decompositions.h"
#include "math/vec4.h"
#include "solver/processes/suture/needle.h"
#include "solver/processes/suture/needles.h"
#include "solver/processes/suture/thread_piece.h"

namespace viscera {

namespace {

constexpr double kTailPerJump = 8;  // length of tail that follows a jump, over its size: links change by an eighth
constexpr double kStays_m = 1e-6;
constexpr double kPrefersNoTurn = 0.01;  // of the points' spread, where they do not say how a needle turns

/// A place of a chain that is known to move.
struct ChainAnchor {
  double s;  ///< on the chain [links]
  Vector3d way_m, to_m, velocity_m_per_s;
  bool slides;  ///< a channel; else an end that is held
};

/// Channels, ends that are fixed, and the tail of a needle, in the order of the chain.
std::vector<ChainAnchor> anchorsOf(const TissueJump& jump, const Needle* needle, const ThreadPiece& piece) {
  const std::vector<Vector3d>& x = piece.chain.places_m();
  std::vector<ChainAnchor> out;
  std::vector<const TissuePoint*> points;
  piece.channels.addPoints(points);
  for (size_t k = 0; k < points.size(); ++k) {
    const ChainSlide& slide = piece.around.slides[k];
    if (slide.out) continue;
    const TissueJump::Step step = jump.of(*points[k]);
    out.push_back({slide.s, step.to_m - step.from_m, step.to_m, step.velocity_m_per_s, true});
  }
  for (size_t h = 0; h < piece.fixed_holds; ++h) {
    const ChainHold& hold = piece.around.holds[h];
    const Vector3d to_m = needle && hold.node == 0 ? needle->tail_m() : hold.to_m;
    out.push_back({static_cast<double>(hold.node), to_m - x[hold.node], to_m, Vector3d::Zero(), false});
  }
  std::sort(out.begin(), out.end(), [](const ChainAnchor& a, const ChainAnchor& b) { return a.s < b.s; });
  return out;
}

/// How far a place of the chain follows the anchor on its one side, and how far that on the other.
std::array<double, 2> sharesAt(double s, double link_m, const ChainAnchor* before, const ChainAnchor* behind) {
  if (before && behind) {
    const double apart = behind->s - before->s, share = apart > 0 ? (s - before->s) / apart : 0;
    return {1 - share, share};
  }
  const ChainAnchor& only = before ? *before : *behind;
  const double length_m = kTailPerJump * only.way_m.norm();
  const double off_m = std::abs(s - only.s) * link_m;
  const double share = length_m > 0 ? std::max(0.0, 1 - off_m / length_m) : 0;
  return {before ? share : 0, before ? 0 : share};
}

/// Puts the chain there and all channels on it, which slide as they like: none is torn by thread that is too short.
void put(const std::vector<ChainAnchor>& anchors, std::vector<Vector3d> x_m, std::vector<Vector3d> v_m_per_s,
         ThreadPiece& piece) {
  for (ChainSlide& slide : piece.around.slides) slide.impulse_ns.setZero();
  for (ChainKnot& knot : piece.around.knots) knot.impulse_ns.setZero();
  ChainAround around;
  for (const ChainAnchor& anchor : anchors) {
    if (anchor.slides) {
      around.slides.emplace_back();
      around.slides.back().s = anchor.s;
      around.slides.back().to_m = anchor.to_m;
    } else {
      around.holds.emplace_back();
      around.holds.back().node = static_cast<uint32_t>(anchor.s);
      around.holds.back().to_m = anchor.to_m;
    }
  }
  around.knots = piece.around.knots;
  for (ChainKnot& knot : around.knots) {
    knot.tied = true;
    knot.holds_n = std::numeric_limits<double>::infinity();
  }
  piece.chain.put(std::move(x_m), std::move(v_m_per_s), around);
  auto put = around.slides.begin();
  for (ChainSlide& slide : piece.around.slides) {
    if (slide.out) continue;
    if (!put->out) slide.s = put->s;
    ++put;
  }
}

}  // namespace

TissueJump::Step TissueJump::of(const TissuePoint& point) const {
  Step out{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  for (uint32_t c = 0; c < point.count; ++c) {
    const uint32_t slot = point.slots[c];
    const double weight = static_cast<double>(point.weights[c]);
    out.from_m += weight * (points_.rest_m(slot) + xyz(before_m_[slot]));
    out.to_m += weight * (points_.rest_m(slot) + xyz(after_.displacement_m[slot]));
    out.velocity_m_per_s += weight * xyz(after_.velocity_m_per_s[slot]);
  }
  return out;
}

void carry(const TissueJump& jump, const Needle* needle, ThreadPiece& piece) {
  if (piece.channels.empty() && !needle) return;
  const std::vector<ChainAnchor> anchors = anchorsOf(jump, needle, piece);
  const bool stays =
      std::all_of(anchors.begin(), anchors.end(), [](const ChainAnchor& a) { return a.way_m.norm() < kStays_m; });
  if (stays) return;
  Chain& chain = piece.chain;
  std::vector<Vector3d> x = chain.places_m(), v = chain.velocities_m_per_s();
  for (size_t i = 0; i < x.size(); ++i) {
    const auto s = static_cast<double>(i);
    const auto next = std::find_if(anchors.begin(), anchors.end(), [&](const ChainAnchor& a) { return a.s > s; });
    const ChainAnchor* const before = next == anchors.begin() ? nullptr : &*(next - 1);
    const ChainAnchor* const behind = next == anchors.end() ? nullptr : &*next;
    const std::array<double, 2> shares = sharesAt(s, chain.link_m(), before, behind);
    v[i] *= 1 - shares[0] - shares[1];
    for (const auto& [anchor, share] : {std::make_pair(before, shares[0]), std::make_pair(behind, shares[1])}) {
      if (!anchor) continue;
      x[i] += share * anchor->way_m;
      v[i] += share * anchor->velocity_m_per_s;
    }
  }
  put(anchors, std::move(x), std::move(v), piece);
}

/// By the rotation and translation nearest to how the tissue on it moves.
void Needle::carry(const TissueJump& jump) {
  if (led_ || !isInTissue()) return;
  std::vector<TissueJump::Step> steps;
  for (Crossing& crossing : crossings_) {
    steps.push_back(jump.of(crossing.point));
    crossing.impulse_ns.setZero();
  }
  if (tip_.state >= kInside) steps.push_back(jump.of(tip_.point));
  tip_.impulse_ns.setZero();
  Vector3d from_m = Vector3d::Zero(), to_m = from_m, velocity = from_m;
  for (const TissueJump::Step& step : steps) {
    from_m += step.from_m / static_cast<double>(steps.size());
    to_m += step.to_m / static_cast<double>(steps.size());
    velocity += step.velocity_m_per_s / static_cast<double>(steps.size());
  }
  Eigen::Matrix3d both = Eigen::Matrix3d::Zero();
  double spread_m2 = shape_.wireRadius_m() * shape_.wireRadius_m();
  for (const TissueJump::Step& step : steps) {
    both += (step.to_m - to_m) * (step.from_m - from_m).transpose();
    spread_m2 += (step.from_m - from_m).squaredNorm();
  }
  both += kPrefersNoTurn * spread_m2 * Eigen::Matrix3d::Identity();
  const Quaterniond turn(nearestRotation(both));
  end_.position_m = to_m + turn * (end_.position_m - from_m);
  end_.orientation = (turn * end_.orientation).normalized();
  from_ = end_;
  velocity_ = velocity;
  turning_.setZero();
}

void Needles::carry(const TissueJump& jump) {
  for (OnThread& one : needles_) one.needle.carry(jump);
}

}  // namespace viscera
