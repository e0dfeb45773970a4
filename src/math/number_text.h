// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <locale>
#include <optional>
#include <sstream>
#include <string>

namespace viscera {

// Numbers as text, with a decimal point whatever the locale of the program that uses this library: a desktop may have
// a comma. C's strtod() and printf(), std::stod(), std::to_string() and streams follow the locale.

/// Returns the number that the whole text is, as strtod() reads it in the C locale. Nothing: it is no number.
std::optional<double> readNumber(const std::string& text);
/// Returns what printf("%.*g") makes in the C locale. @param digits  significant ones
std::string numberText(double value, int digits = 6);
/// Returns what printf("%.*f") makes in the C locale. @param decimals  behind the point
std::string fixedText(double value, int decimals);
/// Returns as many digits as make the same double again.
std::string exactText(double value);

/// std::ostringstream and std::istringstream of the C locale.
class TextOut : public std::ostringstream {
 public:
  TextOut() { imbue(std::locale::classic()); }
};
class TextIn : public std::istringstream {
 public:
  TextIn() { imbue(std::locale::classic()); }
  explicit TextIn(const std::string& text) : std::istringstream(text) { imbue(std::locale::classic()); }
};

}  // namespace viscera
