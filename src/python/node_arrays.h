// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "viscera/model/model.h"
#include "viscera/session/frame.h"
#include "viscera/solver/state.h"

namespace viscera::python {

/// Slots of all bodies that have a node.
std::vector<uint32_t> activeSlots(const Model& model);
/// [3 * slots] m, tissue frame; NaN where there is no node.
std::vector<float> restPositions(const Model& model);
/// The same of a state.
std::vector<float> positions(const Model& model, const HostState& state);
/// [6 * styluses] force and torque.
std::vector<double> wrenchesOf(const Frame& frame, size_t styluses);

}  // namespace viscera::python
