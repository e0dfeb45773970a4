// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "render/tube_painter.h"

namespace viscera {

struct Scene;

/// Returns the appearance of a scene's sutures: their own width, and the colour of their material. Then that of
/// needles, and of clips where a stylus sets them.
std::vector<TubeStyle> stylesOf(const Scene& scene);

}  // namespace viscera
