// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace viscera::bench {

/// Runs a measurement on several threads at once and returns the sum of the results.
double sumOverThreads(int threads, const std::function<double()>& measure);

}  // namespace viscera::bench
