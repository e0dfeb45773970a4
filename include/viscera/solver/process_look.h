// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "viscera/solver/shown_thread.h"

namespace viscera {

/// What nodes of the tissue are painted with. A later one covers an earlier one.
enum class PaintKind { kBurn, kBlood };

/// How strongly each node is painted.
struct NodePaint {
  PaintKind kind = PaintKind::kBurn;
  std::vector<float> shares;  ///< [slots] of kBurn 0 fresh, 1 coagulated, 2 charred; of kBlood 0 clean, 1 blood alone
};

/// What is drawn of the processes in the tissue, beside the tissue itself.
struct ProcessLook {
  ShownThreads threads;  ///< threads and pieces of them, then needles, then clips
  /// In ascending order of their kinds. A paint that changed is another object, so pointers tell whether to draw again.
  std::vector<std::shared_ptr<const NodePaint>> paints;

  bool operator==(const ProcessLook& other) const { return threads == other.threads && paints == other.paints; }
};

}  // namespace viscera
