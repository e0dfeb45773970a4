// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/rest_elements.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace viscera {

namespace {

constexpr double kBeyond = 0.05;      // of the spacing: still tissue if no farther outside the elements
constexpr double kBesideSheet = 0.5;  // of the spacing: to both sides of a sheet
constexpr int kBesideCut = 2;         // rings of cubes in which a whole element is searched for
constexpr int kNearestRings = 3;
constexpr double kWholeSpring = -1;
constexpr double kUnknownShare = 0.5;  // of a cut spring without a recorded position of the cut

double spacingOf_m(const Body& body) {
  return body.hasCells() ? body.lattice.spacing_m : body.network->meanLength();
}

uint32_t cornersOf(const Body& body) {
  return body.hasCells() ? 8 : 3;
}

bool anyElement(uint32_t) {
  return true;
}

Vector3i floored(const Vector3d& v) {
  return v.array().floor().cast<int>();
}

}  // namespace

TissuePoint nodePoint(const Model& model, uint32_t body, uint32_t slot) {
  TissuePoint out;
  out.body = body;
  out.count = 1;
  out.slots[0] = model.slotOffset(body) + slot;
  out.weights[0] = 1;
  out.rest_m = restPosition(model.bodies[body], slot);
  return out;
}

bool RestElements::Fit::isNearerThan(const Fit& other) const {
  const double here_m = std::max(outside_m, 0.0), there_m = std::max(other.outside_m, 0.0);
  return here_m != there_m ? here_m < there_m : off_m < other.off_m;
}

RestElements::RestElements(const Model& model, uint32_t body, uint32_t first_spring)
    : body_(model.bodies[body]),
      number_(body),
      slot_offset_(model.slotOffset(body)),
      first_spring_(first_spring),
      count_(cornersOf(body_)) {
  collect();
  sortIntoCubes();
}

void RestElements::collect() {
  const auto add = [this](const auto& slots) {
    corners_.emplace_back();
    std::copy(slots.begin(), slots.end(), corners_.back().begin());
  };
  if (!body_.hasCells()) {
    std::for_each(body_.network->triangles.begin(), body_.network->triangles.end(), add);
    return;
  }
  for (const uint32_t slot : body_.lattice.active_slots) {
    if (!(body_.lattice.nodes[slot].lo & layout::kCellBit)) continue;
    Corners corners{};
    forEachCorner(body_.lattice, slot,
                  [&, c = size_t{0}](const Vector3i&, uint32_t corner) mutable { corners[c++] = corner; });
    corners_.push_back(corners);
  }
}

void RestElements::sortIntoCubes() {
  Eigen::AlignedBox3d all;
  std::vector<Eigen::AlignedBox3d> boxes(corners_.size());
  const double h = spacingOf_m(body_);
  const Vector3d reach = Vector3d::Constant((count_ == 3 ? kBesideSheet : kBeyond) * h);
  for (uint32_t e = 0; e < corners_.size(); ++e) {
    for (uint32_t c = 0; c < count_; ++c) boxes[e].extend(corner_m(e, c));
    boxes[e] = {boxes[e].min() - reach, boxes[e].max() + reach};
    all.extend(boxes[e]);
  }
  if (boxes.empty()) all.extend(Vector3d(Vector3d::Zero()));
  cubes_ = {h, all.min(), floored(all.sizes() / h) + Vector3i::Ones()};
  const auto forEachCube = [this](const Eigen::AlignedBox3d& box, const auto& visit) {
    const Vector3i low = cubeOf(box.min()), high = cubeOf(box.max());
    for (int z = low.z(); z <= high.z(); ++z) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int x = low.x(); x <= high.x(); ++x) visit(cubes_.at({x, y, z}));
      }
    }
  };
  starts_.assign(cubes_.positions() + 1, 0);
  for (const Eigen::AlignedBox3d& box : boxes) forEachCube(box, [this](size_t cube) { ++starts_[cube + 1]; });
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
  sorted_.resize(starts_.back());
  for (uint32_t e = 0; e < boxes.size(); ++e) forEachCube(boxes[e], [&](size_t cube) { sorted_[next[cube]++] = e; });
}

/// Returns the nearest cube.
Vector3i RestElements::cubeOf(const Vector3d& at_m) const {
  const Vector3d most = cubes_.count.cast<double>() - Vector3d::Ones();
  return floored(((at_m - cubes_.origin_m) / cubes_.spacing_m).cwiseMax(0).cwiseMin(most));
}

template <class Visit>
void RestElements::forEachAround(const Vector3d& at_m, int rings, const Visit& visit) const {
  const Vector3i middle = cubeOf(at_m), reach = Vector3i::Constant(rings);
  const Vector3i low = (middle - reach).cwiseMax(0), high = (middle + reach).cwiseMin(cubes_.count - Vector3i::Ones());
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        const size_t cube = cubes_.at({x, y, z});
        for (uint32_t i = starts_[cube]; i < starts_[cube + 1]; ++i) visit(sorted_[i]);
      }
    }
  }
}

/// @param takes  returns whether an element is acceptable
template <class Takes>
std::optional<RestElements::Fit> RestElements::nearestFit(const Vector3d& at_m, int rings, const Takes& takes) const {
  std::optional<Fit> best;
  if (!at_m.allFinite()) return best;
  forEachAround(at_m, rings, [&](uint32_t element) {
    if (!takes(element)) return;
    const Fit here = fit(element, at_m);
    if (!best || here.isNearerThan(*best)) best = here;
  });
  if (best && count_ == 8)
    best->weights = weights(corners_[best->element], at_m);  // fit() needs the weights only of other elements
  return best;
}

RestElements::Weights RestElements::weights(const Corners& corners, const Vector3d& at_m) const {
  Weights out{};
  const Vector3d first = restPosition(body_, corners[0]), from = at_m - first;
  if (count_ == 8) {
    const Vector3d t = from / cubes_.spacing_m;
    for (uint32_t c = 0; c < 8; ++c) {
      out[c] = 1;
      for (uint32_t a = 0; a < 3; ++a) out[c] *= (c >> a & 1) ? t[a] : 1 - t[a];
    }
    return out;
  }
  Eigen::Matrix3d edges = Eigen::Matrix3d::Zero();
  for (uint32_t c = 1; c < count_; ++c) edges.col(c - 1) = restPosition(body_, corners[c]) - first;
  edges.col(2) = edges.col(0).cross(edges.col(1)).normalized();
  const Vector3d shares = edges.inverse() * from;
  out[0] = 1;
  for (uint32_t c = 1; c < count_; ++c) {
    out[c] = shares[c - 1];
    out[0] -= shares[c - 1];
  }
  return out;
}

RestElements::Fit RestElements::fit(uint32_t element, const Vector3d& at_m) const {
  Fit out;
  out.element = element;
  const double h = cubes_.spacing_m;
  if (count_ == 8) {
    const Vector3d t = (at_m - corner_m(element, 0)) / h;
    out.outside_m = h * std::max(-t.minCoeff(), t.maxCoeff() - 1);
    return out;
  }
  out.weights = weights(corners_[element], at_m);
  out.outside_m = -h * *std::min_element(out.weights.begin(), out.weights.begin() + count_);
  Vector3d foot = Vector3d::Zero();
  for (uint32_t c = 0; c < 3; ++c) foot += out.weights[c] * corner_m(element, c);
  out.off_m = (at_m - foot).norm();
  out.outside_m = std::max(out.outside_m, out.off_m - kBesideSheet * h);
  return out;
}

TissuePoint RestElements::pointOf(const Fit& fit, const Vector3d& rest_m) const {
  TissuePoint out;
  out.body = number_;
  out.count = count_;
  for (uint32_t c = 0; c < count_; ++c) {
    out.slots[c] = slot_offset_ + corners_[fit.element][c];
    out.weights[c] = static_cast<float>(fit.weights[c]);
  }
  out.rest_m = rest_m;
  return out;
}

std::optional<TissuePoint> RestElements::embed(const Vector3d& rest_m, const CutSprings& cuts) const {
  const std::optional<Fit> around = nearestFit(rest_m, 0, anyElement);
  if (!around || around->outside_m > kBeyond * cubes_.spacing_m) return std::nullopt;
  if (isWhole(around->element, cuts)) return pointOf(*around, rest_m);
  const Corners& corners = corners_[around->element];
  const Sides sides = sidesOf(around->element, cuts);
  const uint32_t side = sideOf(around->element, sides, rest_m, cuts);
  const auto isBeside = [&](uint32_t element) {
    for (uint32_t c = 0; c < count_; ++c) {
      const auto end = corners_[element].begin() + count_;
      if (sides[c] == side && std::find(corners_[element].begin(), end, corners[c]) != end) return true;
    }
    return false;
  };
  const std::optional<Fit> best =
      nearestFit(rest_m, kBesideCut, [&](uint32_t element) { return isBeside(element) && isWhole(element, cuts); });
  if (best) return pointOf(*best, rest_m);
  Fit corner = *around;  // a flap smaller than an element: use its nearest node
  uint32_t nearest = side;
  for (uint32_t c = 0; c < count_; ++c) {
    if (sides[c] == side && around->weights[c] > around->weights[nearest]) nearest = c;
  }
  corner.weights = {};
  corner.weights[nearest] = 1;
  return pointOf(corner, rest_m);
}

std::optional<TissuePoint> RestElements::nearest(const Vector3d& rest_m, const CutSprings& cuts) const {
  if (std::optional<TissuePoint> inside = embed(rest_m, cuts)) return inside;
  for (int rings = 1; rings <= kNearestRings; ++rings) {
    const std::optional<Fit> found = nearestFit(rest_m, rings, anyElement);
    // Cells not visited yet are at least this many rings away.
    const bool last = rings == kNearestRings, nearer = found && count_ == 8 && found->outside_m < rings * spacing_m();
    if (found && (last || nearer)) return pointOf(*found, rest_m);
  }
  return std::nullopt;
}

/// @returns the position of the cut between a and b, 0 to 1; kWholeSpring: it is not cut, or there is no spring
double RestElements::cutAt(uint32_t a, uint32_t b, const CutSprings& cuts) const {
  if (a > b) {
    const double share = cutAt(b, a, cuts);
    return share == kWholeSpring ? share : 1 - share;
  }
  const auto known = [](double share) { return share > 0 && share < 1 ? share : kUnknownShare; };
  if (body_.network) {
    if (cuts.spring_cut.empty()) return kWholeSpring;
    const std::vector<NetworkSpring>& springs = body_.network->springs;
    const auto spring = std::lower_bound(springs.begin(), springs.end(), std::make_pair(a, b),
                                         [](const NetworkSpring& one, const std::pair<uint32_t, uint32_t>& ends) {
                                           return std::make_pair(one.a, one.b) < ends;
                                         });
    if (spring == springs.end() || spring->a != a || spring->b != b) return kWholeSpring;
    const float share = cuts.spring_cut[first_spring_ + static_cast<size_t>(spring - springs.begin())];
    return share == 0 ? kWholeSpring : known(static_cast<double>(share));
  }
  if (cuts.nodes.empty()) return kWholeSpring;
  const Vector3i from = body_.lattice.nodeAt(a), offset = body_.lattice.nodeAt(b) - from;
  const int spring = springIndex(offset);
  if (spring < 0 || springCount(body_.lattice.nodes[a], static_cast<uint32_t>(spring)) == 0 ||
      springCount(cuts.nodes[slot_offset_ + a], static_cast<uint32_t>(spring)) > 0)
    return kWholeSpring;
  if (!isAxial(static_cast<uint32_t>(spring)) || cuts.axial_cut.empty()) return kUnknownShare;
  const bool upwards = spring % 2 == 0;
  const double share =
      static_cast<double>(cuts.axial_cut[3 * (slot_offset_ + (upwards ? a : b)) + static_cast<uint32_t>(spring) / 2]);
  return upwards ? known(share) : 1 - known(share);
}

bool RestElements::isWhole(uint32_t element, const CutSprings& cuts) const {
  for (uint32_t a = 0; a < count_; ++a) {
    for (uint32_t b = a + 1; b < count_; ++b) {
      if (cutAt(corners_[element][a], corners_[element][b], cuts) != kWholeSpring) return false;
    }
  }
  return true;
}

RestElements::Sides RestElements::sidesOf(uint32_t element, const CutSprings& cuts) const {
  Sides sides{};
  std::iota(sides.begin(), sides.end(), 0u);
  const bool cells = count_ == 8;
  for (uint32_t a = 0; a < count_; ++a) {
    for (uint32_t b = a + 1; b < count_; ++b) {
      const uint32_t differs = a ^ b;
      if (cells && differs == 7) continue;  // no spring goes through a cell
      if (sides[a] == sides[b] || cutAt(corners_[element][a], corners_[element][b], cuts) != kWholeSpring) continue;
      const uint32_t low = std::min(sides[a], sides[b]), high = std::max(sides[a], sides[b]);
      std::replace(sides.begin(), sides.end(), high, low);
    }
  }
  return sides;
}

/// Finds the side by the plane through the cuts of its edges; if that separates it into more than two, by the nearest
/// corner.
uint32_t RestElements::sideOf(uint32_t element, const Sides& sides, const Vector3d& at_m,
                              const CutSprings& cuts) const {
  std::vector<Vector3d> crossings;
  Vector3d across = Vector3d::Zero();
  uint32_t nearest = 0, other = 0;
  for (uint32_t a = 0; a < count_; ++a) {
    if ((corner_m(element, a) - at_m).norm() < (corner_m(element, nearest) - at_m).norm()) nearest = a;
    if (sides[a] != sides[0]) other = other == 0 || other == sides[a] ? sides[a] : TissuePoint::kMost;
    for (uint32_t b = a + 1; b < count_; ++b) {
      const uint32_t differs = a ^ b;
      if (count_ == 8 && (differs & (differs - 1)) != 0)
        continue;  // the positions of cuts of diagonals are not recorded
      const double share = cutAt(corners_[element][a], corners_[element][b], cuts);
      if (share == kWholeSpring || sides[a] == sides[b]) continue;
      const Vector3d offset = corner_m(element, b) - corner_m(element, a);
      crossings.emplace_back(corner_m(element, a) + share * offset);
      across += sides[a] == sides[0] ? offset : Vector3d(-offset);
    }
  }
  if (other == 0 || other == TissuePoint::kMost || crossings.empty()) return sides[nearest];
  Vector3d middle = Vector3d::Zero(), normal = Vector3d::Zero();
  for (const Vector3d& crossing : crossings) middle += crossing / static_cast<double>(crossings.size());
  for (const Vector3d& one : crossings) {
    for (const Vector3d& two : crossings) {
      const Vector3d area = (one - middle).cross(two - middle);
      if (area.squaredNorm() > normal.squaredNorm()) normal = area;
    }
  }
  if (normal.norm() < kBeyond * cubes_.spacing_m * cubes_.spacing_m) normal = across;
  if (normal.dot(across) < 0) normal = -normal;
  return (at_m - middle).dot(normal) > 0 ? other : sides[0];
}

Eigen::Matrix<double, Eigen::Dynamic, 3> RestElements::slopes(const TissuePoint& point) const {
  Eigen::Matrix<double, Eigen::Dynamic, 3> out(point.count, 3);
  Corners corners{};
  for (uint32_t c = 0; c < point.count; ++c) corners[c] = point.slots[c] - slot_offset_;
  const double step_m = kBeyond * cubes_.spacing_m;
  for (int a = 0; a < 3; ++a) {
    const Vector3d by = step_m * Vector3d::Unit(a);
    const Weights high = weights(corners, point.rest_m + by), low = weights(corners, point.rest_m - by);
    for (uint32_t c = 0; c < point.count; ++c)
      out(c, a) = (high[c] - low[c]) / (2 * step_m);  // the weights are linear in it
  }
  return out;
}

Vector3d RestElements::normal(const TissuePoint& point) const {
  if (count_ != 3) return Vector3d::Zero();
  const auto at = [&](uint32_t c) { return restPosition(body_, point.slots[c] - slot_offset_); };
  return (at(1) - at(0)).cross(at(2) - at(0)).normalized();
}

}  // namespace viscera
