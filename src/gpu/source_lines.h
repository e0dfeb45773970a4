// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string_view>

namespace viscera::gpu {

/// Takes the lines of a shader's source one by one. Without streams: the making of a session reads some 100,000 lines.
class SourceLines {
 public:
  explicit SourceLines(std::string_view text) : rest_(text) {}
  /// Takes the next line, without its end. @param line  it   @return false: there is none, and `line` is as before
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const size_t end = std::min(rest_.find('\n'), rest_.size());
    line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return true;
  }

 private:
  std::string_view rest_;
};

/// Removes the first word and the space before it. @param text  is left with what follows   @return "" at its end
inline std::string_view takeWord(std::string_view& text) {
  constexpr std::string_view kSpace = " \t\r";
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kSpace));
  text.remove_prefix(word.size());
  return word;
}

}  // namespace viscera::gpu
