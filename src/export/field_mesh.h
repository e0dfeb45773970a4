// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viscera/session/session.h"

namespace viscera {

/// Exported part of a session.
enum class ExportSource { kSkin, kLattice, kNetwork, kSutures };
/// Axes and unit of the output: those of the tissue frame (x forward, y left, z up, metres), or those of medical images
/// (x left, y back, z up, millimetres), for 3D Slicer, with the origin of the tissue's scan
/// (environment.scan_origin_m).
enum class ExportFrame { kRos, kLpsMm };

/// Numbers at points or in cells. Energies and stresses are in SI units in any frame.
struct MeshField {
  std::string name;
  int components = 1;
  std::vector<float> values;  ///< NaN where unknown
};

/// A moment of a session, as a mesh with fields.
struct FieldMesh {
  uint64_t tick = 0;
  double time_s = 0;
  uint32_t corners = 3;         ///< of a cell: 2 lines, 3 triangles, 8 hexahedra
  std::vector<float> points;    ///< [3 * points]
  std::vector<uint32_t> cells;  ///< [corners * cells] points
  std::vector<MeshField> of_points, of_cells;

  size_t pointCount() const { return points.size() / 3; }
  size_t cellCount() const { return cells.size() / corners; }
};

/// Returns the surface mesh with its fields. @param skin  of the session's last tick
FieldMesh skinFields(const Session& session, const VisibleMesh& skin);
FieldMesh latticeFields(const Session& session);  ///< its uncut cells
FieldMesh networkFields(const Session& session);  ///< its uncut springs
FieldMesh sutureFields(const Session& session);   ///< links of its sutures

/// Kinds of vectors: all are rotated; arrows are also scaled, places also get an origin.
enum class Vectors { kPositions, kArrows, kDirections };
/// Converts vectors of the tissue frame. @param scan_origin_m  see environment.scan_origin_m
void toFrame(ExportFrame frame, const Vector3d& scan_origin_m, Vectors what, std::vector<float>& vectors);
/// Converts points, and the fields that are lengths or speeds.
void toFrame(ExportFrame frame, const Vector3d& scan_origin_m, FieldMesh& mesh);

}  // namespace viscera
