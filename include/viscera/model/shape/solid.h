// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace VISCERA_PUBLIC viscera {

/// Callback for the progress of a long preparation: stage name and fraction 0..1.
using Progress = std::function<void(const std::string& stage, double fraction)>;

/// Part of a cell that is tissue: integrals over it of 1, p and p p^T. p is the position relative to the cell's centre,
/// over the cell edge: -1/2 to 1/2 per axis.
struct CellFill {
  double share = 1;  ///< integral of 1: 0 to 1, or slightly more where a sliver of the next cell was added
  Vector3d first = Vector3d::Zero();             ///< integral of p
  Eigen::Matrix3d second = full().asDiagonal();  ///< integral of p p^T; symmetric

  /// Returns the diagonal of `second` for a cell that is completely filled.
  static Vector3d full() { return Vector3d::Constant(1.0 / 12); }
};

/// Cell that is partly filled with tissue.
struct PartialCell {
  size_t cell;  ///< Solid::index()
  CellFill fill;
};

/// Share of one part in a cell that several parts share.
struct PartFill {
  size_t cell;     ///< Solid::index(); in a lattice the slot of the cell's lowest corner
  uint16_t label;  ///< 1 + index into part_names
  CellFill fill;
};

/// Depth of a node below the true surface; negative outside.
struct NodeDepth {
  Vector3i node;  ///< node (i,j,k) is the lowest corner of cell (i,j,k)
  float depth_m;
  Eigen::Vector3f offset_m;  ///< vector to the nearest point of the surface for a node outside; else 0
};

/// Solid as labelled cubic cells on a regular grid, x fastest. Cell (i,j,k) spans origin + h*[i,i+1] x ...
struct Solid {
  double spacing_m = 0;
  Vector3d origin_m = Vector3d::Zero();  ///< corner of cell (0,0,0), tissue frame
  Vector3i cells = Vector3i::Zero();     ///< cells along x, y, z
  std::vector<uint16_t> labels;          ///< [cells.prod()] 0 empty, else 1 + index into part_names
  std::vector<std::string> part_names;
  std::vector<PartialCell> partial;  ///< labelled cells that are partly filled, ascending; all others are full
  std::vector<PartFill> shared;      ///< what each part fills of cells on the border of parts, by cell, then label
  std::vector<NodeDepth> depths;     ///< where some cells are partly filled: all nodes except those between full cells

  size_t index(int x, int y, int z) const {
    return static_cast<size_t>(x) + static_cast<size_t>(cells.x()) * (y + static_cast<size_t>(cells.y()) * z);
  }
  /// Returns the label of a cell; 0 outside the grid.
  uint16_t label(int x, int y, int z) const;
  size_t filledCells() const;
  /// Returns the volume of the tissue [m3]: partly filled cells count by their share.
  double volumeM3() const;
};

/// Decisions of voxelisation, for a person.
struct VoxelReport {
  double mesh_volume_m3 = 0;    ///< sum of |signed volume| of the parts
  double filled_volume_m3 = 0;  ///< volume of the solid's cells
  int holes_closed = 0;         ///< boundary loops that were capped
  int thin_cells = 0;           ///< cells filled because a wall is thinner than a cell
  int crumbs_removed = 0;       ///< tiny separate pieces that were emptied
  int parts_dropped = 0;        ///< parts that filled no cell
  std::vector<std::string> dropped_names;
  double dropped_surface = 0;  ///< surface area of the parts without a cell, over that of the mesh
  std::string text() const;
};

/// Fills the inside of a mesh with cells. docs/volumes.md specifies which cells, for meshes in any state.
/// @param spacing_m  cell edge [m], > 0
/// @throws LatticeError  spacing out of range: the grid would not fit in memory, or no cell is inside
/// @throws MeshError     the mesh encloses no volume
Solid voxelise(const TriangleMesh& mesh, double spacing_m, VoxelReport* report = nullptr,
               const Progress& progress = {});

/// Signed distance [m] (negative inside) and part index at a point [m].
struct LabelledDistance {
  double distance_m;
  uint16_t part;
};
using DistanceField = std::function<LabelledDistance(const Vector3d& point_m)>;

/// Fills the cells with a centre inside a distance field.
/// @throws LatticeError  spacing out of range: the grid would not fit in memory, or no cell is inside
Solid voxelise(const DistanceField& field, const std::vector<std::string>& part_names, const Vector3d& min_m,
               const Vector3d& max_m, double spacing_m, const Progress& progress = {});

/// Per axis, a coordinate [m] that a plane of nodes passes through; where it is missing, the grid is centred on the
/// body.
using NodePlanes = std::array<std::optional<double>, 3>;

/// Fills every cell that contains tissue, and computes the tissue's share of the cell and its moments. They are exact
/// up to rounding, or sampled where parts overlap within a cell (docs/volumes.md). Otherwise as voxelise().
Solid voxeliseByMoments(const TriangleMesh& mesh, double spacing_m, const NodePlanes& planes = {},
                        VoxelReport* report = nullptr, const Progress& progress = {});

/// Fills the cells of a field in the same way, from 5^3 samples of each cell near its surface: exact for flat faces.
Solid voxeliseByMoments(const DistanceField& field, const std::vector<std::string>& part_names, const Vector3d& min_m,
                        const Vector3d& max_m, double spacing_m, const NodePlanes& planes = {},
                        const Progress& progress = {});

/// Returns a solid box with its lower corner at `min_m`; sizes are rounded to whole cells, at least one.
/// @throws LatticeError  spacing out of range
Solid boxSolid(const Vector3d& min_m, const Vector3d& size_m, double spacing_m);

/// Returns the outer surface of a solid: with a field its isosurface by OpenVDB (smooth), without one the faces of the
/// cells. Triangles carry the part of the nearest cell. The surface is closed and oriented outwards.
TriangleMesh extractSkin(const Solid& solid);
TriangleMesh extractSkin(const DistanceField& field, const std::vector<std::string>& part_names, const Vector3d& min_m,
                         const Vector3d& max_m, double spacing_m);

/// Checks that a grid fits in memory.
/// @param cells  number of cells along x, y, z, of any size
/// @throws LatticeError  `cells` cells need more memory than the machine has free; names the spacing that fits
void requireGridMemory(const Eigen::Array3d& cells, double spacing_m);

}  // namespace viscera
