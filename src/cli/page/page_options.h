// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace viscera::cli {

/// Page that a command makes of a session.
struct PageOptions {
  std::string file;     ///< empty: none
  double rate_hz = 20;  ///< frames per simulated second
};

/// Adds --page and --page-rate to a command.
void addPage(CLI::App* command, PageOptions& options);
/// Checks the options of a page, if one is requested, before anything is computed. @throws Error  not .html
void requirePage(const PageOptions& options);

}  // namespace viscera::cli
