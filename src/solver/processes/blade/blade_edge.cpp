// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/blade/blade_edge.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "math/archive.h"
#include "math/vec4.h"

namespace viscera {

namespace {

constexpr double kSampleStep = 0.3;  // of the kernel: distance of samples
constexpr double kStale = 0.05;      // of the spacing: a front that far from its kernel's centre gets a new one
constexpr double kGathered = 0.5;  // of the spacing: nodes are gathered again for a front that far from where they were
constexpr double kClosed = 0.2;    // share of a gap that is closed per substep
constexpr double kFlats = 3;       // times the limit: sideways force that the flats of a blade bear
constexpr int kSweeps = 8;         // largest number of sweeps over the samples, which share nodes
constexpr double kSettled = 1e-4;  // of the largest impulse: sweeps stop when no impulse changes by more
constexpr double kLeft = 2;        // of the spacing: a front that far ahead of the edge becomes free
constexpr double kOffMotion = 0.9;  // cosine to the tool's direction below which an impulse keeps its own direction
constexpr double kOfTissue = 0.55;  // weight of the slicing ratio in the tissue, relative to that of the tool's motion
constexpr double kMostStep = 0.5;   // of the spacing: largest step of a front in a substep
constexpr double kAhead = 0.9;      // of the spacing: distance ahead of the search for wounds; beyond its own half cell
constexpr double kAside = 0.5;      // of the spacing: sideways distance of that search, as a wound moves
constexpr double kCutStep = 0.125;  // of the spacing: advance of fronts after which springs are cut
constexpr double kDirectionMemory =
    0.25;  // of the spacing: length over which a tool's direction is averaged, against tremor

constexpr double kHalfKernel = 0.27;  // of the kernel: distance of its mean from its centre, if tissue is on one side

Vector3d unit(const Vector3d& v) {
  const double size = v.norm();
  return size > 0 ? Vector3d(v / size) : Vector3d(Vector3d::Zero());
}
Vector3d atMost(const Vector3d& v, double most) {
  const double size = v.norm();
  return size > most ? Vector3d(most / size * v) : v;
}

}  // namespace

BladeEdge::BladeEdge(RestTissue& tissue, double friction_n_per_m)
    : tissue_(tissue),
      friction_n_per_m_(tissue.toughness().carriedFriction_n_per_m(friction_n_per_m)),
      kernel_m_(tissue.toughness().kernel_m(friction_n_per_m)),
      h_(tissue.toughness().spacing_m()) {}

void BladeEdge::act(TissuePort& target, uint32_t stylus, const layout::ToolMotion& blade, double dt_s) {
  if (fronts_.empty()) place(blade);
  aim(blade, dt_s);
  renewKernels();
  if (!near_.runs.empty()) target.readRuns(near_.runs, near_.u, near_.v);
  sense(dt_s);
  findLengths();
  solve(dt_s);
  if (!near_.runs.empty()) give(target, stylus, dt_s);
  advance(dt_s);
  followThroughAir();
  cutBehind(target, false);
  stickAgain();
}

/// Places the fronts at the edge. A blade that appears in tissue is treated as if it had always been there.
void BladeEdge::place(const layout::ToolMotion& blade) {
  const Vector3d first = xyz(blade.from), span = xyz(blade.blade_from) - first;
  const size_t segments = std::max<size_t>(1, static_cast<size_t>(std::ceil(span.norm() / (kSampleStep * kernel_m_))));
  stored_j_ = 0;
  fronts_.assign(segments + 1, {});
  kernels_.assign(segments + 1, {});
  shares_.assign(segments, {});
  pushes_.assign(segments + 1, {});
  for (size_t i = 0; i <= segments; ++i) {
    Front& front = fronts_[i];
    front.edge = first + static_cast<double>(i) / static_cast<double>(segments) * span;
    front.at = front.cut = front.edge;
    front.centre = front.gathered = Vector3d::Constant(std::numeric_limits<double>::infinity());
  }
}

void BladeEdge::aim(const layout::ToolMotion& blade, double dt_s) {
  const Vector3d to = xyz(blade.to), span = xyz(blade.blade_to) - to;
  along_ = unit(span);
  const double last = static_cast<double>(fronts_.size() - 1);
  for (size_t i = 0; i < fronts_.size(); ++i) {
    const Vector3d next = to + static_cast<double>(i) / last * span, travel = next - fronts_[i].edge;
    pushes_[i] = {};
    pushes_[i].edge_velocity = travel / dt_s;
    fronts_[i].travel = std::exp(-travel.norm() / (kDirectionMemory * h_)) * fronts_[i].travel + travel;
  }
}

void BladeEdge::renewKernels() {
  bool changed = false, strayed = false;
  for (const Front& front : fronts_) strayed |= !((front.at - front.gathered).norm() <= kGathered * h_);
  if (strayed) {
    for (Front& front : fronts_) front.gathered = front.at;
    near_along_ = along_;
    gather();
  }
  for (size_t i = 0; i < fronts_.size(); ++i) {
    Front& front = fronts_[i];
    if (!strayed && (front.at - front.centre).norm() <= kStale * h_) continue;
    front.centre = front.at;
    kernels_[i].make(near_, front.centre, kernel_m_);
    kernels_[i].is_new = changed = true;
  }
  if (!changed) return;
  findMobilities();
  for (size_t i = 0; i + 1 < fronts_.size(); ++i) {
    if (kernels_[i].is_new || kernels_[i + 1].is_new) findShares(i);
  }
}

/// Gathers the nodes for all kernels that are made until a front leaves the gathered region.
void BladeEdge::gather() {
  std::vector<Vector3d> centres_m;
  for (const Front& front : fronts_) centres_m.push_back(front.gathered);
  near_.gather(tissue_, centres_m, near_along_, kernel_m_ + kGathered * h_);
  for (std::vector<float>& momenta : momenta_) momenta.resize(near_.share.size());
}

void BladeEdge::findMobilities() {
  const size_t n = fronts_.size();
  mobilities_.assign(n * n, 0);
  for (size_t i = 0; i < n; ++i) {
    kernels_[i].spread(near_, spread_);
    for (size_t j = i; j < n && (fronts_[j].centre - fronts_[i].centre).norm() < 2 * kernel_m_; ++j)
      mobilities_[i * n + j] = mobilities_[j * n + i] = kernels_[j].mobility(spread_);
  }
}

/// Finds the position and velocity of the tissue without the blade. The displacement of the last substep is subtracted.
void BladeEdge::sense(double dt_s) {
  for (size_t i = 0; i < fronts_.size(); ++i) {
    Push& push = pushes_[i];
    if (kernels_[i].is_new) fronts_[i].to_rest = kernels_[i].toRest(near_);
    Vector3d u_m;
    kernels_[i].means(near_, u_m, push.velocity);
    push.gap = fronts_[i].edge - (fronts_[i].at + u_m - dt_s * push.velocity);
    fronts_[i].edge += dt_s * push.edge_velocity;
  }
}

/// Returns 1 / sqrt(1 + xi^2), with xi the displacement along the edge over that across it.
double BladeEdge::drawnBy(const Vector3d& travel) const {
  const double all2 = travel.squaredNorm(), along = travel.dot(along_);
  return all2 > 0 ? std::sqrt(std::max(0.0, 1 - along * along / all2)) : 1;
}

/// Returns 1 at a surface through which the edge enters, 0 where there is as much tissue behind the front as ahead. The
/// toughness that is carried is smaller at a surface.
double BladeEdge::ahead(size_t i) const {
  return std::clamp(kernels_[i].lean.dot(fronts_[i].forward) / (kHalfKernel * kernel_m_), 0.0, 1.0);
}

/// Returns the mean over the length that sample i represents [J/m2].
double BladeEdge::toughness(size_t i) const {
  const Push& push = pushes_[i];
  return push.length_m > 0 ? push.over_length.with(ahead(i)) / push.length_m : 0;
}

/// Sets the limit of a drawn blade. The slicing ratio is a mean of that of the tool's motion and that of the edge's
/// motion in the tissue, which moves along. With the first alone the force follows the law; with the second alone the
/// work does.
void BladeEdge::limit(size_t i) {
  const Front& front = fronts_[i];
  Push& push = pushes_[i];
  push.side = front.forward.cross(along_);
  push.of_tool = unit(front.travel - front.travel.dot(push.side) * push.side);
  const double of_tool = drawnBy(front.travel), in_tissue = drawnBy(front.to_rest.inverse() * front.travel);
  push.yield_n_s = (of_tool + kOfTissue * (in_tissue - of_tool)) * push.cap_n_s;
}

void BladeEdge::solve(double dt_s) {
  done_.limit_n = 0;
  for (size_t i = 0; i < fronts_.size(); ++i) {
    Push& push = pushes_[i];
    const bool parts = fronts_[i].stuck && push.length_m > 0;
    push.cap_n_s = parts ? toughness(i) * partedPerSwept(i) * push.length_m * dt_s : 0;
    push.slips = parts && !(push.cap_n_s > 0);  // tissue without toughness
    if (parts) limit(i);
    done_.limit_n += push.yield_n_s / dt_s + friction_n_per_m_ * push.length_m;
  }
  bool settled = false;
  for (int sweep = 0; sweep < kSweeps && !settled; ++sweep) {
    double changed_n_s = 0, most_n_s = 0;
    for (size_t i = 0; i < fronts_.size(); ++i) {
      const Vector3d before = pushes_[i].impulse;
      solveOne(i, dt_s);
      rubOne(i, dt_s);
      changed_n_s = std::max(changed_n_s, (pushes_[i].impulse - before).cwiseAbs().maxCoeff());
      most_n_s = std::max(most_n_s, pushes_[i].impulse.cwiseAbs().maxCoeff());
    }
    settled = changed_n_s <= kSettled * most_n_s;
  }
  giveBackAtMost();
}

void BladeEdge::solveOne(size_t i, double dt_s) {
  Push& push = pushes_[i];
  const double mobility = mobilities_[i * fronts_.size() + i];
  if (!(push.cap_n_s > 0) || !(mobility > 0)) return;
  const Vector3d missing = push.edge_velocity + kClosed / dt_s * push.gap - push.velocity;
  give(i, limited(i, push.impulse - push.rub + missing / mobility) + push.rub);
}

/// Limits an impulse: an edge does not pull. Across its plane the flats of the blade push, up to a limit; in its plane
/// the tissue yields.
Vector3d BladeEdge::limited(size_t i, const Vector3d& impulse) {
  Push& push = pushes_[i];
  push.slips = push.aside = false;
  const Vector3d& forward = fronts_[i].forward;
  if (!(impulse.dot(forward) > 0)) return Vector3d::Zero();
  const double sideways = impulse.dot(push.side), bears = kFlats * push.cap_n_s;
  const Vector3d in_plane = impulse - sideways * push.side;
  push.slips = in_plane.norm() > push.yield_n_s;
  push.aside = std::abs(sideways) > bears;
  const Vector3d held = push.slips ? Vector3d(push.yield_n_s * alongMotion(push.of_tool, unit(in_plane))) : in_plane;
  return held + std::clamp(sideways, -bears, bears) * push.side;
}

/// Returns the direction of the resistance of tissue that is being cut: opposite to the tool's motion, unless the
/// impulse is at a large angle to it.
Vector3d BladeEdge::alongMotion(const Vector3d& of_tool, const Vector3d& in_plane) {
  const double near = std::clamp((of_tool.dot(in_plane) - kOffMotion) / (1 - kOffMotion), 0.0, 1.0);
  return unit(in_plane + near * (of_tool - in_plane));
}

void BladeEdge::give(TissuePort& target, uint32_t stylus, double dt_s) {
  bool any = false;
  for (const Push& push : pushes_) any |= push.impulse.squaredNorm() > 0;
  if (!any) return;
  for (std::vector<float>& momenta : momenta_) std::fill(momenta.begin(), momenta.end(), 0.0f);
  for (size_t i = 0; i < fronts_.size(); ++i) {
    if (pushes_[i].impulse.squaredNorm() > 0) kernels_[i].give(pushes_[i].impulse.cast<float>(), momenta_);
  }
  near_.toVelocities(momenta_);
  target.pushRuns(stylus, static_cast<float>(dt_s), near_.runs, momenta_);
}

/// Maps a vector in the current tissue to rest, by the inverse of F.
Vector3d BladeEdge::toRest(size_t i, const Vector3d& gap) const {
  return atMost(fronts_[i].to_rest * gap, kMostStep * h_);
}

void BladeEdge::advance(double dt_s) {
  for (size_t i = 0; i < fronts_.size(); ++i) {
    Front& front = fronts_[i];
    const Push& push = pushes_[i];
    front.forward = unit(front.forward - front.forward.dot(along_) * along_);
    const Vector3d gap = push.gap + dt_s * (push.edge_velocity - push.velocity);
    if (front.stuck && gap.dot(front.forward) < -kLeft * h_) front.stuck = 0;
    if (!(push.length_m > 0)) front.stuck = 0;  // it left the tissue on the other side
    const Vector3d from = front.at;
    if (front.stuck) {
      moveFront(i, gap);
      countArea(i, front.at - from);
    } else {
      front.at += push.length_m > 0 ? toRest(i, gap) : gap;
    }
  }
}

/// Moves a front within the blade's plane, unless the flats yield.
void BladeEdge::moveFront(size_t i, const Vector3d& gap) {
  Front& front = fronts_[i];
  const Push& push = pushes_[i];
  if (!push.slips || gap.dot(front.forward) <= 0) return;
  const Vector3d side = front.forward.cross(along_);
  const Vector3d step = push.aside ? gap : Vector3d(gap - gap.dot(side) * side);
  front.at += toRest(i, step);
  const Vector3d across = step - step.dot(along_) * along_;
  front.forward = unit(front.forward + across / (kMostStep * h_));
}

/// Moves samples outside the tissue with the nearest one that cuts, so the tissue is cut up to its surface.
void BladeEdge::followThroughAir() {
  const auto count = static_cast<int>(fronts_.size());
  for (int i = 0; i < count; ++i) {
    Front& front = fronts_[static_cast<size_t>(i)];
    if (front.stuck || pushes_[static_cast<size_t>(i)].length_m > 0) continue;
    const Front* nearest = nullptr;
    for (int a = 1; a < count && !nearest; ++a) {
      for (const int j : {i - a, i + a}) {
        if (j >= 0 && j < count && fronts_[static_cast<size_t>(j)].stuck) nearest = &fronts_[static_cast<size_t>(j)];
      }
    }
    if (nearest) front.at = nearest->at + (front.edge - nearest->edge);
  }
}

/// Cuts the area that fronts have swept since the last call, if it is large enough. @param all  regardless of size
void BladeEdge::cutBehind(TissuePort& target, bool all) {
  bool due = all;
  for (const Front& front : fronts_)
    due |= front.cuts && (!front.stuck || (front.at - front.cut).norm() > kCutStep * h_);
  for (size_t i = 0, end = 0; due && i + 1 < fronts_.size(); i = end) {
    end = i + 1;
    if (!cutsBetween(i)) continue;
    while (end + 1 < fronts_.size() && cutsBetween(end) && isStraight(i, end + 1)) ++end;
    const Front &a = fronts_[i], &b = fronts_[end];
    layout::ToolMotion sweep{};
    sweep.from = rounded(startOf(a));
    sweep.to = rounded(a.at);
    sweep.blade_from = rounded(startOf(b));
    sweep.blade_to = rounded(b.at);
    target.cutAtRest(sweep, false);
    tissue_.part(a.cut, a.at, b.at, b.cut);
  }
  bool any = false;
  for (const Front& front : fronts_) any |= front.stuck != 0;
  for (size_t i = 0; i < fronts_.size(); ++i) {
    Front& front = fronts_[i];
    if (!due && (front.stuck || (any && !(pushes_[i].length_m > 0)))) continue;
    front.cut = front.at;
    front.cuts = front.stuck;
  }
}

/// Returns whether tissue around a position ahead is whole. It samples an area, as wounds move: near a wound, or just
/// below its end, it is not.
bool BladeEdge::isWhole(const Vector3d& ahead, const Vector3d& side) const {
  bool whole = true;
  for (const double aside : {-kAside, 0.0, kAside}) {
    for (const double along : {-kAside, 0.0, kAside})
      whole &= !tissue_.isParted(ahead + h_ * (aside * side + along * along_));
  }
  return whole;
}

/// Starts a new front where the edge enters whole tissue: tissue at rest that this blade has not cut. In its own wound
/// a blade feels nothing.
void BladeEdge::stickAgain() {
  for (size_t i = 0; i < fronts_.size(); ++i) {
    Front& front = fronts_[i];
    if (front.stuck || !(pushes_[i].length_m > 0)) continue;
    const Vector3d across = front.travel - front.travel.dot(along_) * along_;
    const Vector3d forward = unit(across), side = forward.cross(along_);
    if (forward.isZero() || !(pushes_[i].edge_velocity.dot(forward) > 0)) continue;
    if (!goesIntoWhole(i, kAhead * h_ * forward, side)) continue;
    front.stuck = front.cuts = 1;
    front.forward = forward;
    const Vector3d behind = front.at - kAhead * h_ * forward;
    front.cut = tissue_.isParted(behind) || tissue_.fill(behind) <= 0 ? behind : front.at;
  }
}

bool BladeEdge::leave(TissuePort& target) {
  if (fronts_.empty()) return false;
  cutBehind(target, true);
  fronts_.clear();
  done_.limit_n = 0;
  return true;
}

void BladeEdge::reset() {
  fronts_.clear();
  done_ = {};
}

/// Saves or restores. Kernels are derived from the fronts.
void BladeEdge::persist(Archive& archive) {
  archive.list(fronts_);
  archive.value(done_);
  archive.value(stored_j_);
  archive.value(near_along_);
  if (!archive.reads()) return;
  kernels_.assign(fronts_.size(), {});
  shares_.assign(fronts_.size(), {});
  pushes_.assign(fronts_.size(), {});
  if (fronts_.empty()) return;
  gather();
  for (size_t i = 0; i < fronts_.size(); ++i) {
    kernels_[i].make(near_, fronts_[i].centre, kernel_m_);
    kernels_[i].is_new = false;
  }
  findMobilities();
  for (size_t i = 0; i + 1 < fronts_.size(); ++i) findShares(i);
}

}  // namespace viscera
