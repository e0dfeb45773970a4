// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/number_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

#include "support/comma_locale.h"

namespace viscera {
namespace {

using namespace test;

std::vector<double> someNumbers() {
  std::vector<double> out = {0, -0.0, 1, -1, 0.1, 1234567.5, 1e-5, 1e22, 5e-324, std::numeric_limits<double>::max()};
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-30, 30);
  for (int i = 0; i < 1000; ++i) out.push_back((random() % 2 ? 1 : -1) * std::pow(10, exponent(random)));
  return out;
}

std::string printed(const char* format, int digits, double value) {
  char text[400];
  std::snprintf(text, sizeof text, format, digits, value);
  return text;
}

TEST(NumberText, IsThatOfPrintfWhateverTheLocale) {
  for (const double value : someNumbers()) {
    const std::string general = printed("%.*g", 6, value), fixed = printed("%.*f", 3, value);
    std::string made[3], streamed;
    bool read_back = false;
    {
      const CommaLocale comma;
      made[0] = numberText(value);
      made[1] = fixedText(value, 3);
      made[2] = exactText(value);
      TextOut out;
      out << value << ' ' << 1234567;
      streamed = out.str();
      read_back = readNumber(made[2]) == value;
    }
    EXPECT_EQ(made[0], general);
    EXPECT_EQ(made[1], fixed);
    EXPECT_EQ(made[2], printed("%.*g", 17, value));
    EXPECT_EQ(streamed, general + " 1234567");
    EXPECT_TRUE(read_back) << made[2];
  }
}

TEST(NumberText, ReadsWholeNumbersOnly) {
  const CommaLocale comma;
  EXPECT_EQ(readNumber("1.5"), 1.5);
  EXPECT_EQ(readNumber(" +2e3"), 2000.0);
  EXPECT_EQ(readNumber("1e-400"), 0.0);
  EXPECT_EQ(readNumber("-inf"), -std::numeric_limits<double>::infinity());
  for (const char* text : {"", " ", "1,5", "1.5x", "x", "+", "1.5 "}) EXPECT_FALSE(readNumber(text)) << text;
  double value = 0;
  TextIn in("0.25 7");
  EXPECT_TRUE(in >> value);
  EXPECT_EQ(value, 0.25);
}

TEST(NumberText, TheTestsHaveALocaleWithAComma) {
  const CommaLocale comma;
  ASSERT_TRUE(comma.hasC()) << "localedef cannot make de_DE.UTF-8: install the Debian package locales";
  char text[16];
  std::snprintf(text, sizeof text, "%.1f", 1.5);
  EXPECT_STREQ(text, "1,5");
}

}  // namespace
}  // namespace viscera
