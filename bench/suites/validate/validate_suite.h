// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Compares scenes with measured silicone rubbers and with a sphere on a half space (docs/verification.md).
void validateSuite(Report& report);

}  // namespace viscera::bench
