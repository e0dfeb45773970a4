// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/suites.h"
#include "viscera/model/scene.h"
#include "viscera/model/solid.h"

namespace viscera::cli {

/// `viscera check`: EGL devices, which is taken, why others were not.
int check(int device);

struct RunOptions {
  std::string scene;
  std::string mesh;     ///< empty: what the scene says
  std::string strokes;  ///< empty: nobody touches the tissue
  std::optional<double> seconds;
  std::string out;         ///< empty: no pictures, no metrics.json
  bool live = false;       ///< pictures may be left out where drawing falls behind, but for marks
  bool reference = false;  ///< in float64 on the CPU
  bool compare = false;    ///< with --reference: and the GPU beside it
  Overrides overrides;
};
/// `viscera run`: a session without ROS.
int run(const RunOptions& options);

struct BenchStepOptions {
  std::vector<int> nodes;
  std::string scene;
  std::string csv = "-";
  bool stages = false;  ///< of the GPU, in place of whole substeps
  Overrides overrides;
};
/// `viscera bench step`: time of a substep, or of each of its stages.
int benchStep(const BenchStepOptions& options);

struct BenchSuiteOptions {
  bench::SuiteOptions suite;
  int device = -1;
  bool strict = false;  ///< a missed limit is exit status 1
};
/// `viscera bench material` and its like: a suite of measurements.
int benchSuite(const bench::Suite& suite, const BenchSuiteOptions& options);

/// `viscera anchor`: anchored strokes as absolute ones.
int anchor(const RunOptions& options);

/// The file itself, or the shipped scene of that name. @throws SceneError naming where it was looked for
std::string findScene(const std::string& name);
/// Reports preparation on standard error: one line per stage, refreshed where it is a terminal.
Progress consoleProgress();

}  // namespace viscera::cli
