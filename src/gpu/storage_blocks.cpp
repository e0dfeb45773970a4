// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/storage_blocks.h"

#include <algorithm>
#include <functional>
#include <set>
#include <string_view>
#include <vector>

#include "gpu/source_lines.h"

namespace viscera::gpu {

namespace {

using Names = std::set<std::string_view, std::less<>>;

/// Returns whether a condition of `#if` or `#elif` holds: defined(A) || defined(B) ..., or with && throughout.
bool holds(std::string_view condition, const Names& defined) {
  constexpr std::string_view kDefined = "defined(";
  const bool all = condition.find("||") == std::string_view::npos;
  bool out = all;
  for (size_t at = condition.find(kDefined); at != std::string_view::npos; at = condition.find(kDefined, at)) {
    at += kDefined.size();
    const bool is = defined.count(condition.substr(at, condition.find(')', at) - at)) > 0;
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
  SourceLines lines(source);
  for (std::string_view line; lines.next(line);) {
    std::string_view rest = line;
    const std::string_view directive = takeWord(rest), name = takeWord(rest);
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
      if (line.rfind("layout(std430", 0) == 0 && line.find(" buffer ") != std::string_view::npos) ++count;
    }
  }
  return count;
}

}  // namespace viscera::gpu
