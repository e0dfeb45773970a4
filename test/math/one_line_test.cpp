// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/one_line.h"

#include <gtest/gtest.h>

namespace viscera {
namespace {

TEST(OneLine, PlainTextStaysAsItIs) {
  EXPECT_EQ(oneLine(""), "");
  EXPECT_EQ(oneLine("scene.yaml:3: 'spacing_m' is a number"), "scene.yaml:3: 'spacing_m' is a number");
  EXPECT_EQ(oneLine("M\u00fcller/\u5fc3\u81d3/\U0001FAC0.obj"), "M\u00fcller/\u5fc3\u81d3/\U0001FAC0.obj");
}

TEST(OneLine, WhatMovesTheCursorIsEscaped) {
  EXPECT_EQ(oneLine("a\nb\tc\rd\x1b[31m\x7f"), "a\\nb\\tc\\x0dd\\x1b[31m\\x7f");
  EXPECT_EQ(oneLine(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(oneLine("\u0085"), "\\xc2\\x85") << "next line";
  EXPECT_EQ(oneLine("\u2028\u202e"), "\\xe2\\x80\\xa8\\xe2\\x80\\xae") << "line separator, right to left";
}

TEST(OneLine, BytesThatAreNoUtf8AreEscaped) {
  EXPECT_EQ(oneLine("\xff\xc3("), "\\xff\\xc3(");
  EXPECT_EQ(oneLine("\xc0\xaf"), "\\xc0\\xaf") << "overlong";
  EXPECT_EQ(oneLine("\xed\xa0\x80"), "\\xed\\xa0\\x80") << "surrogate";
  EXPECT_EQ(oneLine("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
  EXPECT_EQ(oneLine("\xe5\xbf"), "\\xe5\\xbf") << "cut short";
}

TEST(OneLine, LongLinesKeepBeginningAndEnd) {
  const std::string line = oneLine("scene.yaml:3: " + std::string(100000, 'o') + "; accepted: 1 .. 2");
  EXPECT_LE(line.size(), kLongestLine);
  EXPECT_EQ(line.rfind("scene.yaml:3: ooo", 0), 0u);
  EXPECT_NE(line.find("ooo ... ooo"), std::string::npos);
  EXPECT_EQ(line.substr(line.size() - 20), "oo; accepted: 1 .. 2");
  EXPECT_EQ(oneLine(line), line);
}

TEST(OneLine, NoCharacterIsCutThrough) {
  for (size_t shift = 0; shift < 4; ++shift) {
    std::string text(shift, 'a');
    for (int i = 0; i < 1000; ++i) text += "\U0001FAC0";
    const std::string line = oneLine(text);
    EXPECT_LE(line.size(), kLongestLine);
    EXPECT_EQ(line.find("\\x"), std::string::npos);
    EXPECT_EQ(oneLine(line), line);
  }
}

}  // namespace
}  // namespace viscera
