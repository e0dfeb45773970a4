// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/nearest_names.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>

namespace viscera {

namespace {

char lowered(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// Returns the number of edits between two words; an edit may exchange neighbours (optimal string alignment).
size_t editsBetween(const std::string& a, const std::string& b) {
  std::vector<size_t> before, last(b.size() + 1), now(b.size() + 1);
  std::iota(last.begin(), last.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const bool same = lowered(a[i - 1]) == lowered(b[j - 1]);
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      const bool exchanged =
          i > 1 && j > 1 && lowered(a[i - 1]) == lowered(b[j - 2]) && lowered(a[i - 2]) == lowered(b[j - 1]);
      if (exchanged) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before = last;
    std::swap(last, now);
  }
  return last[b.size()];
}

}  // namespace

std::vector<std::string> nearestFirst(const std::string& word, std::vector<std::string> names) {
  constexpr size_t kFirst = 3, kLongest = 100;  // characters; a longer word is not a name
  const std::string asked = word.substr(0, kLongest);
  std::vector<std::pair<size_t, std::string>> by_edits;
  for (const std::string& name : names) by_edits.emplace_back(editsBetween(asked, name), name);
  std::stable_sort(by_edits.begin(), by_edits.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  by_edits.resize(std::min(kFirst, by_edits.size()));
  const auto isFirst = [&](const std::string& name) {
    return std::any_of(by_edits.begin(), by_edits.end(), [&](const auto& first) { return first.second == name; });
  };
  names.erase(std::remove_if(names.begin(), names.end(), isFirst), names.end());
  for (auto first = by_edits.rbegin(); first != by_edits.rend(); ++first) names.insert(names.begin(), first->second);
  return names;
}

std::string nearestFirstText(const std::string& word, const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : nearestFirst(word, names)) out += (out.empty() ? "" : ", ") + name;
  return out;
}

}  // namespace viscera
