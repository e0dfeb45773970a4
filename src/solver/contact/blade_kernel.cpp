// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/blade_kernel.h"

#include <Eigen/LU>

#include <algorithm>

namespace viscera {

namespace {

constexpr double kFolded = 0.1;  // determinant of F below which a front goes as if the tissue were rigid
constexpr size_t kLanes = BladeNodes::kLanes;

using Lanes = Eigen::Array<float, kLanes, 1>;
Eigen::Map<const Lanes> at(const std::vector<float>& values, size_t i) {
  return Eigen::Map<const Lanes>(values.data() + i);
}

struct Lanes3 {
  Lanes x = Lanes::Zero(), y = Lanes::Zero(), z = Lanes::Zero();
  Vector3f sum() const { return {x.sum(), y.sum(), z.sum()}; }
  void add(const Lanes& times, const BladeNodes::Planes& planes, size_t i) {
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
  found_.clear();
  for (const Vector3d& centre_m : centres_m) {
    tissue.forEachNear(centre_m, radius_m, [this](uint32_t n) {
      if (!is_found_[n]) found_.push_back(n);
      is_found_[n] = 1;
    });
  }
  for (const uint32_t n : found_) is_found_[n] = 0;
  const auto place = [&](uint32_t n) { return static_cast<float>((tissue.nodes()[n].rest_m - origin_m).dot(along)); };
  std::sort(found_.begin(), found_.end(), [&](uint32_t a, uint32_t b) {
    const float at_a = place(a), at_b = place(b);
    return at_a < at_b || (at_a == at_b && a < b);
  });
  const size_t whole = (found_.size() + kLanes - 1) / kLanes * kLanes;
  slots.clear();
  for (std::vector<float>* plane :
       {&share, &inverse_mass, &rest_m[0], &rest_m[1], &rest_m[2], &u[0], &u[1], &u[2], &v[0], &v[1], &v[2]})
    plane->assign(whole, 0);
  places_m.assign(whole, found_.empty() ? 0 : place(found_.back()));
  for (size_t i = 0; i < found_.size(); ++i) {
    const RestTissue::Node& node = tissue.nodes()[found_[i]];
    slots.push_back(node.slot);
    share[i] = node.share;
    inverse_mass[i] = node.inverse_mass;
    places_m[i] = place(found_[i]);
    for (int a = 0; a < 3; ++a) rest_m[static_cast<size_t>(a)][i] = static_cast<float>((node.rest_m - origin_m)[a]);
  }
}

void BladeNodes::take(const std::vector<Vector3f>& u_m, const std::vector<Vector3f>& v_m_per_s) {
  for (size_t i = 0; i < slots.size(); ++i) {
    for (size_t a = 0; a < 3; ++a) {
      u[a][i] = u_m[i][static_cast<int>(a)];
      v[a][i] = v_m_per_s[i][static_cast<int>(a)];
    }
  }
}

void BladeKernel::make(const BladeNodes& nodes, const Vector3d& centre_m, double radius_m) {
  is_new = true;
  weights.clear();
  lean.setZero();
  const Vector3d from_origin = centre_m - nodes.origin_m;
  const double place_m = from_origin.dot(nodes.along);
  const auto begin = nodes.places_m.begin(), end = nodes.places_m.end();
  first = static_cast<size_t>(std::lower_bound(begin, end, static_cast<float>(place_m - radius_m)) - begin);
  first = first / kLanes * kLanes;
  const auto last = static_cast<size_t>(std::upper_bound(begin, end, static_cast<float>(place_m + radius_m)) - begin);
  if (!centre_m.allFinite() || last <= first) return;
  weights.resize((last - first + kLanes - 1) / kLanes * kLanes);
  centre_m_ = from_origin.cast<float>();
  per_radius2_ = static_cast<float>(1 / (radius_m * radius_m));
  Lanes sum = Lanes::Zero();
  Lanes3 slopes, leans;
  for (size_t i = 0; i < weights.size(); i += kLanes) {
    const size_t n = first + i;
    const Lanes x = at(nodes.rest_m[0], n) - centre_m_.x(), y = at(nodes.rest_m[1], n) - centre_m_.y(),
                z = at(nodes.rest_m[2], n) - centre_m_.z();
    const Lanes t = (1 - per_radius2_ * (x * x + y * y + z * z)).max(0.0f);
    const Lanes slope = 4 * per_radius2_ * at(nodes.share, n) * t, weight = at(nodes.share, n) * t * t;
    Eigen::Map<Lanes>(weights.data() + i) = weight;
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
  if (!(sum_ > 0)) return weights.clear();
  lean = (leans.sum() / sum_).cast<double>();
  for (float& weight : weights) weight /= sum_;
}

void BladeKernel::means(const BladeNodes& nodes, Vector3d& u_m, Vector3d& v_m_per_s) const {
  Lanes3 u, v;
  for (size_t i = 0; i < weights.size(); i += kLanes) {
    u.add(at(weights, i), nodes.u, first + i);
    v.add(at(weights, i), nodes.v, first + i);
  }
  u_m = u.sum().cast<double>();
  v_m_per_s = v.sum().cast<double>();
}

double BladeKernel::mobility(const BladeNodes& nodes, const BladeKernel& other) const {
  const size_t begin = std::max(first, other.first);
  const size_t end = std::min(first + weights.size(), other.first + other.weights.size());
  Lanes sum = Lanes::Zero();
  for (size_t n = begin; n < end; n += kLanes)
    sum += at(weights, n - first) * at(other.weights, n - other.first) * at(nodes.inverse_mass, n);
  return static_cast<double>(sum.sum());
}

void BladeKernel::give(const Vector3f& impulse, BladeNodes::Planes& momenta) const {
  for (size_t a = 0; a < 3; ++a) {
    const float part = impulse[static_cast<int>(a)];
    for (size_t i = 0; i < weights.size(); i += kLanes)
      Eigen::Map<Lanes>(momenta[a].data() + first + i) += part * at(weights, i);
  }
}

/// The gradient of a mean: of weights that are shares over a sum which changes too.
Eigen::Matrix3d BladeKernel::toRest(const BladeNodes& nodes) {
  is_new = false;
  if (weights.empty()) return Eigen::Matrix3d::Identity();
  Lanes3 by_x, by_y, by_z, mean;
  for (size_t i = 0; i < weights.size(); i += kLanes) {
    const size_t n = first + i;
    const Lanes x = at(nodes.rest_m[0], n) - centre_m_.x(), y = at(nodes.rest_m[1], n) - centre_m_.y(),
                z = at(nodes.rest_m[2], n) - centre_m_.z();
    const Lanes t = (1 - per_radius2_ * (x * x + y * y + z * z)).max(0.0f);
    const Lanes slope = 4 * per_radius2_ * at(nodes.share, n) * t;
    by_x.add(slope * x, nodes.u, n);
    by_y.add(slope * y, nodes.u, n);
    by_z.add(slope * z, nodes.u, n);
    mean.add(at(weights, i), nodes.u, n);
  }
  Eigen::Matrix3f gradient;
  gradient << by_x.sum(), by_y.sum(), by_z.sum();
  gradient = (gradient - mean.sum() * slope_sum_.transpose()) / sum_;
  const Eigen::Matrix3d deformed = Eigen::Matrix3d::Identity() + gradient.cast<double>();
  return deformed.determinant() > kFolded ? Eigen::Matrix3d(deformed.inverse()) : Eigen::Matrix3d::Identity();
}

}  // namespace viscera
