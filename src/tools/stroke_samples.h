// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/tools/strokes.h"

namespace viscera {

/// Returns a sample as a line of text: tick, position [m], orientation x y z w, buttons, and the opening of jaws if
/// known [rad]. It has enough digits to read the same doubles back.
std::string sampleLine(const Stroke::Sample& sample);

/// Parses samples from such lines.
/// @param first_line  of the text in the file, for errors
/// @throws StrokesError  file, line and what a line must contain
std::vector<Stroke::Sample> parseSamples(const std::string& text, const std::string& file, int first_line);

}  // namespace viscera
