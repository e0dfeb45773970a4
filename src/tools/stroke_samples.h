// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/tools/strokes.h"

namespace viscera {

/// A sample as a line of text: tick, position [m], orientation x y z w, buttons, the opening of jaws if it is known
/// [rad]; so many digits that the same doubles are read back.
std::string sampleLine(const Stroke::Sample& sample);

/// Samples as such lines.
/// @param first_line  of the text in the file, for errors
/// @throws StrokesError  file, line and what a line must hold
std::vector<Stroke::Sample> parseSamples(const std::string& text, const std::string& file, int first_line);

}  // namespace viscera
