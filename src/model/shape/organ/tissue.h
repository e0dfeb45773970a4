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

/// Solid, and one line on how it was made, or an empty one.
struct Filling {
  Solid solid;
  std::string note;
};

/// Geometry of one body in the tissue frame, before it is divided into cells.
class Tissue {
 public:
  virtual ~Tissue() = default;

  /// Fills the body with cells. @throws LatticeError, MeshError  as voxelise()
  virtual Filling fill(double spacing_m, const Progress& progress) const = 0;
  /// Returns the best available surface for a lattice made of `solid`.
  virtual TriangleMesh surface(const Solid& solid) const = 0;
  /// Returns the surface as a membrane, with edges of at most or about `spacing_m`.
  /// @throws LatticeError  spacing out of range
  virtual TriangleMesh shell(double spacing_m) const = 0;
  /// Returns the bounding box of the body [m].
  virtual Eigen::AlignedBox3d bounds() const = 0;

  /// Returns walls of known thickness in which larger cells leave holes, the thinnest first.
  virtual std::vector<Wall> walls() const { return {}; }

  /// Returns the paint on its surface; empty without paint.
  virtual PlacedPaint paint() const { return {}; }

  std::vector<std::string> notes;  ///< decisions made while reading it
  Pose file_pose;                  ///< pose of the contents of this body's mesh files, in the tissue frame
};

/// Creates the tissue of a body.
/// @param folder  folder for a relative mesh_file
/// @throws MeshError   a mesh file that cannot be used
/// @throws SceneError  a source that cannot be made into the requested structure, see structureFault()
std::unique_ptr<Tissue> makeTissue(const BodyConfig& config, const std::string& folder);

/// Checks the size of a membrane.
/// @throws LatticeError  a membrane of this area would have too many nodes at this spacing, or the spacing is invalid
void requireShell(double area_m2, double spacing_m);

/// Returns the pose of the body's frame in the tissue frame.
Pose bodyPose(const BodyConfig& config);

}  // namespace viscera
