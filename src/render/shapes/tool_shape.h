// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/scene/tool_mode.h"

namespace viscera {

struct StylusConfig;

/// Vertex of a drawn tool, as the GPU takes it.
struct ToolVertex {
  std::array<float, 3> position_m;  ///< stylus frame
  std::array<float, 3> normal;      ///< unit, outwards
  std::array<uint8_t, 4> color;     ///< sRGB; alpha 255 is solid, less is an outline that the tissue shows through
};

/// Triangles of a drawn tool, counter-clockwise seen from outside.
struct ToolShape {
  std::vector<ToolVertex> vertices;
  std::vector<uint32_t> indices;  ///< solid triangles, then translucent ones
  size_t solid_indices = 0;
};

/// Returns the drawn shape of a stylus in a mode: a shaft from the tip backwards (+z), a collar in the mode's colour,
/// and the tip in its true size: the probe's sphere, jaws, the blade, the capsule of the particle eraser. Around the
/// tip of a tool that holds it adds the sphere of its reach. kNone is the shaft alone. See kToolKinds.
/// @param opening_rad  angle between the fingers of tools with jaws: StylusMotion::opens_to_rad
ToolShape toolShape(const StylusConfig& stylus, ToolMode mode, double opening_rad = 0);

/// Returns the same without its fingers, which move; the next function returns one finger, that towards +x, along the
/// axis as when closed.
ToolShape toolWithoutFingers(const StylusConfig& stylus, ToolMode mode);
ToolShape fingerShape(const StylusConfig& stylus, ToolMode mode);
/// Returns the poses of the two fingers in the stylus frame.
std::array<Pose, 2> fingerPoses(const StylusConfig& stylus, ToolMode mode, double opening_rad);

}  // namespace viscera
