// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/model/model.h"
#include "viscera/session/frame.h"
#include "viscera/solver/state.h"

namespace viscera::python {

/// Returns the slots of all bodies that have a node.
std::vector<uint32_t> activeSlots(const Model& model);
/// Returns [3 * slots] rest positions, m, tissue frame; NaN without a node.
std::vector<float> restPositions(const Model& model);
/// Returns the positions of a state in the same format.
std::vector<float> positions(const Model& model, const HostState& state);
/// Returns [6 * styluses] force and torque.
std::vector<double> wrenchesOf(const Frame& frame, size_t styluses);

}  // namespace viscera::python
