// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/suture_knots.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "math/archive.h"
#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr double kStrength_pa = 2e8;     // 5.9 N of USP 4-0, 14 N of 2-0: 245 and 175 MPa of their cross-sections
constexpr double kClose_m_per_s = 0.05;  // of tails that are brought together
constexpr double kDraw_m_per_s = 0.02;   // of a loop that is drawn tight
constexpr double kCheckEvery_s = 0.05;   // interval of the checks whether it still shrinks
constexpr double kTight = 0.25;          // of that speed: a slower loop counts as tight
constexpr double kLeastLoop = 2.5;       // links
constexpr double kFromSkin = 0.5;        // of the distance of two channels: initial position of a knot behind each
constexpr double kLeastReach = 1.5;      // links
constexpr double kWithoutTracks = 0.4;   // share of the suture that is tail at either end
constexpr double kPulled_n = 2e-3;       // of both tails, to pull a throw down: loops of some mm bend at that
constexpr double kKnotAhead = 0.25;      // of two styluses' distance: nearer ahead of the tails' roots there is no axis
constexpr double kNear_m = 1e-3;         // styluses nearer to each other, or to the roots, define no angle
constexpr double kMoreThrows = 0.5;      // of the force that two throws hold, for each additional one

struct Tails {
  double low, high;  // roots, on the chain
  bool tracks = false;
};

Tails tailsOf(const Chain& chain, const ChainAround& around) {
  const auto links = static_cast<double>(chain.nodes() - 1);
  Tails out{kWithoutTracks * links, (1 - kWithoutTracks) * links};
  for (const ChainSlide& slide : around.slides) {
    if (slide.out) continue;
    out.low = out.tracks ? std::min(out.low, slide.s) : slide.s;
    out.high = out.tracks ? std::max(out.high, slide.s) : slide.s;
    out.tracks = true;
  }
  for (const ChainKnot& knot : around.knots) {
    if (knot.out) continue;
    out.low = std::min({out.low, knot.s1, knot.s2});
    out.high = std::max({out.high, knot.s1, knot.s2});
  }
  return out;
}

struct Nearest {
  double s1 = 0, s2 = 0;  // on the tail at the end, and on that at the start
  double distance_m = std::numeric_limits<double>::infinity();
};

Nearest nearestOf(const Chain& chain, const Tails& tails) {
  const std::vector<Vector3d>& x = chain.positions_m();
  Nearest out;
  for (auto i = static_cast<size_t>(std::ceil(tails.high)) + 1; i + 2 < x.size(); ++i) {
    for (size_t j = 2; j + 1 < static_cast<size_t>(tails.low); ++j) {
      const double distance_m = (x[i] - x[j]).norm();
      if (distance_m < out.distance_m) out = {static_cast<double>(i), static_cast<double>(j), distance_m};
    }
  }
  return out;
}

Vector3d apartOf(const Chain& chain, const ChainKnot& knot) {
  const std::vector<Vector3d>& x = chain.positions_m();
  return ChainPoint(knot.s2, x.size()).of(x) - ChainPoint(knot.s1, x.size()).of(x);
}

Vector3d rootOf(const Chain& chain, const Tails& tails) {
  const std::vector<Vector3d>& x = chain.positions_m();
  return 0.5 * (ChainPoint(tails.low, x.size()).of(x) + ChainPoint(tails.high, x.size()).of(x));
}

bool tailsPull(const Chain& chain, const ChainAround& around) {
  const Tails tails = tailsOf(chain, around);
  const auto low = static_cast<size_t>(tails.low), high = static_cast<size_t>(std::ceil(tails.high));
  return low > 0 && high + 1 < chain.nodes() && std::min(chain.tension_n(low - 1), chain.tension_n(high)) > kPulled_n;
}

void requireRoom(const ChainAround& around) {
  if (around.knots.size() >= kMostKnots)
    throw Error("it has " + std::to_string(kMostKnots) + " knots, the maximum for a suture");
}

double apart_m(const Chain& chain, double one, double other) {
  const std::vector<Vector3d>& x = chain.positions_m();
  return (ChainPoint(other, x.size()).of(x) - ChainPoint(one, x.size()).of(x)).norm();
}

void requireTail(const char* which, double s, double has, double wanted, double link_m) {
  if (s >= 1) return;
  throw Error(std::string("its tail at the ") + which + " is " + numberText(1e3 * has * link_m) +
              " mm long; at least " + numberText(1e3 * wanted * link_m) + " mm are needed");
}

ChainKnot aboveTracks(const Chain& chain, const ChainAround& around, const Tails& tails) {
  const auto last = static_cast<double>(chain.nodes() - 1);
  const double across = apart_m(chain, tails.high, tails.low) / chain.link_m();
  const double reach = std::max(kLeastReach, around.knots.empty() ? kFromSkin * across : kLeastReach);
  ChainKnot out;
  out.s1 = tails.high + reach;
  out.s2 = tails.low - reach;
  requireTail("start", out.s2, tails.low, reach + 1, chain.link_m());
  requireTail("end", last - out.s1, last - tails.high, reach + 1, chain.link_m());
  return out;
}

ChainKnot whereNearest(const Chain& chain, const Tails& tails) {
  const Nearest nearest = nearestOf(chain, tails);
  if (!std::isfinite(nearest.distance_m))
    throw Error("it has " + std::to_string(chain.nodes()) + " nodes, too few for a knot");
  ChainKnot out;
  out.s1 = nearest.s1;
  out.s2 = nearest.s2;
  return out;
}

/// Returns the position on the strand between the outer channels, outside tissue, nearest to a point; 0: none.
double strandNearest(const Vector3d& position_m, const Chain& chain, const ChainAround& around, const Tails& tails,
                     const std::function<bool(double s)>& hidden) {
  double out = 0, least_m = std::numeric_limits<double>::infinity();
  for (auto i = static_cast<size_t>(std::ceil(tails.low)); static_cast<double>(i) < tails.high; ++i) {
    const auto s = static_cast<double>(i);
    const double distance_m = (chain.positions_m()[i] - position_m).norm();
    const bool taken = std::any_of(around.slides.begin(), around.slides.end(), [s](const ChainSlide& slide) {
      return !slide.out && std::abs(slide.s - s) < kKnotApart;
    });
    if (taken || distance_m >= least_m || hidden(s)) continue;
    out = s;
    least_m = distance_m;
  }
  return out;
}

/// Returns a knot that brings the tail nearer along the chain to the strand.
ChainKnot toStrand(const Vector3d& position_m, const Chain& chain, const ChainAround& around, const Tails& tails,
                   const std::function<bool(double s)>& hidden) {
  ChainKnot out;
  out.s1 = tails.tracks ? strandNearest(position_m, chain, around, tails, hidden) : 0;
  if (!(out.s1 > 0)) throw Error("it has no strand between two of its channels and outside of tissue");
  const bool start = out.s1 - tails.low < tails.high - out.s1;
  const double root = start ? tails.low : tails.high, last = static_cast<double>(chain.nodes() - 1);
  const double reach = std::max(kLeastReach, apart_m(chain, root, out.s1) / chain.link_m());
  out.s2 = start ? root - reach : root + reach;
  requireTail(start ? "start" : "end", start ? out.s2 : last - out.s2, start ? root : last - root, reach + 1,
              chain.link_m());
  return out;
}

}  // namespace

double knotStrength(double radius_m) {
  return kStrength_pa * M_PI * radius_m * radius_m;
}

/// The shares are estimates of the right order: 3 throws of USP 1 hold 14.7 N of about 40, a granny knot slips.
double knotHolds(KnotKind kind, uint32_t throws, double strength_n) {
  constexpr double kShares[] = {0, 0.02, 0.1, 0.35, 0.15, 0.6, 0.3};
  const double more = 1 + kMoreThrows * (throws > 2 ? throws - 2 : 0);
  return strength_n * std::min(1.0, more * kShares[static_cast<size_t>(kind)]);
}

void SutureKnots::tie(const SutureTie& tie, const Chain& chain, const std::function<bool(double s)>& hidden,
                      ChainAround& around) {
  requireRoom(around);
  const Tails tails = tailsOf(chain, around);
  ChainKnot knot;
  if (tie.to == TieTo::kStrand)
    knot = toStrand(tie.strand_m, chain, around, tails, hidden);
  else
    knot = tails.tracks || !around.knots.empty() ? aboveTracks(chain, around, tails) : whereNearest(chain, tails);
  knot.apart_m = apartOf(chain, knot);
  knot.tied = true;
  knot.holds_n = tie.tension_n;
  ThrownKnot thrown;
  thrown.kind = tie.knot;
  thrown.drawn = true;
  thrown.holds_n = tie.holds_n > 0 ? tie.holds_n : knotHolds(tie.knot, 0, knotStrength(chain.material().radius_m));
  thrown.checked_position = knot.s2;
  around.knots.push_back(knot);
  thrown_.push_back(thrown);
}

void SutureKnots::beginSubstep(double dt_s, const Chain& chain, ChainAround& around) {
  clean(around);
  pulled_ = pulled_ || tailsPull(chain, around);
  for (size_t k = 0; k < thrown_.size(); ++k) {
    ChainKnot& knot = around.knots[k];
    const double apart_m = knot.apart_m.norm(), closed_m = kClose_m_per_s * dt_s;
    if (apart_m > closed_m) {
      knot.apart_m *= 1 - closed_m / apart_m;
      continue;
    }
    knot.apart_m.setZero();
    if (thrown_[k].drawn) draw(thrown_[k], knot, dt_s, chain.link_m(), around);
  }
}

/// Moves s2 towards the loop, and lets it slip back when the loop reaches its tension.
void SutureKnots::draw(ThrownKnot& thrown, ChainKnot& knot, double dt_s, double link_m,
                       const ChainAround& around) const {
  const double offset = knot.s1 > knot.s2 ? 1 : -1, step = kDraw_m_per_s * dt_s / link_m;
  double free = std::abs(knot.s1 - knot.s2) - kLeastLoop;
  for (const ChainSlide& slide : around.slides) {
    const double ahead = offset * (slide.s - knot.s2);
    if (!slide.out && ahead > 0) free = std::min(free, ahead - 2 * kKnotApart);
  }
  knot.s2 += offset * std::clamp(free, 0.0, step);
  thrown.looked_s += dt_s;
  if (thrown.looked_s < kCheckEvery_s) return;
  const double gone = offset * (knot.s2 - thrown.checked_position) * link_m;
  thrown.drawn = gone > kTight * kDraw_m_per_s * thrown.looked_s;
  thrown.looked_s = 0;
  thrown.checked_position = knot.s2;
  if (!thrown.drawn) knot.holds_n = thrown.holds_n;
}

void SutureKnots::countThrows(const Chain& chain, const std::vector<uint32_t>& held, ChainAround& around) {
  const bool pulled = std::exchange(pulled_, false);
  const Tails tails = tailsOf(chain, around);
  const Vector3d *first = nullptr, *second = nullptr;
  for (const uint32_t node : held) {
    const Vector3d& position_m = chain.positions_m()[node];
    if (node < tails.low) first = &position_m;
    if (node > tails.high) second = &position_m;
  }
  if (!first || !second) {
    apart_m_.setZero();
    turns_ = 0;
    return;
  }
  const int turns = throwOf(turns_);
  if (pulled && turns != 0) {
    addThrow(turns, chain, around);
    turns_ -= turns;  // turns made while the tails are pulled belong to this throw, not to the next
  }
  turnGrips(rootOf(chain, tails), *first, *second);
}

/// Adds the rotation of the vector between styluses about the axis from the tails' roots to their midpoint.
void SutureKnots::turnGrips(const Vector3d& root_m, const Vector3d& first_m, const Vector3d& second_m) {
  const Vector3d ahead_m = 0.5 * (first_m + second_m) - root_m, apart_m = second_m - first_m;
  const double ahead = ahead_m.norm();
  if (ahead < kKnotAhead * apart_m.norm() || ahead < kNear_m) return;  // pulled apart: there is no axis
  const Vector3d axis = ahead_m / ahead, across_m = apart_m - apart_m.dot(axis) * axis;
  const Vector3d before_m = apart_m_ - apart_m_.dot(axis) * axis;
  if (across_m.norm() < kNear_m) return;
  apart_m_ = apart_m;
  if (before_m.norm() < kNear_m) return;
  turns_ += std::atan2(axis.dot(before_m.cross(across_m)), before_m.dot(across_m)) / (2 * M_PI);
}

void SutureKnots::addThrow(int turns, const Chain& chain, ChainAround& around) {
  const double strength_n = knotStrength(chain.material().radius_m);
  if (thrown_.empty() || thrown_.back().throws == 0 || thrown_.back().throws == ThrownKnot::kMostThrows) {
    if (around.knots.size() >= kMostKnots) return;
    const Nearest nearest = nearestOf(chain, tailsOf(chain, around));
    if (!std::isfinite(nearest.distance_m)) return;
    ChainKnot knot;
    knot.s1 = nearest.s1;
    knot.s2 = nearest.s2;
    knot.apart_m = apartOf(chain, knot);
    around.knots.push_back(knot);
    thrown_.emplace_back();
  }
  ThrownKnot& thrown = thrown_.back();
  ChainKnot& knot = around.knots.back();
  thrown.turns[thrown.throws++] = static_cast<int8_t>(turns);
  thrown.kind = kindOf(std::vector<int>(thrown.turns.begin(), thrown.turns.begin() + thrown.throws));
  thrown.holds_n = knotHolds(thrown.kind, thrown.throws, strength_n);
  knot.friction_n = thrown.holds_n;
  knot.tied = thrown.throws > 1;
  if (knot.tied) knot.holds_n = thrown.holds_n;
}

void SutureKnots::clean(ChainAround& around) {
  for (size_t k = thrown_.size(); k-- > 0;) {
    if (!around.knots[k].out) continue;
    around.knots.erase(around.knots.begin() + static_cast<std::ptrdiff_t>(k));
    thrown_.erase(thrown_.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

SutureKnots SutureKnots::part(double at, const ChainAround& around) {
  SutureKnots behind;
  std::vector<ThrownKnot> before;
  for (size_t k = 0; k < thrown_.size(); ++k) {
    const ChainKnot& knot = around.knots[k];
    if ((knot.s1 > at) != (knot.s2 > at)) continue;  // its loop is open
    (knot.s1 > at ? behind.thrown_ : before).push_back(thrown_[k]);
    if (knot.s1 > at) behind.thrown_.back().checked_position -= at;
  }
  thrown_ = std::move(before);
  return behind;
}

void SutureKnots::persist(Archive& archive) {
  archive.list(thrown_);
  archive.value(turns_);
  archive.value(apart_m_);
  uint8_t pulled = pulled_ ? 1 : 0;
  archive.value(pulled);
  pulled_ = pulled != 0;
}

}  // namespace viscera
