// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/tissue_points.h"

#include <Eigen/LU>

#include <algorithm>
#include <utility>

#include "solver/processes/node_masses.h"

namespace viscera {

namespace {

constexpr size_t kSparse = 256;  // nodes of a body that are read first
constexpr size_t kStarts = 4;    // nearest of them from which a walk starts
constexpr int kWalkSteps = 24;
constexpr double kMostWalked = 4;      // spacings per step
constexpr double kArrived = 1e-4;      // of a spacing: convergence of a walk
constexpr double kSamePosition = 0.1;  // of a spacing: largest distance of the found point from the requested position
constexpr double kBesideIt = 0.5;      // the same for a sheet
constexpr double kFoldedPoint = 0.01;  // volume ratio below which tissue counts as folded

std::vector<uint32_t> sparseOf(const Body& body, uint32_t offset) {
  const std::vector<uint32_t>& slots = body.lattice.active_slots;
  const size_t stride = std::max<size_t>(1, (slots.size() + kSparse - 1) / kSparse);
  std::vector<uint32_t> out;
  for (size_t i = 0; i < slots.size(); i += stride) out.push_back(offset + slots[i]);
  return out;
}

}  // namespace

TissuePoints::TissuePoints(const Model& model)
    : model_(model),
      inverse_mass_(NodeMasses(model).inverse_per_kg),
      rest_m_(model.slots(), Vector3f::Zero()),
      node_of_(model.slots(), 0) {
  uint32_t first_spring = 0;
  for (uint32_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const uint32_t offset = model.slotOffset(b);
    elements_.emplace_back(model, b, first_spring);
    sparse_.push_back(sparseOf(body, offset));
    if (body.network) first_spring += static_cast<uint32_t>(body.network->springs.size());
    for (const uint32_t slot : body.lattice.active_slots) {
      rest_m_[offset + slot] = restPosition(body, slot).cast<float>();
    }
  }
}

std::optional<TissuePoint> TissuePoints::embed(uint32_t body, const Vector3d& rest_m) const {
  return elements_[body].embed(rest_m, cuts_);
}

std::vector<Vector3d> TissuePoints::positions_m(const TissuePort& target, const std::vector<uint32_t>& slots) const {
  std::vector<Vector3f> u(slots.size()), v(slots.size());
  target.readNodes(slots, u, v);
  std::vector<Vector3d> out(slots.size());
  for (size_t i = 0; i < slots.size(); ++i) out[i] = (rest_m_[slots[i]] + u[i]).cast<double>();
  return out;
}

std::optional<TissuePoint> TissuePoints::find(TissuePort& target, const Vector3d& position_m) const {
  struct Start {
    double distance_m;
    uint32_t body, slot;
    bool operator<(const Start& other) const {
      return std::make_pair(distance_m, slot) < std::make_pair(other.distance_m, other.slot);
    }
  };
  std::vector<Start> starts;
  for (uint32_t b = 0; b < sparse_.size(); ++b) {
    const std::vector<Vector3d> positions = positions_m(target, sparse_[b]);
    std::vector<Start> of_body;
    for (size_t i = 0; i < positions.size(); ++i)
      of_body.push_back({(positions[i] - position_m).norm(), b, sparse_[b][i]});
    std::sort(of_body.begin(), of_body.end());
    starts.insert(starts.end(), of_body.begin(),
                  of_body.begin() + std::min<std::ptrdiff_t>(kStarts, static_cast<std::ptrdiff_t>(of_body.size())));
  }
  std::sort(starts.begin(), starts.end());
  for (const Start& start : starts) {
    if (const auto point = walk(target, start.body, rest_m_[start.slot].cast<double>(), position_m)) return point;
  }
  return std::nullopt;
}

/// Newton's method in the elements along the path.
std::optional<TissuePoint> TissuePoints::walk(TissuePort& target, uint32_t body, Vector3d rest_m,
                                              const Vector3d& position_m) const {
  const RestElements& elements = elements_[body];
  const double h = elements.spacing_m();
  const auto lies = [&](const TissuePoint& point, std::vector<Vector3d>& nodes) {
    nodes = positions_m(target, {point.slots.begin(), point.slots.begin() + point.count});
    Vector3d at = Vector3d::Zero();
    for (uint32_t c = 0; c < point.count; ++c) at += static_cast<double>(point.weights[c]) * nodes[c];
    return at;
  };
  std::vector<Vector3d> nodes;
  bool sheet = false;
  for (int i = 0; i < kWalkSteps; ++i) {
    const std::optional<TissuePoint> here = elements.nearest(rest_m, cuts_);
    if (!here) return std::nullopt;
    const Vector3d off = position_m - lies(*here, nodes);
    const Vector3d normal = elements.normal(*here);
    sheet = !normal.isZero(0);
    const Eigen::Matrix3d by = gradient(*here, nodes);
    Vector3d offset = by.determinant() > kFoldedPoint ? Vector3d(by.inverse() * off) : off;
    if (sheet) offset -= offset.dot(normal) * normal;
    if (offset.norm() < kArrived * h) break;
    if (offset.norm() > kMostWalked * h) offset *= kMostWalked * h / offset.norm();
    rest_m += offset;
  }
  const std::optional<TissuePoint> point = embed(body, rest_m);
  if (!point || (position_m - lies(*point, nodes)).norm() > (sheet ? kBesideIt : kSamePosition) * h)
    return std::nullopt;
  return point;
}

/// Returns the derivative of the current positions by those at rest; across a sheet, that of its normal.
Eigen::Matrix3d TissuePoints::gradient(const TissuePoint& point, const std::vector<Vector3d>& nodes) const {
  const RestElements& elements = elements_[point.body];
  const Eigen::Matrix<double, Eigen::Dynamic, 3> slopes = elements.slopes(point);
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  for (uint32_t c = 0; c < point.count; ++c) out += nodes[c] * slopes.row(c);
  const Vector3d normal = elements.normal(point);
  if (!normal.isZero(0)) out += (nodes[1] - nodes[0]).cross(nodes[2] - nodes[0]).normalized() * normal.transpose();
  return out;
}

Vector3d TissuePoints::toRest(const TissuePoint& point, const Vector3d& offset_m) const {
  std::vector<Vector3d> nodes;
  for (uint32_t c = 0; c < point.count; ++c) nodes.push_back(nodes_[node_of_[point.slots[c]]].x_m);
  const Eigen::Matrix3d by = gradient(point, nodes);
  return by.determinant() > kFoldedPoint ? Vector3d(by.inverse() * offset_m) : offset_m;
}

Vector3d TissuePoints::positionIn(const TissuePort& target, const TissuePoint& point) const {
  const std::vector<Vector3d> nodes = positions_m(target, {point.slots.begin(), point.slots.begin() + point.count});
  Vector3d out = Vector3d::Zero();
  for (uint32_t c = 0; c < point.count; ++c) out += static_cast<double>(point.weights[c]) * nodes[c];
  return out;
}

void TissuePoints::drift(double by_s) {
  for (Node& node : nodes_) node.x_m += by_s * node.v_m_per_s;
}

void TissuePoints::read(TissuePort& target, const std::vector<const TissuePoint*>& points) {
  std::vector<uint32_t> wanted;
  for (const TissuePoint* point : points)
    wanted.insert(wanted.end(), point->slots.begin(), point->slots.begin() + point->count);
  if (wanted != wanted_) {
    slots_ = wanted;
    std::sort(slots_.begin(), slots_.end());
    slots_.erase(std::unique(slots_.begin(), slots_.end()), slots_.end());
    for (size_t i = 0; i < slots_.size(); ++i) node_of_[slots_[i]] = static_cast<uint32_t>(i);
    wanted_ = std::move(wanted);
  }
  work_j_ = 0;
  u_.resize(slots_.size());
  v_.resize(slots_.size());
  nodes_.resize(slots_.size());
  if (!slots_.empty()) target.readNodes(slots_, u_, v_);
  for (size_t i = 0; i < slots_.size(); ++i)
    nodes_[i] = {(rest_m_[slots_[i]].cast<double>() + u_[i].cast<double>()), v_[i].cast<double>(), Vector3d::Zero()};
}

Vector3d TissuePoints::position_m(const TissuePoint& point) const {
  Vector3d out = Vector3d::Zero();
  for (uint32_t c = 0; c < point.count; ++c)
    out += static_cast<double>(point.weights[c]) * nodes_[node_of_[point.slots[c]]].x_m;
  return out;
}

Vector3d TissuePoints::velocity_m_per_s(const TissuePoint& point) const {
  Vector3d out = Vector3d::Zero();
  for (uint32_t c = 0; c < point.count; ++c)
    out += static_cast<double>(point.weights[c]) * nodes_[node_of_[point.slots[c]]].v_m_per_s;
  return out;
}

double TissuePoints::mobility(const TissuePoint& one, const TissuePoint& other) const {
  double out = 0;
  for (uint32_t c = 0; c < one.count; ++c) {
    for (uint32_t d = 0; d < other.count; ++d) {
      if (one.slots[c] != other.slots[d]) continue;
      out += static_cast<double>(one.weights[c]) * static_cast<double>(other.weights[d]) *
             static_cast<double>(inverse_mass_[one.slots[c]]);
    }
  }
  return out;
}

void TissuePoints::give(const TissuePoint& point, const Vector3d& impulse_ns, double dt_s) {
  for (uint32_t c = 0; c < point.count; ++c) {
    const double share = static_cast<double>(point.weights[c]) * static_cast<double>(inverse_mass_[point.slots[c]]);
    Node& node = nodes_[node_of_[point.slots[c]]];
    const Vector3d dv = share * impulse_ns;
    work_j_ += static_cast<double>(point.weights[c]) * impulse_ns.dot(node.v_m_per_s + 0.5 * dv);
    node.dv_m_per_s += dv;
    node.v_m_per_s += dv;
    node.x_m += dt_s * dv;
  }
}

void TissuePoints::write(TissuePort& target, uint32_t stylus, double dt_s) {
  std::vector<uint32_t> slots;
  std::vector<Vector3f> changes;
  for (size_t i = 0; i < slots_.size(); ++i) {
    Vector3d& dv = nodes_[i].dv_m_per_s;
    if (dv.isZero(0)) continue;
    slots.push_back(slots_[i]);
    changes.push_back(dv.cast<float>());
    dv.setZero();
  }
  if (!slots.empty()) target.pushNodes(stylus, static_cast<float>(dt_s), slots, changes);
}

}  // namespace viscera
