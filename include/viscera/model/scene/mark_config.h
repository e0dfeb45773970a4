// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

enum class MarkKind { kLine, kCircle, kRing, kTarget };

/// Pattern in which a mark's lines are drawn. Patterns differ without colours too.
enum class MarkPattern { kSolid, kDashed, kDouble, kCrossed, kThin };

/// Point of a mark's line.
struct MarkPoint {
  Vector3d position_m = Vector3d::Zero();
};

/// Mark that is drawn on the surface of tissue and moves with it. Positions are in the rest shape, tissue frame.
struct MarkConfig {
  std::string body;  ///< name of the body; empty: the one with the nearest surface
  MarkKind kind = MarkKind::kLine;
  std::vector<MarkPoint> path;           ///< line: its points, at least two
  Vector3d center_m = Vector3d::Zero();  ///< circle, ring and target: the centre
  Vector3d normal = Vector3d::Zero();    ///< normal of its plane; 0: that of the surface
  double radius_m = 0.005;
  double width_m = 0.001;
  Vector3d color = Vector3d(0.94, 0.89, 0.26);
  MarkPattern pattern = MarkPattern::kSolid;
};

}  // namespace viscera
