// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/suites.h"

#include <chrono>

#include "bench/gw/gw_suite.h"
#include "bench/harness/specimens/backends.h"
#include "bench/suites/accuracy/accuracy_suite.h"
#include "bench/suites/blade/blade_suite.h"
#include "bench/suites/egve/egve_suite.h"
#include "bench/suites/gpu/gpu_suite.h"
#include "bench/suites/material/material_suite.h"
#include "bench/suites/pace/haptics_suite.h"
#include "bench/suites/pace/performance_suites.h"
#include "bench/suites/speed/speed_suite.h"
#include "bench/suites/stability/stability_suite.h"
#include "bench/suites/thread/thread_suite.h"
#include "bench/suites/validate/validate_suite.h"
#include "bench/suites/walls/walls_suite.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

namespace {

/// A suite that needs the context current at most.
template <void (*kRun)(Report&)>
void run(Report& report, gpu::Context* /*context*/) {
  kRun(report);
}

/// A suite about speed, which shows both backends side by side.
template <void (*kRun)(Report&, gpu::Context&)>
void run(Report& report, gpu::Context* context) {
  kRun(report, *context);
}

}  // namespace

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all = {
      {"material", "does the lattice have the elasticity that was asked for?", run<materialSuite>, true},
      {"accuracy", "what do substeps and float32 cost in error, and error in time?", run<accuracySuite>, true},
      {"stability", "does tissue stay finite and bounded whatever is done to it?", run<stabilitySuite>, true},
      {"speed", "substeps per second by size, instruction set and connections, beside VR05 Table 1; what is left out",
       run<speedSuite>, true, true, false, true},
      {"gw", "Georgii & Westermann's tables, and the errors of their ways", run<gwSuite>},
      {"egve", "what do the mappings of the skin cost, and how far off are they (EGVE 3.4)?", run<egveSuite>, true},
      {"cut", "pictures per second by length of an incision (VR05 figure 11), rate by share of springs cut",
       run<cutSuite>},
      {"blade", "force and work of blades that tissue resists, by spacing, stiffness, angle, speed and slicing",
       run<bladeSuite>, false, true},
      {"thread", "bending, hanging, sliding, pulling and cost of threads, beside the laws of docs/thread.md",
       run<threadSuite>, false, true},
      {"validate", "measured silicone rubbers and a sphere on a half space, foretold by scenes", run<validateSuite>,
       false, true, true},
      {"walls", "how far do thin-walled organs and a block of two materials hang, beside CalculiX's?", run<wallsSuite>,
       false, true, false, false, false},
      {"haptics", "simulated devices against tissue: what is felt, limit cycles, energy, by mass, delay and stiffness",
       run<hapticsSuite>, false, true},
      {"latency", "from a pose to its force and its picture; how even ticks are", run<latencySuite>},
      {"picture", "what does a picture cost, stage by stage, and does the quick one look the same?", run<pictureSuite>},
      {"busy", "what do threads gain beside other busy processes, which the suite starts itself?", run<busySuite>},
      {"gpu", "work groups, ways to read neighbours, shares of this GPU's limits, large skins, read-back, memory",
       run<gpuSuite>, false, true},
  };
  return all;
}

int runSuite(const Suite& suite, SuiteOptions options, const std::string& backend, int device, std::ostream& out) {
  const auto start = std::chrono::steady_clock::now();
  const Machine machine = machineFor(suite.takes_backend ? backend : suite.needs_gpu ? "gpu" : "cpu", device);
  options.backends = machine.backends;
  options.context = machine.context.get();
  Report report(suite.name, options, out);
  report.note(std::string("viscera bench ") + suite.name + (options.short_form ? " --short" : "") + ", on " +
              (suite.takes_backend || !machine.context ? machine.note : machine.context->renderer()) + "\n");
  suite.run(report, machine.context.get());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  report.note("took " + Cell(took.count()).text(3) + " s\n");
  report.finish();
  return report.missed();
}

}  // namespace viscera::bench
