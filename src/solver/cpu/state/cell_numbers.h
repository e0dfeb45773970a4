// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "solver/cpu/simd/kernels.h"
#include "solver/tissue/joined_lattice.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {

/// Returns a component of LawMoments (law-inl.h).
/// @param m  first, square and mixed moments
/// @param v  which of them
/// @param c  component, 0..2
inline float lawMoment(const layout::vec4* m, size_t v, size_t c) {
  const auto of = [](const layout::vec4& vector, size_t i) { return i == 0 ? vector.x : i == 1 ? vector.y : vector.z; };
  if (v == 0) return 2 * of(m[0], c);
  const size_t a = v == 1 ? c : (c + 1) % 3, b = v == 1 ? c : (c + 2) % 3;
  return 4 * (of(m[v], c) - of(m[0], a) * of(m[0], b));
}

using LaminateNumbers = std::array<float, simd::kLaminateNumbers>;
/// Returns the numbers of a cell with two materials for the kernels; for other cells, two equal layers.
inline LaminateNumbers laminateNumbers(const JoinedMoments& moments, const Strengths& table, uint32_t slot) {
  const layout::vec4* l = moments.laminateOf(slot);
  if (l != nullptr) return {l[0].x, l[0].y, l[0].z, l[0].w, l[1].x, l[1].y, l[1].z, l[1].w};
  const float rigidity = table.rigidity_j[slot];
  const float bulk = 5.0f / 3 + (rigidity > 0 ? table.bulk_j[slot] / rigidity : 0);
  return {1, 0, 0, 1, 1, 1, bulk, bulk};
}

}  // namespace viscera
