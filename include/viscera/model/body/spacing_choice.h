// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "viscera/model/model.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

struct Scene;

class Tissue;

/// The bodies of a scene before they are divided into cells, for those who look for a spacing: meshes are read once.
class UndividedBodies {
 public:
  /// @throws MeshError, SceneError  as buildModel()
  explicit UndividedBodies(const Scene& scene);
  ~UndividedBodies();

  /// Nodes that the bodies with `spacing_m: auto` have together. @throws LatticeError  spacing out of range
  size_t nodes(double spacing_m) const;
  /// A spacing that gives these bodies about as many nodes, within some 20 %.
  double spacingOf(size_t nodes) const;
  /// Edge that a spacing should divide into whole cells, so that regions at the border of a box find its nodes [m]: the
  /// longest one of the first of these bodies if it is a box that is not turned, else 0.
  double wholeEdge_m() const;
  /// Thickness of the thinnest wall that these bodies are known to have [m]: a coarser lattice has holes there.
  /// Infinity where none is known.
  double thinnestWall_m() const;
  /// Lattices to measure with: no skin, nothing fixed. @throws LatticeError  spacing out of range
  Model lattices(double spacing_m) const;  ///< of the bodies with `spacing_m: auto`
  Model others() const;                    ///< of all others, at their own spacings

 private:
  struct Draft {
    BodyConfig config;
    std::unique_ptr<Tissue> tissue;
  };
  std::vector<Draft> auto_, others_;
};

/// How long a substep takes: overhead_s + per_node_s * nodes.
struct StepTime {
  double overhead_s = 0, per_node_s = 0;
  double of(double nodes) const { return overhead_s + per_node_s * nodes; }
};

/// What a lattice has to keep to.
struct SpacingLimits {
  StepTime step;
  double stepping_share = 1;                               ///< wall-clock seconds for steps, per simulated second
  std::function<double(double spacing_m)> substeps_per_s;  ///< of simulated time
  size_t other_nodes = 0;                                  ///< nodes of bodies whose spacing is given
  double whole_m = 0;   ///< edge to divide into whole cells; 0: spacings have three digits
  double finest_m = 0;  ///< the solver accepts none that is finer
  double coarsest_m = std::numeric_limits<double>::infinity();  ///< tissue has holes at any that is coarser
  size_t most_nodes = 4000000;  ///< of all bodies: beyond, preparing a scene takes minutes
};

enum class SpacingBound { kSpeed, kNodes, kSolver, kMemory, kTooSlow, kWalls };

struct SpacingChoice {
  double spacing_m = 0;
  size_t nodes = 0;  ///< of all bodies
  double substeps_per_s = 0;
  double load = 0;  ///< seconds that stepping takes, over those that it may take
  /// Why it is not finer. kTooSlow: no lattice worth the name is stepped fast enough; this is the coarsest. kWalls:
  /// no lattice without holes is.
  SpacingBound bound = SpacingBound::kSpeed;
};

/// The finest lattice that keeps to the limits: substeps_per_s(h) * (overhead + per_node * nodes(h)), some h^-4, is at
/// most stepping_share.
/// @param nodes    counts those of the bodies to be divided; LatticeError: it does not fit in memory
/// @param start_m  a coarse spacing, where the search begins
SpacingChoice chooseSpacing(const std::function<size_t(double spacing_m)>& nodes, double start_m,
                            const SpacingLimits& limits, const Progress& progress = {});

}  // namespace viscera
