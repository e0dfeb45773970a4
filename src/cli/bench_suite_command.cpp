// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "cli/commands.h"

namespace viscera::cli {

int benchSuite(const bench::Suite& suite, const BenchSuiteOptions& options) {
  const int missed = bench::runSuite(suite, options.suite, options.device, std::cout);
  return options.strict && missed > 0 ? 1 : 0;
}

}  // namespace viscera::cli
