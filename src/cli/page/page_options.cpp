// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/page/page_options.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "viscera/math/error.h"

namespace viscera::cli {

void addPage(CLI::App* command, PageOptions& options) {
  CLI::Option* page = command->add_option(
      "--page", options.file, "page to write, .html: the session from any side and at any time, in a browser");
  command->add_option("--page-rate", options.rate_hz, "frames of the page per simulated second; default 20")
      ->check(CLI::Range(0.1, 1000.0))
      ->needs(page);
}

void requirePage(const PageOptions& options) {
  if (options.file.empty()) return;
  if (std::filesystem::path(options.file).extension() != ".html")
    throw Error("--page " + options.file + ": pages are .html files; give a name that ends in .html");
}

}  // namespace viscera::cli
