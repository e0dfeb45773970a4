// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "model/shape/solid/solid_volumes.h"

namespace viscera {

// How deep the nodes around cells that are tissue in part lie below the true surface: what touches the body has to
// know, as nodes outside of it reach up to a cell's diagonal beyond.

/// To the nearest triangle of any part: exact, but too little where a part ends inside another one.
void measureDepths(const std::vector<Volume>& volumes, Solid& solid);
/// By the field itself, as exact as that is a distance.
void measureDepths(const DistanceField& field, Solid& solid);

}  // namespace viscera
