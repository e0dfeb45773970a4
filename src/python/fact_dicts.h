// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include "viscera/solver/facts.h"

namespace viscera::python {

/// Adds a dict per group, under its name: of values, lists of numbers and lists of dicts, as in metrics.json.
void addFacts(const FactGroups& groups, pybind11::dict& out);

}  // namespace viscera::python
