// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "bench/harness/report.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

/// A suite of measurements.
struct Suite {
  const char* name;
  const char* what;                                    ///< one line for --help
  void (*run)(Report& report, gpu::Context* context);  ///< the context is current
  bool takes_backend = false;      ///< measures on the report's backends; the context is null without the GPU
  bool has_parts = takes_backend;  ///< uses measureParts()
  bool takes_data = false;         ///< uses Report::data()
  bool takes_sizes = false;        ///< uses Report::nodes(), scene(), overrides(), threads()
  bool needs_gpu = !takes_data;    ///< for suites that do not take a backend; otherwise they run on the CPU only
};

/// Returns all suites. A new one needs an include and a line in suites.cpp.
const std::vector<Suite>& suites();

/// Runs a suite including its checks.
/// @param backend  cpu, gpu or both (see machineFor), for suites that take one   @param device  of EGL, or -1: the best
/// @return number of failed checks   @throws Error
int runSuite(const Suite& suite, SuiteOptions options, const std::string& backend, int device, std::ostream& out);

}  // namespace viscera::bench
