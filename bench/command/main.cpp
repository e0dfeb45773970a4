// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>
#include <iostream>

#include "bench/command/reference.h"
#include "bench/suites/suites.h"
#include "cli/fault.h"
#include "math/memory_for.h"

// `viscera bench` is a separate program, so that running scenes does not require building the suites.

using namespace viscera;

namespace {

struct SuiteOptions {
  bench::SuiteOptions suite;
  std::string backend = "both";
  int device = -1;
  bool strict = false;  ///< whether a failed check gives exit status 1
};

/// Adds the options of suites that measure bodies of any size, or a scene.
void addSizes(CLI::App& command, bench::SuiteOptions& options) {
  command
      .add_option("--nodes", options.nodes, "numbers of nodes of cube and heart in the parts sizes, ticks and stages")
      ->check(CLI::Range(8, 20000000));
  command.add_option(
      "--scene", options.scene,
      "scene that replaces cube and heart in the parts ticks and stages; measures ticks unless --only is given");
  command
      .add_option("--set", options.overrides,
                  "key=value: replaces one value of the scene, as in bodies[0].spacing_m=0.003")
      ->allow_extra_args(false);
  command
      .add_option("--threads", options.threads,
                  "threads of the CPU backend in the part ticks; 0, the default: one per processor")
      ->check(CLI::Range(0, 1024));
  command.get_option("--scene")->excludes("--nodes");
  command.get_option("--set")->needs("--scene");
}

/// Adds one command per suite; `chosen` becomes the given one.
void addSuites(CLI::App& bench, SuiteOptions& options, const bench::Suite*& chosen) {
  for (const bench::Suite& suite : bench::suites()) {
    CLI::App* command = bench.add_subcommand(suite.name, suite.what);
    command->add_option("--out", options.suite.out, "folder for tables (CSV) and plots (PNG); default out/bench");
    command->add_flag("--short", options.suite.short_form, "run fewer and smaller cases, which take seconds");
    command->add_flag("--strict", options.strict, "exit with status 1 if a limit is missed");
    command->add_option("--device", options.device, "index of the EGL device, as `viscera check` lists them");
    if (suite.takes_backend) {
      command
          ->add_option(
              "--backend", options.backend,
              "backend on which every row is measured: cpu, gpu or both, the default; without EGL, both is cpu alone")
          ->check(CLI::IsMember({"cpu", "gpu", "both"}));
    }
    if (suite.has_parts)
      command->add_option("--only", options.suite.only, "part of the suite to run alone; a wrong name lists the parts");
    if (suite.takes_data) {
      command
          ->add_option(
              "--data", options.suite.data,
              "CSV of measured compression: a column strain, from 0 to at least 0.5, and columns NAME_mean_kpa")
          ->check(CLI::ExistingFile);
    }
    if (suite.takes_sizes) addSizes(*command, options.suite);
    command->callback([&suite, &chosen] { chosen = &suite; });
  }
}

CLI::App* addReference(CLI::App& bench, bench::ReferenceRunOptions& options) {
  CLI::App* reference = bench.add_subcommand(
      "reference", "run a scene in float64 on the CPU, as `viscera run` does; prints one JSON object as its last line");
  reference->add_option("scene", options.run.scene, "scene file, or name of a shipped scene")->required();
  reference->add_option("--mesh", options.run.mesh, "mesh file that becomes the first body");
  reference->add_option("--strokes", options.run.strokes, "recorded strokes to replay");
  reference->add_option("--seconds", options.run.seconds, "simulated time; default: the strokes' length, or 1")
      ->check(CLI::Range(0.0, 86400.0));
  reference->add_flag("--compare", options.compare, "step the GPU too and print its error as gpu_error");
  reference
      ->add_option("--set", options.run.overrides,
                   "key=value: replaces one value of the scene, as in bodies[0].spacing_m=0.003")
      ->allow_extra_args(false);
  return reference;
}

int dispatch(int argc, char** argv) {
  CLI::App app("measure", "viscera bench");
  app.require_subcommand(1);
  bench::ReferenceRunOptions reference_options;
  SuiteOptions suite_options;
  const bench::Suite* suite = nullptr;
  const CLI::App* reference = addReference(app, reference_options);
  addSuites(app, suite_options, suite);
  if (const std::optional<int> ended = cli::parse(app, argc, argv)) return *ended;
  if (*reference)
    return memoryFor("running scene '" + reference_options.run.scene + "'",
                     [&] { return bench::referenceRun(reference_options); });
  if (!suite_options.suite.scene.empty() && suite_options.suite.only.empty()) suite_options.suite.only = "ticks";
  const int missed =
      bench::runSuite(*suite, suite_options.suite, suite_options.backend, suite_options.device, std::cout);
  return suite_options.strict && missed > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (const std::exception& e) {
    return cli::giveUp(e);
  }
}
