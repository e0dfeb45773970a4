// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

/// List of "key=value" as given on the command line or in a launch file; the key is a path such as bodies[0].spacing_m.
using Overrides = std::vector<std::string>;

}  // namespace viscera
