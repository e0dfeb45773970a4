// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/blade_kernel.h"

#include <Eigen/LU>

namespace viscera {

namespace {

constexpr double kFolded = 0.1;  // determinant of F below which a front goes as if the tissue were rigid

}  // namespace

void BladeKernel::make(const RestTissue& tissue, const Vector3d& centre_m, double radius_m) {
  nodes.clear();
  weights.clear();
  mobilities.clear();
  slopes.clear();
  lean.setZero();
  is_new = true;
  const double r2 = radius_m * radius_m;
  double sum = 0;
  Vector3d slope_sum = Vector3d::Zero();
  tissue.forEachNear(centre_m, radius_m, [&](uint32_t n) {
    const RestTissue::Node& node = tissue.nodes()[n];
    const Vector3d away = node.rest_m - centre_m;
    const double t = 1 - away.squaredNorm() / r2, weight = node.share * t * t;
    const Vector3d slope = node.share * 4 * t / r2 * away;
    nodes.push_back(n);
    weights.push_back(static_cast<float>(weight));
    slopes.emplace_back(slope.cast<float>());
    sum += weight;
    slope_sum += slope;
    lean += weight * away;
  });
  if (!(sum > 0)) {
    nodes.clear();
    weights.clear();
    slopes.clear();
    return;
  }
  lean /= sum;
  for (size_t a = 0; a < nodes.size(); ++a) {
    weights[a] = static_cast<float>(weights[a] / sum);
    mobilities.push_back(weights[a] * tissue.nodes()[nodes[a]].inverse_mass);
    const Vector3d slope = (slopes[a].cast<double>() - weights[a] * slope_sum) / sum;
    slopes[a] = slope.cast<float>();
  }
}

void BladeKernel::means(const std::vector<Vector3f>& a, const std::vector<Vector3f>& b, Vector3d& mean_a,
                        Vector3d& mean_b) const {
  Vector3f sum_a = Vector3f::Zero(), sum_b = Vector3f::Zero();
  for (size_t i = 0; i < nodes.size(); ++i) {
    sum_a += weights[i] * a[places[i]];
    sum_b += weights[i] * b[places[i]];
  }
  mean_a = sum_a.cast<double>();
  mean_b = sum_b.cast<double>();
}

Eigen::Matrix3d BladeKernel::toRest(const std::vector<Vector3f>& u_m) {
  Eigen::Matrix3f f = Eigen::Matrix3f::Identity();
  for (size_t a = 0; a < nodes.size(); ++a) f += u_m[places[a]] * slopes[a].transpose();
  const Eigen::Matrix3d deformed = f.cast<double>();
  is_new = false;
  return deformed.determinant() > kFolded ? Eigen::Matrix3d(deformed.inverse()) : Eigen::Matrix3d::Identity();
}

}  // namespace viscera
