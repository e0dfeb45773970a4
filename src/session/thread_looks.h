// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "render/thread_painter.h"

namespace viscera {

struct Scene;

/// How the threads of a scene are drawn: in their own width, and the colour of their material. Behind them needles, and
/// clips where a stylus sets them.
std::vector<ThreadLook> looksOf(const Scene& scene);

}  // namespace viscera
