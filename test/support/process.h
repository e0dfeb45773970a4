// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdio.h>
#include <sys/wait.h>

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace viscera::test {

/// How a program ended, and its output.
struct Ending {
  int status = -1;  ///< exit status; -1 if a signal ended it
  std::string out, err;
};

inline std::string shellQuoted(const std::string& word) {
  std::string out = "'";
  for (char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// Timeout [s]: a program that runs longer hangs. The longest takes a minute of one processor, and machines differ by a
/// factor of four.
constexpr int kHangs_s = 240;

/// Runs a program to its end; one that hangs ends with status 124. @param environment  "NAME=value" each, in addition
/// to this process's own
inline Ending runProgram(const std::string& program, const std::vector<std::string>& arguments,
                         const std::vector<std::string>& environment = {}) {
  const TemporaryFolder folder;
  std::string command = "timeout " + std::to_string(kHangs_s) + " env";
  for (const std::string& variable : environment) command += " " + shellQuoted(variable);
  command += " " + shellQuoted(program);
  for (const std::string& argument : arguments) command += " " + shellQuoted(argument);
  FILE* pipe = popen((command + " 2>" + shellQuoted(folder.file("err"))).c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot start " + command);
  Ending ending;
  char buffer[4096];
  for (size_t got = 0; (got = fread(buffer, 1, sizeof buffer, pipe)) > 0;) ending.out.append(buffer, got);
  const int state = pclose(pipe);
  // A signal appears as such, or as 128 + signal if the shell did not exec.
  if (WIFEXITED(state) && WEXITSTATUS(state) < 128) ending.status = WEXITSTATUS(state);
  ending.err = readFile(folder.file("err"));
  return ending;
}

inline std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace viscera::test
