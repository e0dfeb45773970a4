// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/experiment.h"
#include "bench/harness/report.h"

namespace viscera::bench {

/// Draws a work-precision diagram. Runs every method on every backend, prints a row for each with the wall times of the
/// backends, and plots the error against sweeps (a file per backend) and against wall time per simulated second. There
/// is a curve per integrator and number of iterations: for these 2, 10 and 50, or all in the short form; against wall
/// time only 10.
/// @param stem  stem of the file names   @param title  title of table and plots
/// @return errors on each backend of the report, in the order of the methods
std::vector<std::vector<Misfit>> drawWorkPrecision(Report& report, const Experiment& experiment, const Track& truth,
                                                   const std::vector<Method>& methods, const std::string& stem,
                                                   const std::string& title);

}  // namespace viscera::bench
