// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/blade/blade_kernel.h"

#include <Eigen/LU>

#include <algorithm>
#include <limits>

#include "solver/processes/blade/run_sums.h"

namespace viscera {

namespace {

constexpr double kFolded = 0.1;  // determinant of F below which tissue counts as folded, and the identity is used
constexpr size_t kLanes = BladeNodes::kLanes;

using Lanes = Eigen::Array<float, kLanes, 1>;
Eigen::Map<const Lanes> at(const std::vector<float>& values, size_t i) {
  return Eigen::Map<const Lanes>(values.data() + i);
}

struct Lanes3 {
  Lanes x = Lanes::Zero(), y = Lanes::Zero(), z = Lanes::Zero();
  Vector3f sum() const { return {x.sum(), y.sum(), z.sum()}; }
  void add(const Lanes& times, const RunPlanes& planes, size_t i) {
    x += times * at(planes[0], i);
    y += times * at(planes[1], i);
    z += times * at(planes[2], i);
  }
};

}  // namespace

void BladeNodes::gather(const RestTissue& tissue, const std::vector<Vector3d>& centres_m, const Vector3d& along_edge,
                        double radius_m) {
  along = along_edge;
  origin_m = centres_m.front();
  is_found_.resize(tissue.nodes().size(), 0);
  for (const Vector3d& centre_m : centres_m) {
    tissue.forEachNear(centre_m, radius_m, [this](uint32_t n) { is_found_[n] = 1; });
  }
  found_.clear();
  for (uint32_t n = 0; n < is_found_.size(); ++n) {
    if (is_found_[n]) found_.push_back(n);
    is_found_[n] = 0;
  }
  runs.clear();
  for (const uint32_t n : found_) {
    const uint32_t run = tissue.nodes()[n].slot / kLanes * kLanes;
    if (runs.empty() || runs.back() != run) runs.push_back(run);
  }
  for (std::vector<float>* plane :
       {&share, &inverse_mass, &rest_m[0], &rest_m[1], &rest_m[2], &u[0], &u[1], &u[2], &v[0], &v[1], &v[2]})
    plane->assign(runs.size() * kLanes, 0);
  low_m.assign(runs.size(), std::numeric_limits<float>::max());
  high_m.assign(runs.size(), std::numeric_limits<float>::lowest());
  size_t run = 0;
  for (const uint32_t n : found_) {
    const RestTissue::Node& node = tissue.nodes()[n];
    while (runs[run] != node.slot / kLanes * kLanes) ++run;
    const size_t i = run * kLanes + node.slot % kLanes;
    const Vector3f rest = (node.rest_m - origin_m).cast<float>();
    const float position_m = rest.dot(along.cast<float>());
    share[i] = node.share;
    inverse_mass[i] = node.inverse_mass;
    for (int a = 0; a < 3; ++a) rest_m[static_cast<size_t>(a)][i] = rest[a];
    low_m[run] = std::min(low_m[run], position_m);
    high_m[run] = std::max(high_m[run], position_m);
  }
}

void BladeNodes::toVelocities(RunPlanes& momenta) const {
  for (std::vector<float>& plane : momenta) {
    for (size_t n = 0; n < plane.size(); n += kLanes) Eigen::Map<Lanes>(plane.data() + n) *= at(inverse_mass, n);
  }
}

void BladeKernel::make(const BladeNodes& nodes, const Vector3d& centre_m, double radius_m) {
  is_new = true;
  runs.clear();
  weights.clear();
  lean.setZero();
  if (!centre_m.allFinite()) return;
  const Vector3d from_origin = centre_m - nodes.origin_m;
  const auto low_m = static_cast<float>(from_origin.dot(nodes.along) - radius_m);
  const auto high_m = static_cast<float>(from_origin.dot(nodes.along) + radius_m);
  centre_m_ = from_origin.cast<float>();
  per_radius2_ = static_cast<float>(1 / (radius_m * radius_m));
  Lanes sum = Lanes::Zero();
  Lanes3 slopes, leans;
  for (size_t run = 0; run < nodes.runs.size(); ++run) {
    if (nodes.high_m[run] < low_m || nodes.low_m[run] > high_m) continue;
    const size_t n = run * kLanes;
    const Lanes x = at(nodes.rest_m[0], n) - centre_m_.x(), y = at(nodes.rest_m[1], n) - centre_m_.y(),
                z = at(nodes.rest_m[2], n) - centre_m_.z();
    const Lanes t = (1 - per_radius2_ * (x * x + y * y + z * z)).max(0.0f);
    const Lanes slope = 4 * per_radius2_ * at(nodes.share, n) * t, weight = at(nodes.share, n) * t * t;
    if (!(weight > 0).any()) continue;
    runs.push_back(static_cast<uint32_t>(run));
    weights.insert(weights.end(), weight.data(), weight.data() + kLanes);
    sum += weight;
    slopes.x += slope * x;
    slopes.y += slope * y;
    slopes.z += slope * z;
    leans.x += weight * x;
    leans.y += weight * y;
    leans.z += weight * z;
  }
  sum_ = sum.sum();
  slope_sum_ = slopes.sum();
  if (runs.empty()) return;
  lean = (leans.sum() / sum_).cast<double>();
  for (float& weight : weights) weight /= sum_;
}

void BladeKernel::means(const BladeNodes& nodes, Vector3d& u_m, Vector3d& v_m_per_s) const {
  const RunPlanes &u = nodes.u, &v = nodes.v;
  float sums[6];
  sumRuns({runs.data(), weights.data(), runs.size()},
          {u[0].data(), u[1].data(), u[2].data(), v[0].data(), v[1].data(), v[2].data()}, sums);
  u_m = Vector3f(sums[0], sums[1], sums[2]).cast<double>();
  v_m_per_s = Vector3f(sums[3], sums[4], sums[5]).cast<double>();
}

void BladeKernel::spread(const BladeNodes& nodes, std::vector<float>& out) const {
  out.assign(nodes.share.size(), 0);
  for (size_t i = 0; i < runs.size(); ++i) {
    const size_t n = runs[i] * kLanes;
    Eigen::Map<Lanes>(out.data() + n) = at(weights, i * kLanes) * at(nodes.inverse_mass, n);
  }
}

double BladeKernel::mobility(const std::vector<float>& other) const {
  Lanes sum = Lanes::Zero();
  for (size_t i = 0; i < runs.size(); ++i) sum += at(weights, i * kLanes) * at(other, runs[i] * kLanes);
  return static_cast<double>(sum.sum());
}

void BladeKernel::give(const Vector3f& impulse, RunPlanes& momenta) const {
  addToRuns({runs.data(), weights.data(), runs.size()}, {impulse.x(), impulse.y(), impulse.z()},
            {momenta[0].data(), momenta[1].data(), momenta[2].data()});
}

/// Computes F as the gradient of a weighted mean; the sum of the weights varies too.
Eigen::Matrix3d BladeKernel::toRest(const BladeNodes& nodes) {
  is_new = false;
  if (weights.empty()) return Eigen::Matrix3d::Identity();
  Lanes3 by_x, by_y, by_z, mean;
  for (size_t i = 0; i < runs.size(); ++i) {
    const size_t n = runs[i] * kLanes;
    const Lanes x = at(nodes.rest_m[0], n) - centre_m_.x(), y = at(nodes.rest_m[1], n) - centre_m_.y(),
                z = at(nodes.rest_m[2], n) - centre_m_.z();
    const Lanes t = (1 - per_radius2_ * (x * x + y * y + z * z)).max(0.0f);
    const Lanes slope = 4 * per_radius2_ * at(nodes.share, n) * t;
    by_x.add(slope * x, nodes.u, n);
    by_y.add(slope * y, nodes.u, n);
    by_z.add(slope * z, nodes.u, n);
    mean.add(at(weights, i * kLanes), nodes.u, n);
  }
  Eigen::Matrix3f gradient;
  gradient << by_x.sum(), by_y.sum(), by_z.sum();
  gradient = (gradient - mean.sum() * slope_sum_.transpose()) / sum_;
  const Eigen::Matrix3d deformed = Eigen::Matrix3d::Identity() + gradient.cast<double>();
  return deformed.determinant() > kFolded ? Eigen::Matrix3d(deformed.inverse()) : Eigen::Matrix3d::Identity();
}

}  // namespace viscera
