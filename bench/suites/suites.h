// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/report.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

/// One suite of measurements.
struct Suite {
  const char* name;
  const char* what;                                    ///< one line for --help
  void (*run)(Report& report, gpu::Context* context);  ///< the context is current
  bool takes_backend = false;      ///< measures on the report's backends; the context is null where the GPU is not one
  bool has_parts = takes_backend;  ///< measureParts()
  bool takes_data = false;         ///< Report::data()
  bool takes_sizes = false;        ///< Report::nodes(), scene(), overrides(), threads()
  bool needs_gpu = !takes_data;    ///< where it does not take a backend; else it is measured on the processor alone
};

/// All suites: a new one is an include and a line in suites.cpp.
const std::vector<Suite>& suites();

/// Runs a suite from its first line to its checks.
/// @param backend  cpu, gpu or both (see machineFor); of suites that take one   @param device  of EGL, or -1: the best
/// @return checks that were missed   @throws Error
int runSuite(const Suite& suite, SuiteOptions options, const std::string& backend, int device, std::ostream& out);

}  // namespace viscera::bench
