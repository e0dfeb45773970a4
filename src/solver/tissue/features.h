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

/// Features of a scene that the kernels of either backend need. The others cost nothing: on the GPU they are compiled
/// out, and no backend has an array for them.
struct FeatureSet {
  bool lattice = true;   ///< some body has implicit connections
  bool network = false;  ///< some body has explicit ones
  bool dashpot = false;
  bool predicted = false;    ///< a lattice of springs has dashpots: leapfrog takes spring forces at predicted positions
  bool law = false;          ///< the cells of some body obey a hyperelastic law
  bool prestress = false;    ///< some of these cells are stressed at rest
  bool laminates = false;    ///< some of these cells have two materials
  bool walls = false;        ///< some of these cells are in thin walls: second derivatives by rows of nodes
  bool springs = true;       ///< something is made of springs: not all bodies obey a law
  bool parts = false;        ///< strengths vary within a body
  bool compensated = false;  ///< u and v are summed with Kahan's compensation
  bool tools = false;        ///< there are styluses
  bool shafts = false;       ///< tissue meets the shaft of some stylus
  bool cuts = false;         ///< a stylus may cut or erase, or tissue tears: lattices keep a record of cuts (CutRecord)
  bool tears = false;        ///< some lattice tears by energy; CPU backend
  uint32_t obstacles = 0;    ///< number of obstacles
  bool single_body = false;
  uint32_t group_size = layout::kGroupSize;

  std::vector<std::string> defines() const;
};

/// Returns the number of contacts that a node may have at once with styluses and obstacles in an implicit integrator.
uint32_t contactRows(bool tools, uint32_t obstacles);

/// Returns the features of a scene. @param dt_s  shortest substep [s]   @param group_size  invocations per group, on
/// the GPU
FeatureSet featuresOf(const Model& model, const Scene& scene, double dt_s, uint32_t group_size = layout::kGroupSize);

}  // namespace viscera
