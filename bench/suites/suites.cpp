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
#include "bench/suites/suture/suture_suite.h"
#include "bench/suites/validate/validate_suite.h"
#include "bench/suites/walls/walls_suite.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

namespace {

/// A suite that needs at most a current context.
template <void (*kRun)(Report&)>
void run(Report& report, gpu::Context* /*context*/) {
  kRun(report);
}

/// A suite about speed, which compares both backends.
template <void (*kRun)(Report&, gpu::Context&)>
void run(Report& report, gpu::Context* context) {
  kRun(report, *context);
}

}  // namespace

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all = {
      {"material", "measure the elasticity of the lattice against the requested one", run<materialSuite>, true},
      {"accuracy", "measure the error from substeps and float32, and the time that a smaller error costs",
       run<accuracySuite>, true},
      {"stability", "test that tissue stays finite and bounded whatever is done to it", run<stabilitySuite>, true},
      {"speed",
       "measure substeps per second by size, instruction set and connections, compared with VR05 Table 1, and the gain "
       "from leaving features out",
       run<speedSuite>, true, true, false, true},
      {"gw", "measure the tables of Georgii & Westermann, and the errors of their methods", run<gwSuite>},
      {"egve", "measure the time and the error of the mappings of the surface mesh (EGVE 3.4)", run<egveSuite>, true},
      {"cut",
       "measure pictures per second by length of an incision (VR05 figure 11), and the rate by share of springs cut",
       run<cutSuite>},
      {"blade", "measure force and work of blades that tissue resists, by spacing, stiffness, angle, speed and slicing",
       run<bladeSuite>, false, true},
      {"suture",
       "measure bending, hanging, sliding, pulling and cost of sutures, compared with the laws of docs/sutures.md",
       run<sutureSuite>, false, true},
      {"validate", "compare scenes with measured silicone rubbers, and with a sphere on a half space",
       run<validateSuite>, false, true, true},
      {"walls", "measure the sag of thin-walled organs and of a block of two materials, compared with CalculiX",
       run<wallsSuite>, false, true, false, false, false},
      {"haptics",
       "measure simulated devices against tissue: forces, limit cycles and energy, by mass, delay and stiffness",
       run<hapticsSuite>, false, true},
      {"latency", "measure the latency from a pose to its force and its picture, and how even ticks are",
       run<latencySuite>},
      {"picture", "measure the time of a picture, stage by stage, and whether the quick one looks the same",
       run<pictureSuite>},
      {"busy", "measure the gain of threads while other processes, which the suite starts itself, are busy",
       run<busySuite>},
      {"gpu",
       "measure work groups, methods to read neighbours, shares of this GPU's limits, large surface meshes, read-back "
       "and memory",
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
