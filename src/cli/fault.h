// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "math/nearest_names.h"
#include "math/one_line.h"
#include "viscera/math/error.h"

namespace viscera::cli {

/// Error for an invalid command line. Its exit status is CLI11's own number, above 100.
struct CommandLineError : Error {
  CommandLineError(const std::string& what, int its_status) : Error(what), status(its_status) {}
  int status;
};

/// Prints the reason for giving up, in one line. @return exit status
inline int giveUp(const std::exception& error) {
  std::fflush(stdout);
  std::cout.flush();
  std::cerr << "viscera: error: " << oneLine(error.what()) << '\n';
  const auto* command_line = dynamic_cast<const CommandLineError*>(&error);
  return command_line ? command_line->status : 1;
}

/// Returns a check that accepts the names of `values` and converts them; `--help` lists the names.
template <class Value>
CLI::Validator oneOf(const std::map<std::string, Value>& values) {
  std::string names;
  for (const auto& value : values) names += (names.empty() ? "" : ",") + value.first;
  names = "{" + names + "}";
  const auto convert = [values, names](std::string& text) {
    const auto value = values.find(text);
    if (value == values.end()) return text + " not in " + names;
    text = std::to_string(static_cast<int>(value->second));
    return std::string();
  };
  return CLI::Validator(convert, names);
}

inline std::vector<const CLI::App*> commandsOf(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Returns names that an unknown command or option may have meant, as part of an error message; empty if all are known.
inline std::string nearestTo(const CLI::App& app, int argc, char** argv) {
  constexpr size_t kNamed = 3;
  const CLI::App* at = &app;
  std::vector<std::string> names;
  std::string unknown;
  for (int i = 1; i < argc && unknown.empty(); ++i) {
    const std::string word = argv[i], option = word.substr(0, word.find('='));
    if (word.rfind("--", 0) == 0) {
      if (!at->get_option_no_throw(option)) unknown = option;
    } else if (at == &app) {
      for (const CLI::App* command : commandsOf(app)) at = command->get_name() == word ? command : at;
      if (at == &app) unknown = word;
    }
  }
  if (unknown.empty()) return "";
  if (unknown.rfind("--", 0) == 0) {
    for (const CLI::Option* option : at->get_options())
      for (const std::string& name : option->get_lnames())
        if (!option->get_group().empty()) names.push_back("--" + name);
  } else {
    for (const CLI::App* command : commandsOf(*at)) names.push_back(command->get_name());
  }
  names = nearestFirst(unknown, names);
  names.resize(std::min(names.size(), kNamed));
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return "; nearest to '" + unknown + "' are " + out;
}

/// Reads the command line. @return the exit status if the program is done, as after --help   @throws CommandLineError
inline std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    std::string command = std::filesystem::path(app.get_name()).filename().string();  // without its folder
    for (const CLI::App* chosen : app.get_subcommands()) command += " " + chosen->get_name();
    throw CommandLineError("command line: " + std::string(error.what()) + nearestTo(app, argc, argv) + "; `" + command +
                               " --help` lists what is accepted",
                           error.get_exit_code());
  }
  return {};
}

}  // namespace viscera::cli
