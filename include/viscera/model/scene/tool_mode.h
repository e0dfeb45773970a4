// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

/// Action of a tool; src/model/scene/tool_kinds.h has a row for each.
enum class ToolMode {
  kNone = 0,
  kProbe = 1,
  kGrab = 2,
  kCut = 3,
  kCutParticles = 4,
  kSuction = 5,
  kNeedle = 6,
  kScissors = 7,
  kGrasper = 8,
  kClip = 9,
  kCautery = 10
};

}  // namespace viscera
