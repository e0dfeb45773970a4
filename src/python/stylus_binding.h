// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include "viscera/tools/stylus.h"

namespace viscera::python {

void bindStylus(pybind11::module_& module);
/// Returns a valid sample. @param position_m, quaternion  3 numbers; x, y, z, w   @throws ValueError
StylusSample sampleOf(const double* position_m, const double* quaternion);
/// Returns the samples. @param given  None, a Stylus, or a sequence of at most one for each stylus of the scene
StylusSamples samplesOf(const pybind11::object& given, size_t styluses);

}  // namespace viscera::python
