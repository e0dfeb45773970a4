// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites.h"

#include <chrono>

#include "bench/accuracy_suite.h"
#include "bench/material_suite.h"
#include "bench/stability_suite.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all = {
      {"material", "does the lattice have the elasticity that was asked for?", materialSuite},
      {"accuracy", "what do substeps and float32 cost in error, and error in time?", accuracySuite},
      {"stability", "does tissue stay finite and bounded whatever is done to it?", stabilitySuite},
  };
  return all;
}

int runSuite(const Suite& suite, const SuiteOptions& options, int device, std::ostream& out) {
  const auto start = std::chrono::steady_clock::now();
  const gpu::Context context(device);
  Report report(suite.name, options, out);
  report.note(std::string("viscera bench ") + suite.name + (options.short_form ? " --short" : "") + ", on " +
              context.renderer() + "\n");
  suite.run(report);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  report.note("took " + Cell(took.count()).text(3) + " s\n");
  report.finish();
  return report.missed();
}

}  // namespace viscera::bench
