// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/shape/detail/detail_paint.h"
#include "model/shape/organ/phantom.h"
#include "viscera/model/scene/body_config.h"
#include "viscera/model/shape/solid.h"

namespace viscera {

/// A solid and, where there is something to say, one line about how it came about.
struct Filling {
  Solid solid;
  std::string note;
};

/// The geometry of one body in the tissue frame, before it is divided into cells.
class Tissue {
 public:
  virtual ~Tissue() = default;

  /// @throws LatticeError, MeshError  as voxelise()
  virtual Filling fill(double spacing_m, const Progress& progress) const = 0;
  /// The best surface there is, for a lattice made of `solid`.
  virtual TriangleMesh surface(const Solid& solid) const = 0;
  /// The surface as a membrane, with edges of at most or about `spacing_m`.
  /// @throws LatticeError  spacing out of range
  virtual TriangleMesh shell(double spacing_m) const = 0;
  /// Box that the body lies in [m].
  virtual Eigen::AlignedBox3d bounds() const = 0;

  /// Walls of known thickness in which cells that are larger leave holes, the thinnest first.
  virtual std::vector<Wall> walls() const { return {}; }

  /// What is painted on its skin; without paint: nothing.
  virtual PlacedPaint paint() const { return {}; }

  std::vector<std::string> notes;  ///< what reading it had to decide
  Pose file_pose;                  ///< of what mesh files of this body hold, in the tissue frame
};

/// @param folder  where a relative mesh_file is looked up
/// @throws MeshError   a mesh file that cannot be used
/// @throws SceneError  a source that cannot be made into the structure asked for, see structureFault()
std::unique_ptr<Tissue> makeTissue(const BodyConfig& config, const std::string& folder);

/// @throws LatticeError  a membrane of this area would have too many nodes at this spacing, or the spacing is none
void requireShell(double area_m2, double spacing_m);

/// Pose of the body's frame in the tissue frame.
Pose bodyPose(const BodyConfig& config);

}  // namespace viscera
