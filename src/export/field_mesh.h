// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viscera/session/session.h"

namespace viscera {

/// What is taken out of a session.
enum class ExportSource { kSkin, kLattice, kNetwork, kThreads };
/// Axes and unit of what is written: those of the tissue frame (x forward, y left, z up, metres), or those of medical
/// images (x left, y back, z up, millimetres), which 3D Slicer wants, with the origin of the scan that the tissue is
/// from (environment.scan_origin_m).
enum class ExportFrame { kRos, kLpsMm };

/// Numbers at points or in cells. Energies and stresses are in SI units whatever the frame.
struct MeshField {
  std::string name;
  int components = 1;
  std::vector<float> values;  ///< NaN where it is not known
};

/// A moment of a session as programs that show fields take it.
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

/// @param skin  of the session's last tick
FieldMesh skinFields(const Session& session, const ShownMesh& skin);
FieldMesh latticeFields(const Session& session);  ///< its whole cells, those that a cut tore left out
FieldMesh networkFields(const Session& session);  ///< its springs, those that are cut left out
FieldMesh threadFields(const Session& session);   ///< links of its threads

/// Of three numbers: they are turned; arrows have a unit besides, places an origin too.
enum class Vectors { kPlaces, kArrows, kDirections };
/// Of the tissue frame, in another one. @param scan_origin_m  see environment.scan_origin_m
void toFrame(ExportFrame frame, const Vector3d& scan_origin_m, Vectors what, std::vector<float>& vectors);
/// Points and the fields that are lengths or speeds.
void toFrame(ExportFrame frame, const Vector3d& scan_origin_m, FieldMesh& mesh);

}  // namespace viscera
