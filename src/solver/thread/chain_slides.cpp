// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/thread/chain_slides.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

constexpr double kApartLinks = 1;       // of two channels, whatever becomes of their tissue
constexpr double kApartRest = 0.4;      // of their distance in the tissue at rest
constexpr double kFromNeedle = 0.01;    // links
constexpr double kAtStop = 1e-6;        // links
constexpr double kMostLinks = 1;        // in an iteration: the next one's tangent is another
constexpr double kSlow_m_per_s = 1e-3;  // at which what was held begins to slide

bool tears(const ChainSlide& slide) {
  return slide.stiffness_kg < std::min(slide.mass_kg, kRigidMass_kg);
}

bool slips(const ChainSlide& slide) {
  return !tears(slide) && slide.rub_kg < std::min(slide.mass_kg, kRigidMass_kg);
}

double orRigid(double stiffness_kg, const ChainSlide& slide) {
  return stiffness_kg < slide.mass_kg ? stiffness_kg : kRigidMass_kg;
}

}  // namespace

void ChainSlides::begin(const ChainShape& shape, const std::array<bool, 2>& swaged, std::vector<ChainSlide>& slides) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const double last = static_cast<double>(shape.links.size());
  states_.assign(slides.size(), {swaged[0] ? kFromNeedle : -kFar, swaged[1] ? last - kFromNeedle : kFar});
  ChainSlide* before = nullptr;
  for (size_t k = 0; k < slides.size(); ++k) {
    ChainSlide& slide = slides[k];
    slide.torn_m.setZero();
    if (slide.out) {
      slide.impulse_ns.setZero();
      continue;
    }
    if (before) {
      const double apart = std::max(kApartLinks, kApartRest * before->between_rest_m / shape.link_m);
      const double middle = (before->s + slide.s) / 2;
      states_[static_cast<size_t>(before - slides.data())].high = middle - apart / 2;
      states_[k].low = middle + apart / 2;
    }
    before = &slide;
  }
  for (size_t k = 0; k < slides.size(); ++k) {  // what is nearer already goes no nearer
    states_[k].low = std::min(states_[k].low, slides[k].s);
    states_[k].high = std::max(states_[k].high, slides[k].s);
  }
}

/// Times dt: what the tissue gets where the chain is off by so much.
Vector3d ChainSlides::impulse(const ChainSlide& slide, const State& state, const Vector3d& off_m, double dt_s) const {
  if (tears(slide)) return slide.stiffness_kg * off_m;
  const Vector3d whole = dt_s * slide.impulse_ns + slide.mass_kg * off_m;
  if (!slips(slide)) return whole;
  const Vector3d& t = state.tangent;
  return whole + (slide.rub_kg * (state.slid_m + off_m.dot(t)) - whole.dot(t)) * t;
}

void ChainSlides::set(const ChainShape& shape, const std::vector<ChainSlide>& slides, ChainMatrix& matrix,
                      std::vector<ChainMatrix::Unknown>& rest) {
  for (size_t k = 0; k < slides.size(); ++k) {
    const ChainSlide& slide = slides[k];
    if (slide.out) continue;
    State& state = states_[k];
    const ChainPoint point(slide.s, shape.places_m.size());
    const ChainTurn turn(point, shape.links);
    state.tangent = turn.tangent;
    state.angle = turn.angle;
    state.along_link = turn.along_link;
    Matrix3d stiff = (tears(slide) ? slide.stiffness_kg : slide.mass_kg) * Matrix3d::Identity();
    if (slips(slide)) stiff -= (slide.mass_kg - slide.rub_kg) * turn.tangent * turn.tangent.transpose();
    matrix.addPoint(point.node, point.share, stiff);
    point.push(-impulse(slide, state, point.of(shape.places_m) - slide.to_m, shape.dt_s), rest);
  }
}

bool ChainSlides::heed(const ChainShape& shape, bool frozen, std::vector<ChainSlide>& slides) {
  bool again = false;
  for (size_t k = 0; k < slides.size(); ++k) {
    ChainSlide& slide = slides[k];
    if (slide.out) continue;
    State& state = states_[k];
    const Vector3d off_m = ChainPoint(slide.s, shape.places_m.size()).of(shape.places_m) - slide.to_m;
    slide.impulse_ns = impulse(slide, state, off_m, shape.dt_s) / shape.dt_s;
    const bool slid = slips(slide);
    if (!frozen) again |= change(shape, off_m, slide, state);
    if (slid) again |= moveAlong(shape, off_m.dot(state.tangent), frozen, slide, state);
  }
  return again;
}

/// From holding to sliding to tearing and back, by what it has just been found to need.
bool ChainSlides::change(const ChainShape& shape, const Vector3d& off_m, ChainSlide& slide, State& state) const {
  const double dt2 = shape.dt_s * shape.dt_s, most = dt2 * slide.most_n;
  const Vector3d all = shape.dt_s * slide.impulse_ns;
  const double size = all.norm();
  if (tears(slide)) {
    slide.stiffness_kg = orRigid(secant(most, off_m.norm(), slide.mass_kg), slide);
    return size > kSlack * most;
  }
  if (size > most) {
    slide.stiffness_kg =
        orRigid(secant(most, std::max(off_m.norm(), (size - most) / slide.mass_kg), slide.mass_kg), slide);
    return true;
  }
  const double along = all.dot(state.tangent), across = (all - along * state.tangent).norm();
  const double limit = dt2 * slide.through_n + capstan(slide.friction, state.angle) * across;
  if (!slips(slide)) {
    const double over = std::abs(along) - limit;
    const double edge = along > 0 ? slide.s - state.low : state.high - slide.s;
    if (over <= 0 || edge < kAtStop) return false;
    slide.rub_kg = secant(limit, std::max(kSlow_m_per_s * shape.dt_s, over / slide.mass_kg), slide.mass_kg);
    return std::abs(along) > kSlack * limit;
  }
  slide.rub_kg = orRigid(secant(limit, std::abs(state.slid_m + off_m.dot(state.tangent)), slide.mass_kg), slide);
  return std::abs(along) > kSlack * limit || (slips(slide) && kSlack * std::abs(along) < limit);
}

/// The point goes where the chain has slid to: at a sharp turn, farther along its bisector than along the chain.
/// @returns whether something stops it
bool ChainSlides::moveAlong(const ChainShape& shape, double by_m, bool frozen, ChainSlide& slide, State& state) const {
  const double link_m = shape.link_m / state.along_link, last = static_cast<double>(shape.links.size());
  const double wanted = slide.s - std::clamp(by_m / link_m, -kMostLinks, kMostLinks);
  const double to = std::clamp(wanted, state.low, state.high);
  slide.out = to < 0 || to > last;
  const double s = std::clamp(to, 0.0, last);
  state.slid_m += (slide.s - s) * link_m;
  slide.s = s;
  if (to == wanted || frozen) return false;
  slide.rub_kg = kRigidMass_kg;
  return true;
}

double ChainSlides::farthestOff_m(const ChainShape& shape, const std::vector<ChainSlide>& slides) const {
  double out = 0;
  for (size_t k = 0; k < slides.size(); ++k) {
    const ChainSlide& slide = slides[k];
    if (slide.out || tears(slide)) continue;
    Vector3d off_m = ChainPoint(slide.s, shape.places_m.size()).of(shape.places_m) - slide.to_m;
    if (slips(slide)) off_m -= off_m.dot(states_[k].tangent) * states_[k].tangent;
    out = std::max(out, off_m.norm());
  }
  return out;
}

void ChainSlides::end(const ChainShape& shape, std::vector<ChainSlide>& slides) const {
  for (ChainSlide& slide : slides) {
    if (!slide.out && tears(slide))
      slide.torn_m = ChainPoint(slide.s, shape.places_m.size()).of(shape.places_m) - slide.to_m;
  }
}

}  // namespace viscera
