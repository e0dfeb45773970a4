// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "viscera/api.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {  // internal
class Tissue;
}  // namespace viscera

namespace VISCERA_PUBLIC viscera {

struct Scene;

/// Bodies of a scene before they are divided into cells, for the search for a spacing: each mesh is read once.
class VISCERA_PUBLIC UndividedBodies {
 public:
  /// @throws MeshError, SceneError  as buildModel()
  explicit UndividedBodies(const Scene& scene);
  ~UndividedBodies();

  /// Returns the number of nodes of all bodies with `spacing_m: auto`. @throws LatticeError  spacing out of range
  size_t nodes(double spacing_m) const;
  /// Returns a spacing that gives these bodies about this many nodes, within about 20 %.
  double spacingOf(size_t nodes) const;
  /// Returns the edge that a spacing should divide into whole cells [m], so that fixed regions at the border of a box
  /// contain nodes: the longest edge of the first of these bodies if it is a box without rotation, else 0.
  double wholeEdge_m() const;
  /// Returns the thickness of the thinnest known wall of these bodies [m]: a coarser lattice has holes there. Infinity
  /// where none is known.
  double thinnestWall_m() const;
  /// Builds lattices for measurements: no surface mesh, no fixed nodes. @throws LatticeError  spacing out of range
  Model lattices(double spacing_m) const;  ///< bodies with `spacing_m: auto`
  Model others() const;                    ///< all other bodies, at their own spacings

 private:
  struct Draft {
    BodyConfig config;
    std::unique_ptr<Tissue> tissue;
  };
  std::vector<Draft> auto_, others_;
};

/// Duration of a substep: overhead_s + per_node_s * nodes.
struct StepTime {
  double overhead_s = 0, per_node_s = 0;
  double of(double nodes) const { return overhead_s + per_node_s * nodes; }
};

/// Limits on a lattice.
struct SpacingLimits {
  StepTime step;
  double stepping_share = 1;  ///< wall-clock seconds available for steps, per simulated second
  std::function<double(double spacing_m)> substeps_per_s;  ///< substeps per simulated second at a spacing
  size_t other_nodes = 0;                                  ///< number of nodes of bodies with a given spacing
  double whole_m = 0;   ///< edge to divide into whole cells [m]; 0: the spacing is rounded to three digits
  double finest_m = 0;  ///< finest spacing that the solver accepts [m]
  double coarsest_m = std::numeric_limits<double>::infinity();  ///< coarsest spacing at which tissue has no holes [m]
  size_t most_nodes = 4000000;  ///< largest number of nodes of all bodies: above it, preparing a scene takes minutes
};

enum class SpacingBound { kSpeed, kNodes, kSolver, kMemory, kTooSlow, kWalls };

struct SpacingChoice {
  double spacing_m = 0;
  size_t nodes = 0;  ///< number of nodes of all bodies
  double substeps_per_s = 0;
  double load = 0;  ///< time that stepping takes, over the time available for it
  /// Reason why the spacing is not finer. kTooSlow: even the coarsest usable lattice is too slow; this is it. kWalls:
  /// every lattice without holes is too slow.
  SpacingBound bound = SpacingBound::kSpeed;
};

/// Returns the finest spacing that keeps to the limits: substeps_per_s(h) * (overhead + per_node * nodes(h)), which
/// grows about as h^-4, is at most stepping_share.
/// @param nodes    counts the nodes of the bodies to be divided; it throws LatticeError if they do not fit in memory
/// @param start_m  a coarse spacing [m], where the search begins
SpacingChoice chooseSpacing(const std::function<size_t(double spacing_m)>& nodes, double start_m,
                            const SpacingLimits& limits, const Progress& progress = {});

}  // namespace viscera
