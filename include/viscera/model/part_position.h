// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

struct Model;

/// Position relative to a part of the tissue at rest, for strokes and tasks that hold for other anatomies.
struct PartPosition {
  std::string part;                      ///< name of a part of a lattice, or of a body; empty: no such position
  std::string from;                      ///< name of the part at which `along` is 0; empty: the middle of the part
  double along = 0.5;                    ///< share of the part's length, measured within the part, 0 to 1
  Vector3d offset_m = Vector3d::Zero();  ///< added to the position, tissue frame [m]
  bool given = false;                    ///< a file has these keys
};

/// Returns the position in the tissue at rest [m, tissue frame]: the mean of the part's nodes at that length. Of a part
/// in several pieces the largest counts.
/// @throws Error  no lattice has the part, or `from`
Vector3d positionOf(const Model& model, const PartPosition& position);

}  // namespace viscera
