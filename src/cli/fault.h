// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include "math/one_line.h"
#include "viscera/math/error.h"

namespace viscera::cli {

/// A command line that is not understood. Its exit status is CLI11's own number, above 100.
struct CommandLineError : Error {
  CommandLineError(const std::string& what, int its_status) : Error(what), status(its_status) {}
  int status;
};

/// Says why the program gives up, in one line. @return its exit status
inline int giveUp(const std::exception& error) {
  std::fflush(stdout);
  std::cout.flush();
  std::cerr << "viscera: error: " << oneLine(error.what()) << '\n';
  const auto* command_line = dynamic_cast<const CommandLineError*>(&error);
  return command_line ? command_line->status : 1;
}

/// Reads the command line. @return the exit status where that was all, as after --help   @throws CommandLineError
inline std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::string command = std::filesystem::path(app.get_name()).filename().string();  // without its folder
    for (const CLI::App* chosen : app.get_subcommands()) command += " " + chosen->get_name();
    throw CommandLineError(
        std::string("command line: ") + error.what() + "; `" + command + " --help` lists what is accepted",
        error.get_exit_code());
  }
  return {};
}

}  // namespace viscera::cli
