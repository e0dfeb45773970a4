// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/chain/chain.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLinkTolerance = 1e-4;  // of a link's length: an error is corrected in the next substep
constexpr double kOff_m = 2e-5;          // of a channel: corrected in the next substep as well
constexpr int kMostIterations = 80;      // 2 ms for 300 nodes; reached only where a suture snaps taut
constexpr int kFrozenAfter = 8;          // iterations after which touches only close
constexpr int kStillAfter = 24;     // iterations after which no channel moves: stops may send each other back and forth
constexpr int kMostWaits = 4;       // substeps in which it does not move; then it takes the current iterate
constexpr double kPut_s = 5e-4;     // a usual substep
constexpr double kMidpoint = 0.25;  // bending at the middle of the substep: dissipates no energy

}  // namespace

Chain::Chain(const ChainMaterial& material, std::vector<Vector3d> positions_m)
    : material_(material),
      link_m_((positions_m[1] - positions_m[0]).norm()),
      mass_kg_(material.density_kg_per_m3 * kPi * material.radius_m * material.radius_m * link_m_),
      bend_n_per_m_(material.bending_nm2 / (link_m_ * link_m_ * link_m_)),
      start_(std::move(positions_m)),
      x_(start_),
      v_(x_.size(), Vector3d::Zero()),
      mu_(x_.size() - 1, 0.0),
      matrix_(x_.size()),
      ahead_(x_),
      next_(x_),
      bent_(x_),
      links_(mu_.size()),
      rest_(x_.size()) {}

void Chain::stop() {
  std::fill(v_.begin(), v_.end(), Vector3d::Zero());
  std::fill(mu_.begin(), mu_.end(), 0.0);
}

/// Moves the nodes by a substep from rest: their displacement is minimal, weighted by mass.
void Chain::put(std::vector<Vector3d> positions_m, std::vector<Vector3d> v_m_per_s, ChainAround& around) {
  x_ = std::move(positions_m);
  stop();
  step(dt_s_ > 0 ? dt_s_ : kPut_s, around);
  stop();
  waits_ = 0;
  v_ = std::move(v_m_per_s);
}

Vector3d Chain::point(uint32_t node, double share) const {
  return share == 0 ? next_[node] : (1 - share) * next_[node] + share * next_[node + 1];
}

/// Solves m (x' - y) + bending - tensions + holds and touches = 0 with constant link lengths by Newton's method.
void Chain::step(double dt_s, ChainAround& around) {
  if (dt_s_ > 0 && dt_s != dt_s_) {
    for (double& mu : mu_) mu *= dt_s * dt_s / (dt_s_ * dt_s_);
  }
  dt_s_ = dt_s;
  begin(around);
  before_slides_ = around.slides;
  before_knots_ = around.knots;
  slides_.begin(shape(), around.swaged, around.knots, around.slides);
  knots_.begin(around.slides, shape(), around.knots);
  const bool asks = !around.slides.empty() && around.answer;
  if (asks) around.answer(around.slides);
  bool changed = true;
  for (iterations_ = 0;; ++iterations_) {
    measureLinks();
    const bool done = !changed && solved(around);
    if (iterations_ == kMostIterations || (done && !(around.entered && around.entered(next_, around.touches)))) break;
    setBending();
    setLinks();
    setAround(around);
    const bool whole = advance(around);
    changed = !whole;
    const bool frozen = !whole || iterations_ >= kFrozenAfter;
    for (ChainHold& hold : around.holds) changed |= update(hold, !whole);
    for (ChainTouch& touch : around.touches) changed |= update(touch, frozen);
    const bool runs = iterations_ < kStillAfter;
    if (whole) changed |= slides_.update(shape(), frozen, runs, around.slides);
    if (whole) changed |= knots_.update(shape(), frozen, runs, around.knots);
    if (asks) around.answer(around.slides);
  }
  const bool finite =
      std::all_of(next_.begin(), next_.end(), [](const Vector3d& position) { return position.allFinite(); });
  waits_ = !finite || (iterations_ == kMostIterations && waits_ < kMostWaits) ? waits_ + 1 : 0;
  if (waited()) return wait(around);
  slides_.end(shape(), around.slides);
  finish();
}

/// Handles a failed solution: the chain does not move, is at rest, and gives no impulses.
void Chain::wait(ChainAround& around) {
  next_ = x_;
  measureLinks();
  stop();
  around.slides = before_slides_;
  around.knots = before_knots_;
  for (ChainSlide& slide : around.slides) slide.impulse_ns = slide.torn_m = Vector3d::Zero();
  for (ChainKnot& knot : around.knots) knot.impulse_ns.setZero();
  for (ChainHold& hold : around.holds) hold.impulse_ns.setZero();
  for (ChainTouch& touch : around.touches) touch.impulse_ns.setZero();
  if (!around.slides.empty() && around.answer) around.answer(around.slides);
}

bool Chain::solved(const ChainAround& around) const {
  return worst_link_ < kLinkTolerance && slides_.farthestOff_m(shape(), around.slides) < kOff_m &&
         knots_.farthestOff_m(shape(), around.knots) < kOff_m;
}

void Chain::begin(const ChainAround& around) {
  for (size_t i = 0; i < x_.size(); ++i) {
    next_[i] = x_[i] + dt_s_ * v_[i];
    ahead_[i] = next_[i] + dt_s_ * dt_s_ * around.gravity_m_per_s2;
  }
}

/// Sets masses, drag and bending in the matrix and the residual.
void Chain::setBending() {
  const size_t n = x_.size();
  const double halfway = kMidpoint * dt_s_ * dt_s_, damped = material_.damping_s * dt_s_;
  const double stiff = bend_n_per_m_ * (halfway + damped), drag = material_.mass_damping_per_s * dt_s_;
  for (size_t i = 0; i < n; ++i) {
    bent_[i] = dt_s_ * dt_s_ * x_[i] + halfway * (next_[i] - ahead_[i]) + damped * (next_[i] - x_[i]);
  }
  for (size_t i = 0; i < n; ++i) {
    const size_t from_end = std::min(i, n - 1 - i);
    const double self = from_end == 0 ? 1 : from_end == 1 ? (n == 3 ? 4 : 5) : 6;
    const double next = from_end == 0 || i + 2 == n ? -2 : -4;
    matrix_.setNode(i, mass_kg(i) * (1 + drag) + stiff * self, i + 1 < n ? stiff * next : 0, i + 2 < n ? stiff : 0);
    rest_[i].position = mass_kg(i) * (ahead_[i] - next_[i] + drag * (x_[i] - next_[i]));
  }
  for (size_t i = 1; i + 1 < n; ++i) {
    const Vector3d force = bend_n_per_m_ * (bent_[i - 1] - 2 * bent_[i] + bent_[i + 1]);
    rest_[i - 1].position -= force;
    rest_[i].position += 2 * force;
    rest_[i + 1].position -= force;
  }
}

void Chain::measureLinks() {
  worst_link_ = 0;
  for (size_t i = 0; i < links_.size(); ++i) {
    const Vector3d link = next_[i + 1] - next_[i];
    const double length_m = link.norm();
    links_[i] = {link / length_m, length_m};
    worst_link_ = std::max(worst_link_, std::abs(length_m - link_m_));
  }
  worst_link_ /= link_m_;
}

/// Adds the links. A taut link resists rotation: without that no tension would follow a stylus.
void Chain::setLinks() {
  for (size_t i = 0; i < links_.size(); ++i) {
    const ChainLink& link = links_[i];
    matrix_.addLink(i, link.along, mu_[i] / link.length_m);
    rest_[i].position += mu_[i] * link.along;
    rest_[i + 1].position -= mu_[i] * link.along;
    rest_[i].tension = link_m_ - link.length_m;
  }
  rest_.back().tension = 0;
}

void Chain::setAround(const ChainAround& around) {
  const auto push = [&](uint32_t node, double share, const Vector3d& by) {
    rest_[node].position += (1 - share) * by;
    if (share > 0) rest_[node + 1].position += share * by;
  };
  for (const ChainLoad& load : around.loads) push(load.node, 0, dt_s_ * dt_s_ * load.force_n);
  for (const ChainHold& hold : around.holds) {
    matrix_.addPoint(hold.node, hold.share, hold.stiffness_kg, Vector3d::Zero());
    push(hold.node, hold.share, hold.stiffness_kg * (hold.to_m - point(hold.node, hold.share)));
  }
  slides_.set(shape(), around.slides, matrix_, rest_);
  knots_.set(shape(), around.knots, rest_);
  for (const ChainTouch& touch : around.touches) {
    if (!touch.closed) continue;
    matrix_.addPoint(touch.node, 0, touch.rub_kg, std::sqrt(touch.mass_kg - touch.rub_kg) * touch.normal);
    push(touch.node, 0, touch.mass_kg * depth_m(touch) * touch.normal - touch.rub_kg * slid(touch));
  }
}

/// Returns the slip along the border in the substep.
Vector3d Chain::slid(const ChainTouch& touch) const {
  const Vector3d offset = next_[touch.node] - x_[touch.node] - touch.moved_m;
  return offset - offset.dot(touch.normal) * touch.normal;
}

double Chain::depth_m(const ChainTouch& touch) const {
  return (touch.at_m - next_[touch.node]).dot(touch.normal) + material_.radius_m;
}

/// Takes a Newton step. @returns whether it was a whole step
bool Chain::advance(ChainAround& around) {
  matrix_.factor();
  matrix_.solve(rest_);
  if (!around.knots.empty()) knots_.solve(shape(), matrix_, around.knots, rest_);
  double turned = 0;
  for (size_t i = 0; i + 1 < x_.size(); ++i) {
    turned = std::max(turned, (rest_[i + 1].position - rest_[i].position).squaredNorm());
  }
  // No link turns by more than about a radian at once; tensions are always updated fully.
  const bool whole = turned <= link_m_ * link_m_;
  const double share = whole ? 1 : link_m_ / std::sqrt(turned);
  for (size_t i = 0; i < x_.size(); ++i) next_[i] += share * rest_[i].position;
  for (size_t i = 0; i < mu_.size(); ++i) mu_[i] += rest_[i].tension;
  return whole;
}

/// Updates a hold with the solution of the system. @returns whether it must be solved again
bool Chain::update(ChainHold& hold, bool frozen) const {
  const Vector3d off_m = point(hold.node, hold.share) - hold.to_m;
  hold.impulse_ns = hold.stiffness_kg / dt_s_ * off_m;
  if (frozen) return false;
  const double limit = hold.most_n * dt_s_ * dt_s_;
  const bool above = hold.stiffness_kg * off_m.norm() > kSlack * limit;
  hold.stiffness_kg = secant(limit, off_m.norm(), hold.mass_kg);
  return above;
}

/// Updates a touch. Friction waits until it is known which touches press: a node that has just entered is much too
/// deep.
bool Chain::update(ChainTouch& touch, bool frozen) const {
  const double in_m = depth_m(touch);
  const bool was_closed = touch.closed;
  touch.impulse_ns.setZero();
  if (was_closed) {
    const Vector3d along = slid(touch);
    touch.impulse_ns = (touch.rub_kg * along - touch.mass_kg * in_m * touch.normal) / dt_s_;
    if (frozen) return false;
    const double limit = touch.friction * touch.mass_kg * std::max(in_m, 0.0);
    const bool above = touch.rub_kg * along.norm() > kSlack * limit;
    touch.closed = in_m > 0;
    touch.rub_kg = secant(limit, along.norm(), touch.mass_kg);
    return above || !touch.closed;
  }
  touch.closed = in_m > 0;
  touch.rub_kg = 0;
  return touch.closed;
}

void Chain::finish() {
  for (size_t i = 0; i < x_.size(); ++i) v_[i] = (next_[i] - x_[i]) / dt_s_;
  x_ = next_;
  if (iterations_ == kMostIterations) stop();  // not converged: restarts from rest
}

}  // namespace viscera
