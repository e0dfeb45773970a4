// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/attach/fibre_forces.h"

#include <algorithm>
#include <limits>

namespace viscera {

FibreForces::FibreForces(const Model& model) : masses_(model), node_of_(model.slots(), 0) {}

void FibreForces::embed(const std::vector<Fibre>& fibres) {
  slots_.clear();
  for (const Fibre& fibre : fibres) {
    for (const TissuePoint& end : fibre.ends)
      slots_.insert(slots_.end(), end.slots.begin(), end.slots.begin() + end.count);
  }
  std::sort(slots_.begin(), slots_.end());
  slots_.erase(std::unique(slots_.begin(), slots_.end()), slots_.end());
  for (uint32_t i = 0; i < slots_.size(); ++i) node_of_[slots_[i]] = i;
  patches_.clear();
  patch_of_.clear();
  nodes_.clear();
  weights_.clear();
  std::vector<uint32_t> nodes;
  for (uint32_t f = 0; f < fibres.size(); ++f) {
    nodes.clear();
    const auto before = static_cast<uint32_t>(weights_.size());
    uint32_t first_ends = 0;
    for (size_t e = 0; e < 2; ++e) {
      const TissuePoint& end = fibres[f].ends[e];
      for (uint32_t c = 0; c < end.count; ++c) {
        if (end.weights[c] == 0) continue;
        nodes.push_back(node_of_[end.slots[c]]);
        weights_.push_back(e == 0 ? -end.weights[c] : end.weights[c]);
      }
      if (e == 0) first_ends = static_cast<uint32_t>(nodes.size());
    }
    if (!addToPatch(f, nodes)) {
      patches_.push_back(
          {f, f + 1, static_cast<uint32_t>(nodes_.size()), static_cast<uint32_t>(nodes.size()), first_ends, before});
      nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
    }
    patch_of_.push_back(static_cast<uint32_t>(patches_.size() - 1));
  }
  secant_n_per_m_.assign(fibres.size(), 0);
  largest_m2_ = 0;
  grows_m2_.assign(fibres.size(), std::numeric_limits<float>::max());
  u_m_.assign(slots_.size(), Eigen::Array4f::Zero());
}

/// Adds a fibre to the last patch. @returns whether it has the same nodes
bool FibreForces::addToPatch(uint32_t fibre, const std::vector<uint32_t>& nodes) {
  if (patches_.empty() || patches_.back().nodes != nodes.size()) return false;
  if (!std::equal(nodes.begin(), nodes.end(), nodes_.begin() + patches_.back().first_node)) return false;
  patches_.back().last = fibre + 1;
  return true;
}

void FibreForces::setSecant(size_t fibre, double secant_n_per_m, double grows_m) {
  secant_n_per_m_[fibre] = static_cast<float>(secant_n_per_m);
  grows_m2_[fibre] = static_cast<float>(grows_m * grows_m);
}

void FibreForces::read(const TissuePort& port, double undone_s) {
  read_u_.resize(slots_.size());
  read_v_.resize(slots_.size());
  if (!slots_.empty()) port.readNodes(slots_, read_u_, read_v_);
  const auto back_s = static_cast<float>(undone_s);
  for (size_t i = 0; i < slots_.size(); ++i) u_m_[i].head<3>() = (read_u_[i] - back_s * read_v_[i]).array();
}

/// Sums over nodes of a fibre's patch.
Vector3d FibreForces::sumOver(size_t fibre, uint32_t first_node, uint32_t last_node) const {
  const Patch& patch = patches_[patch_of_[fibre]];
  const float* const weights = &weights_[patch.first_weight + (fibre - patch.first) * patch.nodes];
  Eigen::Array4f out = Eigen::Array4f::Zero();
  for (uint32_t i = first_node; i < last_node; ++i) out += weights[i] * u_m_[nodes_[patch.first_node + i]];
  return out.head<3>().cast<double>();
}

Vector3d FibreForces::gap_m(size_t fibre) const {
  return sumOver(fibre, 0, patches_[patch_of_[fibre]].nodes);
}

Vector3d FibreForces::firstEnd_m(size_t fibre) const {
  return -sumOver(fibre, 0, patches_[patch_of_[fibre]].first_ends);
}

Vector3d FibreForces::displacement_m(uint32_t slot) const {
  return u_m_[node_of_[slot]].head<3>().cast<double>();
}

double FibreForces::apply(TissuePort& port, double dt_s) {
  const auto dt = static_cast<float>(dt_s);
  double work_j = 0;
  for (size_t i = 0; i < slots_.size(); ++i) {
    const float inverse = masses_.inverse_per_kg[slots_[i]];
    const Vector3f dv = dt * inverse * impulse_[i].head<3>().matrix();
    if (inverse > 0) work_j += static_cast<double>(masses_.kg[slots_[i]] * dv.dot(read_v_[i] + 0.5F * dv));
    read_u_[i] = dv;
  }
  if (!slots_.empty()) port.pushNodes(layout::kMaxStyluses, dt, slots_, read_u_);
  return work_j;
}

}  // namespace viscera
