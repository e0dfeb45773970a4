// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

namespace viscera::python {

void bindVector(pybind11::module_& module);

}  // namespace viscera::python
