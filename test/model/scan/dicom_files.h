// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <sstream>
#include <string>

#include "model/scan/scan_files.h"
#include "support/source_folder.h"

// DICOM by the program viscera-dicom, which is built where GDCM is available; files made by tests: explicit VR, little
// endian.
namespace viscera::test::dicom {

class Dicom : public ::testing::Test {
 protected:
  void SetUp() override {
#ifdef VISCERA_HAS_DICOM
    setenv("VISCERA_DICOM", kDicomProgram, 1);
#else
    GTEST_SKIP() << "viscera-dicom is not built: GDCM was not found";
#endif
  }
  void TearDown() override {
    unsetenv("VISCERA_DICOM");
  }
};

inline std::string number(size_t value, int bytes) {
  std::string text;
  for (int b = 0; b < bytes; ++b) text += static_cast<char>(value >> (8 * b) & 255);
  return text;
}
inline std::string us(unsigned value) {
  return number(value, 2);
}

inline std::string element(unsigned group, unsigned name, const std::string& vr, std::string value) {
  if (value.size() % 2) value += vr == "UI" ? '\0' : ' ';
  const bool wide = vr == "OW" || vr == "OB" || vr == "SQ";
  return us(group) + us(name) + vr + (wide ? us(0) + number(value.size(), 4) : number(value.size(), 2)) + value;
}

inline std::string sequence(unsigned group, unsigned name, const std::vector<std::string>& items) {
  std::string all;
  for (const std::string& item : items) all += us(0xfffe) + us(0xe000) + number(item.size(), 4) + item;
  return element(group, name, "SQ", all);
}

inline std::string head() {
  const std::string syntax = element(2, 0x10, "UI", "1.2.840.10008.1.2.1");
  return std::string(128, '\0') + "DICM" + element(2, 0, "UL", number(syntax.size(), 4)) + syntax;
}

/// Returns the position of a slice: that of the volume with a coordinate of its own along the third axis.
inline std::string position(const TestVolume& v, double height) {
  const Vector3d at = v.lps.col(3) + height * v.lps.col(2);
  std::ostringstream text;
  text.precision(12);
  text << at.x() << '\\' << at.y() << '\\' << at.z();
  return element(0x20, 0x32, "DS", text.str());
}
inline std::string orientation(const TestVolume& v) {
  std::ostringstream text;
  text.precision(12);
  for (int a = 0; a < 2; ++a)
    for (int c = 0; c < 3; ++c) text << (a + c ? "\\" : "") << v.lps(c, a) / v.lps.col(a).norm();
  return element(0x20, 0x37, "DS", text.str());
}
inline std::string spacing(const TestVolume& v) {
  std::ostringstream text;
  text << v.lps.col(1).norm() << '\\' << v.lps.col(0).norm();
  return element(0x28, 0x30, "DS", text.str());
}

}  // namespace viscera::test::dicom
