// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "viscera/model/scene.h"
#include "viscera/model/solid.h"

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
  /// Box that the body lies in [m].
  virtual Eigen::AlignedBox3d bounds() const = 0;

  std::vector<std::string> notes;  ///< what reading it had to decide
};

/// @param folder  where a relative mesh_file is looked up
/// @throws MeshError   a mesh file that cannot be used
/// @throws SceneError  skin: input without a mesh
std::unique_ptr<Tissue> makeTissue(const BodyConfig& config, const std::string& folder);

/// Pose of the body's frame in the tissue frame.
Pose bodyPose(const BodyConfig& config);

}  // namespace viscera
