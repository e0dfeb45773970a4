// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/restored_tools.h"

#include <string>

#include "model/scene/tool_kinds.h"

namespace viscera {

void requireMode(const Archive& archive, ToolMode mode) {
  const auto number = static_cast<uint32_t>(mode);
  if (number >= kToolKindCount) {
    archive.require(false, "a tool's mode is " + std::to_string(number) + "; 0 .. " +
                               std::to_string(kToolKindCount - 1) + " is accepted");
  }
}

void requireModes(const Archive& archive, const ToolMotions& motions) {
  for (const StylusMotion& motion : motions) {
    requireMode(archive, motion.mode);
    requireMode(archive, motion.hold_ended);
  }
}

}  // namespace viscera
