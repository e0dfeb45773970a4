// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/chain/chain_knots.h"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>

#include "solver/processes/suture/chain/chain_slides.h"

namespace viscera {

namespace {

constexpr double kLoopLinks = 2;  // links of the smallest loop

/// Returns the vector from s1 to s2, in addition to apart_m.
Vector3d offOf(const ChainKnot& knot, const std::vector<Vector3d>& positions) {
  return ChainPoint(knot.s2, positions.size()).of(positions) - ChainPoint(knot.s1, positions.size()).of(positions) -
         knot.apart_m;
}

Vector3d offOf(const ChainKnot& knot, const std::vector<ChainMatrix::Unknown>& found) {
  const ChainPoint one(knot.s1, found.size()), two(knot.s2, found.size());
  const auto at = [&](const ChainPoint& point) -> Vector3d {
    return (1 - point.share) * found[point.node].position + point.share * found[point.node + 1].position;
  };
  return at(two) - at(one);
}

void push(const ChainKnot& knot, const Vector3d& by, std::vector<ChainMatrix::Unknown>& rest) {
  ChainPoint(knot.s1, rest.size()).push(by, rest);
  ChainPoint(knot.s2, rest.size()).push(-by, rest);
}

bool runsAlong(const ChainKnot& knot) {
  return slips(knot.rub_kg, kRigidMass_kg);
}

}  // namespace

void ChainKnots::begin(const std::vector<ChainSlide>& slides, const ChainShape& shape, std::vector<ChainKnot>& knots) {
  assert(knots.size() <= kMostKnots);
  const size_t rows = 3 * knots.size();
  while (borders_.size() < rows) borders_.emplace_back(shape.positions_m.size());
  for (size_t k = 0; k < knots.size(); ++k) {
    ChainKnot& knot = knots[k];
    runs_[k] = {};
    if (knot.out) continue;
    runs_[k].stopAt(knot.s1, kLoopLinks, false, knot.s2);
    for (const ChainSlide& slide : slides) {
      if (!slide.out) runs_[k].stopAt(slide.s, kKnotApart, true, knot.s2);
    }
    for (size_t j = 0; j < knots.size(); ++j) {
      if (j == k || knots[j].out) continue;
      runs_[k].stopAt(knots[j].s1, kKnotApart, false, knot.s2);
      runs_[k].stopAt(knots[j].s2, kKnotApart, true, knot.s2);
    }
  }
}

void ChainKnots::set(const ChainShape& shape, const std::vector<ChainKnot>& knots,
                     std::vector<ChainMatrix::Unknown>& rest) {
  for (size_t k = 0; k < knots.size(); ++k) {
    if (knots[k].out) continue;
    runs_[k].turn = ChainTurn(ChainPoint(knots[k].s2, shape.positions_m.size()), shape.links);
    push(knots[k], shape.dt_s * knots[k].impulse_ns, rest);
  }
}

/// A holding knot joins the two points in all directions. A sliding one joins them across the tangent, with friction
/// along it.
void ChainKnots::solve(const ChainShape& shape, const ChainMatrix& matrix, std::vector<ChainKnot>& knots,
                       std::vector<ChainMatrix::Unknown>& found) {
  const auto rows = static_cast<Eigen::Index>(3 * knots.size());
  Small gives = Small::Zero(rows, rows), system(rows, rows);
  Column off(rows), right(rows);
  for (size_t k = 0; k < knots.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<ChainMatrix::Unknown>& border = borders_[3 * k + static_cast<size_t>(axis)];
      border.assign(found.size(), {});
      push(knots[k], Vector3d::Unit(axis), border);
      matrix.solve(border);
      for (size_t j = 0; j < knots.size(); ++j) {
        gives.block<3, 1>(3 * static_cast<Eigen::Index>(j), 3 * static_cast<Eigen::Index>(k) + axis) =
            -offOf(knots[j], border);
      }
    }
    off.segment<3>(3 * static_cast<Eigen::Index>(k)) = offOf(knots[k], shape.positions_m) + offOf(knots[k], found);
  }
  gives.diagonal().array() += 1 / kRigidMass_kg;
  for (size_t k = 0; k < knots.size(); ++k) {
    const ChainKnot& knot = knots[k];
    const auto at = 3 * static_cast<Eigen::Index>(k);
    auto lines = system.middleRows<3>(at);
    lines = gives.middleRows<3>(at);
    right.segment<3>(at) = off.segment<3>(at);
    if (knot.out) {
      lines.setZero();
      lines.middleCols<3>(at).setIdentity();
      right.segment<3>(at).setZero();
    } else if (runsAlong(knot)) {
      const Vector3d& t = runs_[k].turn.tangent;
      const double scale = gives.block<3, 3>(at, at).trace(), weight = scale / (1 + knot.rub_kg * scale);
      const auto along = (t.transpose() * lines).eval();
      lines += t * ((weight * knot.rub_kg - 1) * along);
      lines.middleCols<3>(at) += weight * t * t.transpose();
      const double rubs = knot.rub_kg * (runs_[k].slid_m + off.segment<3>(at).dot(t));
      right.segment<3>(at) += (weight * (rubs - shape.dt_s * knot.impulse_ns.dot(t)) - off.segment<3>(at).dot(t)) * t;
    }
  }
  const Column more = system.partialPivLu().solve(right);
  for (size_t k = 0; k < knots.size(); ++k) {
    const Vector3d by = more.segment<3>(3 * static_cast<Eigen::Index>(k));
    knots[k].impulse_ns += by / shape.dt_s;
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<ChainMatrix::Unknown>& border = borders_[3 * k + static_cast<size_t>(axis)];
      for (size_t i = 0; i < found.size(); ++i) {
        found[i].position += by[axis] * border[i].position;
        found[i].tension += by[axis] * border[i].tension;
      }
    }
  }
}

bool ChainKnots::update(const ChainShape& shape, bool frozen, bool runs, std::vector<ChainKnot>& knots) {
  bool again = false;
  for (size_t k = 0; k < knots.size(); ++k) {
    ChainKnot& knot = knots[k];
    if (knot.out) continue;
    ChainRun& run = runs_[k];
    const double off_m = offOf(knot, shape.positions_m).dot(run.turn.tangent);
    const double along = shape.dt_s * knot.impulse_ns.dot(run.turn.tangent);
    const double limit_n = (knot.tied ? knot.holds_n : knot.friction_n) * run.turn.alongBisector();
    const double limit = shape.dt_s * shape.dt_s * limit_n;
    const bool ran = runsAlong(knot);
    if (!frozen) again |= run.rub(shape, along, limit, off_m, kRigidMass_kg, knot.s2, knot.rub_kg);
    if (!ran || !runs || !run.follow(shape, off_m, knot.s2, knot.out) || frozen) continue;
    knot.rub_kg = kRigidMass_kg;
    again = true;
  }
  return again;
}

double ChainKnots::farthestOff_m(const ChainShape& shape, const std::vector<ChainKnot>& knots) const {
  double out = 0;
  for (size_t k = 0; k < knots.size(); ++k) {
    if (knots[k].out) continue;
    const Vector3d off_m = offOf(knots[k], shape.positions_m), &t = runs_[k].turn.tangent;
    out = std::max(out, runsAlong(knots[k]) ? (off_m - off_m.dot(t) * t).norm() : off_m.norm());
  }
  return out;
}

}  // namespace viscera
