// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"
#include "viscera/model/scene/mark_config.h"
#include "viscera/surface/visible_mesh.h"

namespace VISCERA_PUBLIC viscera {

/// Point on a surface mesh at rest.
struct SkinPoint {
  std::array<uint32_t, 3> vertices{};  ///< corners of its triangle, as in VisibleMesh
  Vector3f weights = Vector3f::Zero();
  Vector3f rest_m = Vector3f::Zero();        ///< tissue frame
  Vector3f off_corner_m = Vector3f::Zero();  ///< from the corner of the largest weight, at rest
  float along_m = 0;                         ///< distance along the mark's line, at which its pattern is drawn
};

/// Line of a mark on the surface, through points less than a triangle apart; a single point is a dot.
struct MarkStroke {
  uint32_t mark = 0, body = 0;
  float half_width_m = 0;
  uint32_t patterns = kAllPatterns;  ///< bits, 1 << MarkPattern: patterns in which the stroke is drawn
  bool plain = false;                ///< whether its line is solid where the pattern is crossed
  std::vector<SkinPoint> points;

  static constexpr uint32_t kAllPatterns = 31;
};

struct MarkStyle {
  Vector3f color = Vector3f::Ones();  ///< sRGB, 0..1
  MarkPattern pattern = MarkPattern::kSolid;
};

/// Marks as they are shown. It never changes, so users share it.
struct VisibleMarks {
  std::shared_ptr<const std::vector<MarkStroke>> strokes;
  std::vector<MarkStyle> styles;  ///< [marks]
};

/// Straight piece of a mark's line on deformed tissue.
struct MarkPiece {
  uint32_t mark = 0;
  Vector3f from_m, to_m;  ///< tissue frame
  float width_m = 0;
};

/// Returns the lines of marks on deformed tissue, with their patterns, half of their width above the surface; a dot is
/// a short piece as wide as it is long. Where a cut has split a triangle, a point stays with the nearest corner, and
/// pieces across the gap are left out. @param mesh  with a topology
std::vector<MarkPiece> markPieces(const VisibleMarks& marks, const VisibleMesh& mesh);

}  // namespace viscera
