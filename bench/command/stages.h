// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>

#include "viscera/model/model.h"

namespace viscera {
struct Scene;
}

namespace viscera::bench {

/// Heads the columns of printStages().
void printStageNames(std::ostream& out);

/// Steps the scene on the GPU with a probe and a blade, maps its skin and draws it, and prints as CSV what each stage
/// takes by the GPU's own clock. @param scene  that the model was made of
void printStages(std::ostream& out, const Model& model, Scene scene);

}  // namespace viscera::bench
