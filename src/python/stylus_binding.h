// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include "viscera/tools/stylus.h"

namespace viscera::python {

void bindStylus(pybind11::module_& module);
/// A stylus that is there. @param position_m, quaternion  3 numbers; x, y, z, w   @throws ValueError
StylusSample sampleOf(const double* position_m, const double* quaternion);
/// @param given  None, a Stylus, or a sequence of these: one for each of the scene's at most
/// @throws ValueError, TypeError
StylusSamples samplesOf(const pybind11::object& given, size_t styluses);

}  // namespace viscera::python
