// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/chain/chain_slides.h"

#include <algorithm>

namespace viscera {

namespace {

constexpr double kApartLinks = 1;     // of two channels, regardless of their tissue
constexpr double kApartRest = 0.4;    // of their distance in the tissue at rest
constexpr double kFromNeedle = 0.01;  // links

bool tears(const ChainSlide& slide) {
  return slips(slide.stiffness_kg, slide.mass_kg);
}

/// Returns the effective stiffness. On a needle's suture it is that of chain and tissue in series, as the tissue moves
/// back when its impulse decreases: the chain stays where the needle is.
double yields(const ChainSlide& slide, const ChainRun& run, double stiffness_kg) {
  return run.on_needle ? stiffness_kg / (1 + stiffness_kg / slide.mass_kg) : stiffness_kg;
}

bool runsAlong(const ChainSlide& slide) {
  return !tears(slide) && slips(slide.rub_kg, slide.mass_kg);
}

}  // namespace

void ChainSlides::begin(const ChainShape& shape, const std::array<bool, 2>& swaged, const std::vector<ChainKnot>& knots,
                        std::vector<ChainSlide>& slides) {
  runs_.assign(slides.size(), {});
  size_t before = slides.size();
  for (size_t k = 0; k < slides.size(); ++k) {
    ChainSlide& slide = slides[k];
    slide.torn_m.setZero();
    if (slide.out) {
      slide.impulse_ns.setZero();
      continue;
    }
    runs_[k].on_needle = swaged[0] || swaged[1];
    if (runs_[k].on_needle) slide.impulse_ns.setZero();  // not yet applied to the tissue
    if (before < slides.size()) {
      const double apart = std::max(kApartLinks, kApartRest * slides[before].between_rest_m / shape.link_m);
      runs_[before].stopAt(slide.s, apart, true, slides[before].s);
      runs_[k].stopAt(slides[before].s, apart, true, slide.s);
    }
    before = k;
    if (swaged[0]) runs_[k].stopAt(0, kFromNeedle, false, slide.s);
    if (swaged[1]) runs_[k].stopAt(static_cast<double>(shape.links.size()), kFromNeedle, false, slide.s);
    for (const ChainKnot& knot : knots) {
      if (knot.out) continue;
      runs_[k].stopAt(knot.s1, kKnotApart, false, slide.s);
      runs_[k].stopAt(knot.s2, kKnotApart, true, slide.s);
    }
  }
}

/// Returns the impulse on the tissue times dt for an offset of the chain.
Vector3d ChainSlides::impulse(const ChainSlide& slide, const ChainRun& run, const Vector3d& off_m, double dt_s) const {
  const Vector3d given = run.on_needle ? Vector3d(dt_s * slide.impulse_ns / slide.mass_kg) : Vector3d::Zero();
  if (tears(slide)) return yields(slide, run, slide.stiffness_kg) * (off_m + given);
  const Vector3d whole = dt_s * slide.impulse_ns + slide.mass_kg * off_m;
  if (!slips(slide.rub_kg, slide.mass_kg)) return whole;
  const Vector3d& t = run.turn.tangent;
  return whole + (yields(slide, run, slide.rub_kg) * (run.slid_m + (off_m + given).dot(t)) - whole.dot(t)) * t;
}

void ChainSlides::set(const ChainShape& shape, const std::vector<ChainSlide>& slides, ChainMatrix& matrix,
                      std::vector<ChainMatrix::Unknown>& rest) {
  for (size_t k = 0; k < slides.size(); ++k) {
    const ChainSlide& slide = slides[k];
    if (slide.out) continue;
    const ChainPoint point(slide.s, shape.positions_m.size());
    runs_[k].turn = ChainTurn(point, shape.links);
    const Vector3d& t = runs_[k].turn.tangent;
    Matrix3d stiff =
        (tears(slide) ? yields(slide, runs_[k], slide.stiffness_kg) : slide.mass_kg) * Matrix3d::Identity();
    if (runsAlong(slide)) stiff -= (slide.mass_kg - yields(slide, runs_[k], slide.rub_kg)) * t * t.transpose();
    matrix.addPoint(point.node, point.share, stiff);
    point.push(-impulse(slide, runs_[k], point.of(shape.positions_m) - slide.to_m, shape.dt_s), rest);
  }
}

bool ChainSlides::update(const ChainShape& shape, bool frozen, bool runs, std::vector<ChainSlide>& slides) {
  bool again = false;
  for (size_t k = 0; k < slides.size(); ++k) {
    ChainSlide& slide = slides[k];
    if (slide.out) continue;
    ChainRun& run = runs_[k];
    Vector3d off_m = ChainPoint(slide.s, shape.positions_m.size()).of(shape.positions_m) - slide.to_m;
    const Vector3d before_ns = slide.impulse_ns;
    slide.impulse_ns = impulse(slide, run, off_m, shape.dt_s) / shape.dt_s;
    if (run.on_needle) off_m += shape.dt_s * (before_ns - slide.impulse_ns) / slide.mass_kg;
    const bool along = runsAlong(slide);
    if (!frozen) again |= change(shape, off_m, slide, run);
    if (!along || !runs || !run.follow(shape, off_m.dot(run.turn.tangent), slide.s, slide.out) || frozen) continue;
    slide.rub_kg = kRigidMass_kg;
    again = true;
  }
  return again;
}

/// Switches between holding, sliding and tearing, by the impulse just found to be needed.
bool ChainSlides::change(const ChainShape& shape, const Vector3d& off_m, ChainSlide& slide, const ChainRun& run) const {
  const double dt2 = shape.dt_s * shape.dt_s, most = dt2 * slide.most_n, mass_kg = slide.mass_kg;
  const Vector3d all = shape.dt_s * slide.impulse_ns;
  const double size = all.norm();
  if (tears(slide)) {
    slide.stiffness_kg = orRigid(secant(most, off_m.norm(), mass_kg), mass_kg);
    return size > kSlack * most;
  }
  if (size > most) {
    slide.stiffness_kg = orRigid(secant(most, std::max(off_m.norm(), (size - most) / mass_kg), mass_kg), mass_kg);
    return true;
  }
  const Vector3d& t = run.turn.tangent;
  const double along = all.dot(t), across = (all - along * t).norm();
  const double limit =
      dt2 * slide.through_n * run.turn.alongBisector() + capstan(slide.friction, run.turn.angle) * across;
  return run.rub(shape, along, limit, off_m.dot(t), mass_kg, slide.s, slide.rub_kg);
}

double ChainSlides::farthestOff_m(const ChainShape& shape, const std::vector<ChainSlide>& slides) const {
  double out = 0;
  for (size_t k = 0; k < slides.size(); ++k) {
    const ChainSlide& slide = slides[k];
    if (slide.out || tears(slide)) continue;
    Vector3d off_m = ChainPoint(slide.s, shape.positions_m.size()).of(shape.positions_m) - slide.to_m;
    if (runsAlong(slide)) off_m -= off_m.dot(runs_[k].turn.tangent) * runs_[k].turn.tangent;
    out = std::max(out, off_m.norm());
  }
  return out;
}

void ChainSlides::end(const ChainShape& shape, std::vector<ChainSlide>& slides) const {
  for (ChainSlide& slide : slides) {
    if (!slide.out && tears(slide))
      slide.torn_m = ChainPoint(slide.s, shape.positions_m.size()).of(shape.positions_m) - slide.to_m;
  }
}

}  // namespace viscera
