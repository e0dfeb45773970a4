// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera {

struct Scene;

/// All keys of a scene with the values that they have, one `key=value` a line, numbers to the bit: two scenes with the
/// same text are the same but for what their files hold.
std::string sceneText(const Scene& scene);

}  // namespace viscera
