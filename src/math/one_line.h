// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace viscera {

/// Most characters of an error line. Our longest, which lists the keys of a body, has some 600 with a long path. A
/// longer line quotes its input at length.
constexpr size_t kLongestLine = 1000;

/// Returns the bytes of the UTF-8 character that the text begins with. Returns 0 if it begins with none, or with one
/// that moves the cursor: control characters, line and paragraph separators, and changes of writing direction.
inline size_t printableBytes(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<uint8_t>(i < text.size() ? text[i] : 0); };
  const uint8_t first = byte(0);
  if (first < 0x80) return first >= ' ' && first != 0x7f ? 1 : 0;
  const size_t bytes = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4) return 0;
  uint32_t code = first & (0x7f >> bytes);
  for (size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3f);
  }
  constexpr uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool well_formed = code >= kLeast[bytes] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff);
  const bool moves = code < 0xa0 || (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return well_formed && !moves ? bytes : 0;
}

/// Returns a text as one line that is safe on a terminal and in a log. Escapes what is not printable UTF-8 (\n, \t,
/// \x1b). Shortens more than kLongestLine bytes in the middle, as file and culprit are at the beginning and what is
/// accepted is at the end. Its own output stays as it is.
inline std::string oneLine(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const size_t bytes = printableBytes(text);
    if (bytes > 0) {
      line.append(text, 0, bytes);
    } else {
      char code[8];
      std::snprintf(code, sizeof code, "\\x%02x", static_cast<uint8_t>(text[0]));
      line += text[0] == '\n' ? "\\n" : text[0] == '\t' ? "\\t" : code;
    }
    text.remove_prefix(bytes > 0 ? bytes : 1);
  }
  if (line.size() <= kLongestLine) return line;
  constexpr std::string_view kCut = " ... ";
  size_t tail = line.size() - kLongestLine / 3, head = kLongestLine - kLongestLine / 3 - kCut.size();
  const auto within_character = [&](size_t i) { return (static_cast<uint8_t>(line[i]) & 0xc0) == 0x80; };
  while (within_character(head)) --head;
  while (tail < line.size() && within_character(tail)) ++tail;
  return line.substr(0, head) + std::string(kCut) + line.substr(tail);
}

}  // namespace viscera
