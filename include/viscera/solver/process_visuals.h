// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "viscera/api.h"
#include "viscera/solver/visible_tube.h"

namespace VISCERA_PUBLIC viscera {

/// Paint on nodes of the tissue. A later kind covers an earlier one.
enum class PaintKind { kBurn, kBile, kBlood };

/// Strength of one paint on each node.
struct NodePaint {
  PaintKind kind = PaintKind::kBurn;
  std::vector<float> shares;  ///< [slots] kBurn: 0 fresh, 1 coagulated, 2 charred; fluids: 0 clean, 1 fluid only
};

/// Drawable state of the processes in the tissue, in addition to the tissue itself.
struct ProcessVisuals {
  VisibleTubes sutures;  ///< of all processes: strands, sutures and pieces of them, needles, clips
  /// In ascending order of their kinds. A paint that changed is a new object, so a comparison of pointers shows whether
  /// to draw again.
  std::vector<std::shared_ptr<const NodePaint>> paints;

  bool operator==(const ProcessVisuals& other) const { return sutures == other.sutures && paints == other.paints; }
};

}  // namespace viscera
