// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/pressure/surface_loads.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace viscera {

namespace {

Eigen::Array4f arrayOf(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
}

Eigen::Array4f cross(const Eigen::Array4f& a, const Eigen::Array4f& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0};
}

}  // namespace

SurfaceLoads::SurfaceLoads(const Model& model, const std::vector<Cavities>& surfaces) : masses_(model) {
  for (const Cavities& surface : surfaces) {
    const auto first = static_cast<uint32_t>(rest_m_.size());
    first_vertex_.push_back(first);
    first_triangle_.push_back(static_cast<uint32_t>(triangles_.size()));
    for (const Vector3d& p : surface.positions_m) rest_m_.push_back(arrayOf(p));
    for (const std::vector<uint32_t>& rim : surface.rims) {
      Rim& own = rims_.emplace_back(Rim{static_cast<uint32_t>(rest_m_.size()), rim});
      for (uint32_t& v : own.vertices) v += first;
      rest_m_.push_back(Eigen::Array4f::Zero());
    }
    for (const std::array<uint32_t, 3>& t : surface.triangles)
      triangles_.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  carriers_.resize(rest_m_.size());
  pressure_pa_.assign(triangles_.size(), 0);
  at_m_ = rest_m_;
  on_vertex_n_.assign(rest_m_.size(), Eigen::Array4f::Zero());
}

void SurfaceLoads::carry(uint32_t vertex, const TissuePoint& by) {
  Carrier& to = carriers_[vertex];
  to = {};
  // Other corners than those of a cell repeat a node, with a weight of 0.
  to.slots.fill(by.slots[0]);
  for (uint32_t c = 0; c < by.count; ++c) {
    to.slots[c] = by.slots[c];
    to.weights[c] = by.weights[c];
  }
}

void SurfaceLoads::gatherNodes() {
  std::vector<uint8_t> is_centre(carriers_.size(), 0);
  for (const Rim& rim : rims_) is_centre[rim.centre] = 1;
  slots_.clear();
  for (size_t v = 0; v < carriers_.size(); ++v)
    if (!is_centre[v]) slots_.insert(slots_.end(), carriers_[v].slots.begin(), carriers_[v].slots.end());
  std::sort(slots_.begin(), slots_.end());
  slots_.erase(std::unique(slots_.begin(), slots_.end()), slots_.end());
  for (size_t v = 0; v < carriers_.size(); ++v) {
    Carrier& carrier = carriers_[v];
    for (size_t c = 0; c < carrier.slots.size() && !is_centre[v]; ++c)
      carrier.nodes[c] =
          static_cast<uint32_t>(std::lower_bound(slots_.begin(), slots_.end(), carrier.slots[c]) - slots_.begin());
  }
  u_m_.assign(slots_.size(), Eigen::Array4f::Zero());
  force_n_.assign(slots_.size(), Eigen::Array4f::Zero());
}

void SurfaceLoads::read(const TissuePort& port, double undone_s) {
  read_u_.resize(slots_.size());
  read_v_.resize(slots_.size());
  port.readNodes(slots_, read_u_, read_v_);
  const auto back_s = static_cast<float>(undone_s);
  for (size_t i = 0; i < slots_.size(); ++i) u_m_[i].head<3>() = (read_u_[i] - back_s * read_v_[i]).array();
  move();
}

void SurfaceLoads::atRest() {
  std::fill(u_m_.begin(), u_m_.end(), Eigen::Array4f::Zero());
  move();
}

void SurfaceLoads::move() {
  for (size_t v = 0; v < carriers_.size(); ++v) {
    const Carrier& carrier = carriers_[v];
    Eigen::Array4f at = rest_m_[v];
    for (size_t c = 0; c < carrier.nodes.size(); ++c) at += carrier.weights[c] * u_m_[carrier.nodes[c]];
    at_m_[v] = at;
  }
  for (const Rim& rim : rims_) {
    Eigen::Array4f sum = Eigen::Array4f::Zero();
    for (const uint32_t v : rim.vertices) sum += at_m_[v];
    at_m_[rim.centre] = sum / static_cast<float>(rim.vertices.size());
  }
}

Vector3d SurfaceLoads::area_m2(uint32_t t) const {
  const auto& [a, b, c] = triangles_[t];
  return 0.5 * (position_m(b) - position_m(a)).cross(position_m(c) - position_m(a));
}

/// Gives each vertex a third of the forces on its triangles, and those of the centres of rims to their vertices.
void SurfaceLoads::loadTriangles() {
  std::fill(on_vertex_n_.begin(), on_vertex_n_.end(), Eigen::Array4f::Zero());
  constexpr float kSixth = 1.0F / 6;
  for (size_t t = 0; t < triangles_.size(); ++t) {
    if (pressure_pa_[t] == 0) continue;
    const auto& [a, b, c] = triangles_[t];
    const Eigen::Array4f force = kSixth * pressure_pa_[t] * cross(at_m_[b] - at_m_[a], at_m_[c] - at_m_[a]);
    on_vertex_n_[a] += force;
    on_vertex_n_[b] += force;
    on_vertex_n_[c] += force;
  }
  for (const Rim& rim : rims_) {
    const Eigen::Array4f share = on_vertex_n_[rim.centre] / static_cast<float>(rim.vertices.size());
    for (const uint32_t v : rim.vertices) on_vertex_n_[v] += share;
    on_vertex_n_[rim.centre].setZero();
  }
}

double SurfaceLoads::apply(TissuePort& port, double dt_s) {
  loadTriangles();
  std::fill(force_n_.begin(), force_n_.end(), Eigen::Array4f::Zero());
  for (size_t v = 0; v < carriers_.size(); ++v) {
    const Carrier& carrier = carriers_[v];
    const Eigen::Array4f& force = on_vertex_n_[v];
    for (size_t c = 0; c < carrier.nodes.size(); ++c) force_n_[carrier.nodes[c]] += carrier.weights[c] * force;
  }
  const auto dt = static_cast<float>(dt_s);
  double work_j = 0;
  for (size_t i = 0; i < slots_.size(); ++i) {
    const Vector3f dv = dt * masses_.inverse_per_kg[slots_[i]] * force_n_[i].head<3>().matrix();
    work_j += static_cast<double>(masses_.kg[slots_[i]] * dv.dot(read_v_[i] + 0.5F * dv));
    read_u_[i] = dv;
  }
  port.pushNodes(layout::kMaxStyluses, dt, slots_, read_u_);
  return work_j;
}

}  // namespace viscera
