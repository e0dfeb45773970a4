// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// `viscera bench validate`: measured curves are read or refused; scenes are rubber and Hertz contact at small depth.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "bench/suites/validate/measured_curves.h"
#include "bench/suites/validate/validate_suite.h"
#include "bench/suites/validate/validate_trials.h"
#include "model/mesh_files.h"
#include "model/mesh_samples.h"
#include "viscera/math/error.h"

namespace viscera::bench {
namespace {

using namespace test;

constexpr double kMost = 0.5;
const std::string kHead = "strain,A_mean_kpa,A_sd_kpa,B_mean_kpa,B_sd_kpa\n";

std::vector<MeasuredCurve> readText(const std::string& text) {
  const std::string path = temporaryPath("curves.csv");
  writeFile(path, text);
  return readMeasuredCurves(path, kMost);
}

/// Returns a neo-Hookean rubber, E in kPa, at strains of 0 to 0.6.
std::string rubber(double young_kpa) {
  std::ostringstream out;
  out << "strain,rubber_mean_kpa\r\n";
  for (int i = 0; i <= 60; ++i) {
    const double stretch = 1 - 0.01 * i;
    out << 0.01 * i << ',' << young_kpa / 3 * (1 / (stretch * stretch) - stretch) << "\r\n";
  }
  return out.str();
}

TEST(MeasuredCurves, AreMeansByName) {
  const auto curves = readText(kHead + "0,0,0,0.5,0\n0.25,2,9,1,9\n0.5,6,9,3,9\n");
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[1].name, "B");
  EXPECT_DOUBLE_EQ(curves[0].at(0.375), 4000);
  EXPECT_DOUBLE_EQ(curves[1].at(0), 500);
}

TEST(MeasuredCurves, AreRefusedWithLineAndColumn) {
  const auto refused = [](const std::string& text, const std::string& why) {
    try {
      readText(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  refused("", "empty");
  refused("force,A_mean_kpa\n", ":1: the first column must be 'strain'");
  refused("strain,A_sd_kpa\n", ":1: there must be columns NAME_mean_kpa");
  refused(kHead + "0,0,0,0\n", ":2: must have 5 columns; found 4");
  refused(kHead + "0,0,0,x,0\n", ":2: B_mean_kpa: must be a number");
  refused(kHead + "0,nan,0,0,0\n", ":2: A_mean_kpa");
  refused(kHead + "0,0,0,0,0\n0,0,0,0,0\n", ":3: strain: must be larger");
  refused(kHead + "2,0,0,0,0\n", ":2: strain: must be a number, 0 .. 0.99");
  refused(kHead + "0,0,0,0,0\n0.4,0,0,0,0\n", "at least 0 .. 0.5");
  refused(kHead + "0.1,0,0,0,0\n0.6,0,0,0,0\n", "at least 0 .. 0.5");
}

TEST(MeasuredCurves, TakeWhateverBytes) {
  std::mt19937 random(5);
  const std::string good = rubber(20);
  for (int i = 0; i < 300; ++i) {
    std::string text = good;
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = static_cast<char>(random() % 256);
    if (i % 3 == 0) text.resize(random() % text.size());
    try {
      for (const MeasuredCurve& curve : readText(text)) EXPECT_TRUE(std::isfinite(curve.at(0.1)));
    } catch (const Error&) {  // refused
    }
  }
}

TEST(ValidateSuite, ACylinderBeginsAsHookeSaysAndStiffens) {
  const Compression found = compressedCylinder(0.49, 0.005, 0.3);
  EXPECT_NEAR(found.at(0.02) / 0.02, 1, 0.05);
  EXPECT_GT(found.at(0.3) / 0.3, 1.1 * found.at(0.05) / 0.05);
}

TEST(ValidateSuite, FindsTheModulusOfARubber) {
  const std::string path = temporaryPath("rubber.csv");
  writeFile(path, rubber(20));
  SuiteOptions options;
  options.out = temporaryPath("validate");
  options.short_form = true;
  options.data = path;
  options.only = "silicones";
  std::ostringstream text;
  Report report("validate", options, text);
  validateSuite(report);
  report.finish();
  EXPECT_EQ(report.missed(), 0) << text.str();
  EXPECT_NE(text.str().find("rubber"), std::string::npos);
}

TEST(ValidateSuite, ASphereIsNearHertz) {
  const SpherePress found = pressedSphere(0.45, 3, {0.15, 0.2});
  EXPECT_NEAR(found.over_hertz[1], 1, 0.2);
}

}  // namespace
}  // namespace viscera::bench
