// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/layout/obstacle_motion.h"
#include "viscera/model/model.h"

namespace viscera {

struct Scene;

/// What a scene has that the kernels of either backend must know of. The rest costs nothing: on the GPU it is compiled
/// out, and nowhere does it have an array.
struct FeatureSet {
  bool lattice = true;   ///< some body has implicit connections
  bool network = false;  ///< some body has explicit ones
  bool dashpot = false;
  bool predicted = false;    ///< a lattice of springs has dashpots: leapfrog has its springs pull where nodes will be
  bool law = false;          ///< the cells of some body obey a hyperelastic law
  bool prestress = false;    ///< some of these cells are stressed at rest
  bool laminates = false;    ///< some of these cells are of two materials
  bool walls = false;        ///< some of these cells lie in thin walls: second derivatives by rows of nodes
  bool springs = true;       ///< something is made of springs: not all bodies obey one
  bool parts = false;        ///< strengths differ within a body
  bool compensated = false;  ///< u and v are summed with Kahan's compensation
  bool tools = false;        ///< there are styluses
  bool cuts = false;       ///< one of them may cut or erase, or tissue tears: lattices keep a record of it (CutRecord)
  bool tears = false;      ///< some lattice is pulled apart by energy; CPU backend
  uint32_t obstacles = 0;  ///< how many there are
  bool single_body = false;
  uint32_t group_size = layout::kGroupSize;

  std::vector<std::string> defines() const;
};

/// Contacts that a node may have at once with styluses and obstacles within an implicit integrator.
uint32_t contactRows(bool tools, uint32_t obstacles);

/// @param dt_s  shortest substep   @param group_size  invocations per group, on the GPU
FeatureSet featuresOf(const Model& model, const Scene& scene, double dt_s, uint32_t group_size = layout::kGroupSize);

}  // namespace viscera
