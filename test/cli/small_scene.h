// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/process.h"
#include "support/source_folder.h"

namespace viscera::test {

/// A block of 4 x 4 x 4 cells that hangs from its top, with one stylus and one camera: 125 nodes, which run fast.
constexpr const char* kBlockScene =
    "name: block\n"
    "bodies:\n"
    "  - name: block\n"
    "    source: box\n"
    "    box_size_m: [0.04, 0.04, 0.04]\n"
    "    spacing_m: 0.01\n"
    "    fixed: [{shape: plane, point_m: [0, 0, 0.015], normal: [0, 0, -1]}]\n"
    "styluses: [{name: left}]\n"
    "cameras: [{name: eye, position_m: [0, -0.2, 0.05], width_px: 64, height_px: 48}]\n";

inline Ending viscera(const std::vector<std::string>& arguments, const std::vector<std::string>& environment = {}) {
  return runProgram(kCommand, arguments, environment);
}

/// Returns the lines on standard error that say why the program gave up.
inline std::vector<std::string> complaints(const Ending& ending) {
  std::vector<std::string> out;
  for (const std::string& line : linesOf(ending.err))
    if (line.rfind("viscera: error: ", 0) == 0) out.push_back(line);
  return out;
}

/// Returns the JSON object on the last line of the output; discarded if that is none.
inline nlohmann::json lastLine(const Ending& ending) {
  const std::vector<std::string> lines = linesOf(ending.out);
  return lines.empty() ? nlohmann::json() : nlohmann::json::parse(lines.back(), nullptr, false);
}

/// Makes EGL find no device.
constexpr const char* kNoDevice = "__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null";

}  // namespace viscera::test
