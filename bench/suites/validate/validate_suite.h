// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// What scenes make of measured silicone rubbers and of a sphere on a half space (docs/validation.md).
void validateSuite(Report& report);

}  // namespace viscera::bench
