// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/number_text.h"

#include <locale.h>
#include <stdlib.h>

#include <array>
#include <charconv>

namespace viscera {

namespace {

constexpr int kExactDigits = 17;   // significant digits that identify any double
constexpr size_t kLongest = 1100;  // characters of -DBL_MAX with its decimals

std::string textOf(double value, std::chars_format format, int precision) {
  std::array<char, kLongest> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format, precision);
  return {text.data(), end.ptr};
}

}  // namespace

std::optional<double> readNumber(const std::string& text) {
  // Accepts what std::from_chars() refuses: a plus sign, blanks, and numbers that a double rounds to 0 or infinity.
  static const locale_t kClassic = newlocale(LC_ALL_MASK, "C", nullptr);
  char* end = nullptr;
  const double value = strtod_l(text.c_str(), &end, kClassic);
  if (end == text.c_str() || end != text.c_str() + text.size()) return {};
  return value;
}

std::string numberText(double value, int digits) {
  return textOf(value, std::chars_format::general, digits);
}

std::string fixedText(double value, int decimals) {
  return textOf(value, std::chars_format::fixed, decimals);
}

std::string exactText(double value) {
  return textOf(value, std::chars_format::general, kExactDigits);
}

}  // namespace viscera
