// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/model/model.h"

namespace viscera {

/// What the kernels must know of; everything else is compiled out and has no buffer.
struct FeatureSet {
  bool lattice = true;       ///< some body has implicit connections
  bool network = false;      ///< some body has explicit ones
  bool edge_forces = false;  ///< leapfrog: of explicit connections edge by edge
  bool dashpot = false;
  bool volume = false;       ///< some cell has an energy of volume: nu other than 1/4
  bool parts = false;        ///< strengths differ within a body
  bool compensated = false;  ///< u and v are summed with Kahan's compensation
  bool tools = false;        ///< there are styluses
  bool single_body = false;
  uint32_t group_size = layout::kGroupSize;

  std::vector<std::string> defines() const;
};

/// @param dt_s  shortest substep
FeatureSet featuresOf(const Model& model, const Scene& scene, double dt_s, uint32_t group_size);

}  // namespace viscera
