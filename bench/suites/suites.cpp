// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/suites.h"

#include <chrono>

#include "bench/gw/gw_suite.h"
#include "bench/suites/accuracy_suite.h"
#include "bench/suites/material_suite.h"
#include "bench/suites/performance_suites.h"
#include "bench/suites/stability_suite.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

namespace {

/// A suite that needs the context current, and no more.
template <void (*kRun)(Report&)>
void run(Report& report, gpu::Context&) {
  kRun(report);
}

}  // namespace

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all = {
      {"material", "does the lattice have the elasticity that was asked for?", run<materialSuite>},
      {"accuracy", "what do substeps and float32 cost in error, and error in time?", run<accuracySuite>},
      {"stability", "does tissue stay finite and bounded whatever is done to it?", run<stabilitySuite>},
      {"table1", "substeps per second by number of nodes, beside VR05 Table 1", table1Suite},
      {"gw", "Georgii & Westermann's tables, and the errors of their ways", run<gwSuite>},
      {"scale", "time and memory per node, from a thousand to ten million nodes", scaleSuite},
      {"skip", "what does not doing what a scene does not need save?", skipSuite},
      {"cut", "rate by share of springs cut, as in VR05 figure 11", cutSuite},
      {"latency", "from a pose to its force and its picture; how even ticks are", latencySuite},
      {"limit", "copies and multiply-adds of this machine, and the fraction that is reached", limitSuite},
  };
  return all;
}

int runSuite(const Suite& suite, const SuiteOptions& options, int device, std::ostream& out) {
  const auto start = std::chrono::steady_clock::now();
  gpu::Context context(device);
  Report report(suite.name, options, out);
  report.note(std::string("viscera bench ") + suite.name + (options.short_form ? " --short" : "") + ", on " +
              context.renderer() + "\n");
  suite.run(report, context);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  report.note("took " + Cell(took.count()).text(3) + " s\n");
  report.finish();
  return report.missed();
}

}  // namespace viscera::bench
