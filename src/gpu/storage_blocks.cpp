// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/storage_blocks.h"

#include <algorithm>
#include <regex>
#include <set>
#include <vector>

#include "math/number_text.h"

namespace viscera::gpu {

namespace {

using Names = std::set<std::string>;

/// Returns whether a condition of `#if` or `#elif` holds: defined(A) || defined(B) ..., or with && throughout.
bool holds(const std::string& condition, const Names& defined) {
  static const std::regex name_pattern(R"(defined\((\w+)\))");
  const bool all = condition.find("||") == std::string::npos;
  bool out = all;
  for (std::sregex_iterator it(condition.begin(), condition.end(), name_pattern), end; it != end; ++it) {
    const bool is = defined.count((*it)[1]) > 0;
    out = all ? out && is : out || is;
  }
  return out;
}

/// One open #if.
struct Choice {
  bool taken;   ///< this branch is
  bool chosen;  ///< this one or one before is
};

}  // namespace

size_t declaredStorageBlocks(const std::string& source) {
  Names defined;
  std::vector<Choice> open;
  size_t count = 0;
  TextIn lines(source);
  for (std::string line; std::getline(lines, line);) {
    TextIn words(line);
    std::string directive, name;
    words >> directive >> name;
    if (directive == "#ifdef" || directive == "#ifndef" || directive == "#if") {
      const bool is = directive == "#if" ? holds(line, defined) : (defined.count(name) > 0) == (directive == "#ifdef");
      open.push_back({is, is});
    } else if (directive == "#endif" && !open.empty()) {
      open.pop_back();
    } else if ((directive == "#elif" || directive == "#else") && !open.empty()) {
      Choice& choice = open.back();
      choice.taken = !choice.chosen && (directive == "#else" || holds(line, defined));
      choice.chosen = choice.chosen || choice.taken;
    } else if (std::all_of(open.begin(), open.end(), [](const Choice& choice) { return choice.taken; })) {
      if (directive == "#define") defined.insert(name.substr(0, name.find('(')));
      if (line.rfind("layout(std430", 0) == 0 && line.find(" buffer ") != std::string::npos) ++count;
    }
  }
  return count;
}

}  // namespace viscera::gpu
