// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <locale>
#include <optional>
#include <sstream>
#include <string>

namespace viscera {

// Numbers as text, with a decimal point in every locale. C's strtod() and printf(), std::stod(), std::to_string() and
// streams follow the locale of the program, which may use a comma.

/// Returns the number that the whole text is, as strtod() reads it in the C locale, or nothing if it is not a number.
std::optional<double> readNumber(const std::string& text);
/// Returns the output of printf("%.*g") in the C locale. @param digits  significant ones
std::string numberText(double value, int digits = 6);
/// Returns the output of printf("%.*f") in the C locale. @param decimals  behind the point
std::string fixedText(double value, int decimals);
/// Returns enough digits to read the same double back.
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
