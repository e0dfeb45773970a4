// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/fields.h"

#include <algorithm>

namespace viscera {

double largestNorm(const Field& field) {
  double largest = 0;
  for (const Vector3d& v : field) largest = std::max(largest, v.norm());
  return largest;
}

double largestComponent(const Field& field) {
  double largest = 0;
  for (const Vector3d& v : field) largest = std::max(largest, v.lpNorm<Eigen::Infinity>());
  return largest;
}

}  // namespace viscera
