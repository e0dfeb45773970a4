// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Sums over an edge: its length in tissue, the area that it cuts, the energy that it may return; geometry of its
// fronts.
#include <algorithm>
#include <cmath>

#include "solver/processes/blade/blade_edge.h"

namespace viscera {

namespace {

constexpr double kStrip = 0.125;       // of the spacing: largest length of the strips that are inside tissue or not
constexpr double kMostStrips = 1000;   // bound for folded tissue
constexpr double kMostStretch = 1.5;   // bound on the ratio of areas in folded tissue
constexpr double kMostOfSheet = 1.03;  // the same for sheets: it is exceeded as triangles fold in cuts at 45 degrees
constexpr double kStraight = 0.01;     // of the spacing: fronts that close to a straight line are cut as if on it
constexpr double kOverlap = 0.02;      // of the spacing: overlap of two sweeps, so no spring between them remains
constexpr double kGivenBack = 0.25;    // largest share of the stored energy that a substep returns: a smooth end

}  // namespace

int BladeEdge::stripsOf(double length_m) const {
  return std::max(1, static_cast<int>(std::ceil(std::min(length_m / (kStrip * h_), kMostStrips))));
}

/// Computes how much of the edge between sample i and the next, in the tissue at rest, each of them represents.
void BladeEdge::findShares(size_t i) {
  const Vector3d from = fronts_[i].centre, span = fronts_[i + 1].centre - from;
  const int strips = stripsOf(span.norm());
  shares_[i] = {};
  for (int s = 0; s < strips; ++s) {
    const double t = (s + 0.5) / strips;
    const Vector3d at = from + t * span;
    const double fill = tissue_.fill(at) / strips;
    const RestToughness::Carried& carried = tissue_.toughness().at(at);
    shares_[i][0].add((1 - t) * fill, carried);
    shares_[i][1].add(t * fill, carried);
  }
}

void BladeEdge::findLengths() {
  for (size_t i = 0; i + 1 < fronts_.size(); ++i) {
    const double all_m = (fronts_[i + 1].edge - fronts_[i].edge).norm();
    pushes_[i].stand(all_m, shares_[i][0]);
    pushes_[i + 1].stand(all_m, shares_[i][1]);
  }
}

/// Returns whether the tissue ahead is whole, at the nearest position with tissue on the part of the edge that sample i
/// represents. Without tissue nothing is cut. @param ahead  from its front, at rest
bool BladeEdge::goesIntoWhole(size_t i, const Vector3d& ahead, const Vector3d& side) const {
  const Vector3d& from = fronts_[i].at;
  const Vector3d travels[2] = {fronts_[i > 0 ? i - 1 : i].at - from,
                               fronts_[std::min(i + 1, fronts_.size() - 1)].at - from};
  const int strips = stripsOf(std::max(travels[0].norm(), travels[1].norm()));
  for (int s = 0; s <= strips; ++s) {
    for (const Vector3d& travel : travels) {
      const Vector3d at = from + ahead + static_cast<double>(s) / strips * travel;
      if (tissue_.isTissue(at)) return isWhole(at, side);
    }
  }
  return false;
}

/// Returns the area that a sample cuts at rest over the area that its edge sweeps in the current tissue: toughness is
/// work per area at rest.
double BladeEdge::partedPerSwept(size_t i) const {
  const Front &a = fronts_[i > 0 ? i - 1 : 0], &b = fronts_[std::min(i + 1, fronts_.size() - 1)];
  const double swept = (b.edge - a.edge).norm();
  const double parted = (b.at - a.at).cross(fronts_[i].to_rest * fronts_[i].forward).norm();
  const double most = tissue_.isSheet() ? kMostOfSheet : kMostStretch;
  return swept > 0 ? std::clamp(parted / swept, 1 / most, most) : 1;
}

/// Limits the energy returned to the user to what this edge has stored in the tissue in this stroke. Oscillations from
/// other work, or from previous strokes, do not push the tool. Forces decrease with the remaining energy.
void BladeEdge::giveBackAtMost() {
  const size_t n = fronts_.size();
  double work_j = 0, given_j = 0;
  for (const Push& push : pushes_) work_j += push.impulse.dot(push.edge_velocity);
  const double most_j = kGivenBack * stored_j_;
  if (work_j < -most_j) {
    const double less = 1 + most_j / work_j;
    for (size_t i = 0; i < n; ++i) {
      for (size_t j = 0; j < n; ++j) pushes_[j].velocity -= less * mobilities_[i * n + j] * pushes_[i].impulse;
    }
    for (Push& push : pushes_) {
      push.impulse *= 1 - less;
      push.slips = push.aside = false;
    }
    work_j = -most_j;
  }
  for (const Push& push : pushes_) given_j += push.impulse.dot(push.velocity);
  stored_j_ = std::max(0.0, stored_j_ + std::min(work_j, given_j));
  done_.work_j += work_j;
}

/// Returns whether the fronts between two samples are close to the line between them.
bool BladeEdge::isStraight(size_t first, size_t last) const {
  const Front &a = fronts_[first], &b = fronts_[last];
  for (size_t i = first + 1; i < last; ++i) {
    const double t = static_cast<double>(i - first) / static_cast<double>(last - first);
    const Vector3d at = a.at + t * (b.at - a.at), cut = a.cut + t * (b.cut - a.cut);
    if (std::max((fronts_[i].at - at).norm(), (fronts_[i].cut - cut).norm()) > kStraight * h_) return false;
  }
  return true;
}

/// Returns the start of the next sweep that cuts behind a front.
Vector3d BladeEdge::startOf(const Front& front) const {
  const Vector3d travel = front.at - front.cut;
  return travel.isZero(0) ? front.cut : Vector3d(front.cut - kOverlap * h_ * travel.normalized());
}

/// Counts the area of a step. @param step  of a front, at rest
void BladeEdge::countArea(size_t i, const Vector3d& step) {
  const Front &a = fronts_[i > 0 ? i - 1 : 0], &b = fronts_[std::min(i + 1, fronts_.size() - 1)];
  const double length_m = (b.edge - a.edge).norm();
  if (step.isZero(0) || !(length_m > 0)) return;
  const double area_m2 = pushes_[i].length_m / length_m * (b.at - a.at).cross(step).norm();
  done_.area_m2 += area_m2;
  done_.parting_j += toughness(i) * area_m2;
}

}  // namespace viscera
