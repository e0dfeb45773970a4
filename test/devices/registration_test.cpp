// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/registration.h"

#include <gtest/gtest.h>

#include <random>

#include "devices/registration_file.h"
#include "support/temporary_folder.h"
#include "support/text.h"

namespace viscera {
namespace {

using test::says;

const Pose kBase{{0.4, -0.3, 0.2}, Quaterniond(Eigen::AngleAxisd(2.2, Vector3d(1, 2, -1).normalized()))};
constexpr double kRegistrationNoise_m = 3e-4;  ///< per coordinate
constexpr double kRegistrationRounding_m = 1e-12;

const std::vector<KnownPoint> kPoints = {{"apex", {0, -0.05, 0.01}},
                                         {"left", {-0.06, 0, 0}},
                                         {"right", {0.05, 0.01, 0.02}},
                                         {"top", {0.01, 0, 0.07}},
                                         {"back", {0, 0.04, -0.02}}};

std::vector<Vector3d> touched(const std::vector<KnownPoint>& points, double noise_m, uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vector3d> out;
  for (const KnownPoint& point : points)
    out.push_back(kBase.inverse() * point.position_m +
                  noise_m * Vector3d(normal(random), normal(random), normal(random)));
  return out;
}

std::string refusal(const std::vector<KnownPoint>& known, const std::vector<Vector3d>& points_m) {
  try {
    solveRegistration(known, points_m, {});
  } catch (const RegistrationError& error) {
    return error.what();
  }
  return "";
}

std::string fileRefusal(const std::string& yaml, bool points) {
  try {
    if (points)
      parseKnownPoints(yaml, "f.yaml");
    else
      parseRegistration(yaml, "f.yaml");
  } catch (const RegistrationError& error) {
    return error.what();
  }
  return "";
}

TEST(Registration, ExactPointsGiveTheBase) {
  const Registration found = solveRegistration(kPoints, touched(kPoints, 0), {});
  EXPECT_LT((found.base.position_m - kBase.position_m).norm(), kRegistrationRounding_m);
  EXPECT_LT(found.base.orientation.angularDistance(kBase.orientation), kRegistrationRounding_m);
  EXPECT_LT(found.residual_m, kRegistrationRounding_m);
}

TEST(Registration, ThreePointsAreEnough) {
  const std::vector<KnownPoint> three(kPoints.begin(), kPoints.begin() + 3);
  EXPECT_LT((solveRegistration(three, touched(three, 0), {}).base.position_m - kBase.position_m).norm(),
            kRegistrationRounding_m);
}

TEST(Registration, ResidualIsThatOfTheNoise) {
  // Six parameters are fitted to 3 N numbers: the expected square of the residual is sigma^2 (3 - 6 / N).
  constexpr size_t kRounds = 400;
  double squares = 0;
  for (uint32_t seed = 0; seed < kRounds; ++seed) {
    const double residual_m = solveRegistration(kPoints, touched(kPoints, kRegistrationNoise_m, seed), {}).residual_m;
    squares += residual_m * residual_m / kRounds;
  }
  const double expected_m = kRegistrationNoise_m * std::sqrt(3 - 6.0 / static_cast<double>(kPoints.size()));
  // 400 rounds of nine degrees of freedom: the mean square has a relative deviation of 2.4 %; the tolerance is five of
  // these
  EXPECT_NEAR(squares / (expected_m * expected_m), 1, 0.12);
}

TEST(Registration, TooFewPointsAreRefused) {
  const std::vector<KnownPoint> two(kPoints.begin(), kPoints.begin() + 2);
  EXPECT_TRUE(says(refusal(two, touched(two, 0)), {"3 points at least", "has 2"}));
  EXPECT_TRUE(says(refusal(kPoints, touched(two, 0)), {"2 of 5"}));
}

TEST(Registration, PointsOnALineAreRefused) {
  const std::vector<KnownPoint> line = {{"a", {0, 0, 0}}, {"b", {0.1, 0.001, 0}}, {"c", {0.2, 0, 0.001}}};
  EXPECT_TRUE(says(refusal(line, touched(line, 0)), {"the known points are on one line", "5.00 mm"}));
  EXPECT_TRUE(
      says(refusal(kPoints, std::vector<Vector3d>(5, Vector3d::Zero())), {"the touched points are on one line"}));
}

TEST(Registration, PointsOfAnotherOrderAreRefused) {
  std::vector<Vector3d> points_m = touched(kPoints, 0);
  std::swap(points_m[0], points_m[3]);
  EXPECT_TRUE(says(refusal(kPoints, points_m), {"do not fit", "at most 3.00 mm", "apex ", "in this order"}));
}

TEST(Registration, MillimetresTakenForMetresAreRefused) {
  std::vector<Vector3d> points_m = touched(kPoints, 0);
  for (Vector3d& point : points_m) point *= 1000;
  EXPECT_TRUE(says(refusal(kPoints, points_m), {"do not fit"}));
}

TEST(RegistrationFile, ComesBackAsItWas) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path() + "/left.yaml";
  const RegistrationFile was{Vector3d(0.01, -0.02, 0.14), kBase, 4.2e-4};
  saveRegistration(was, path);
  const RegistrationFile is = loadRegistration(path);
  ASSERT_TRUE(is.tip_m && is.base);
  constexpr double kDigits = 1e-8;  // nine digits are written
  EXPECT_LT((*is.tip_m - *was.tip_m).norm(), kDigits);
  EXPECT_LT((is.base->position_m - was.base->position_m).norm(), kDigits);
  EXPECT_LT(is.base->orientation.angularDistance(was.base->orientation), kDigits);
  EXPECT_NEAR(is.residual_m, was.residual_m, 1e-3 * kDigits);
  saveRegistration({was.tip_m, std::nullopt, 0}, path);
  EXPECT_FALSE(loadRegistration(path).base);
}

TEST(RegistrationFile, BadFilesAreRefused) {
  EXPECT_TRUE(says(fileRefusal("tip: {position_m: [0, 0]}\n", false), {"f.yaml:1: ", "'tip.position_m'", "3 numbers"}));
  EXPECT_TRUE(says(fileRefusal("base: {orientation_xyzw: [0, 0, 0]}\n", false), {"f.yaml:1: ", "4 numbers"}));
  EXPECT_TRUE(says(fileRefusal("\nbase: {orientation_xyzw: [0, 0, 0, 0.5]}\n", false), {"f.yaml:2: ", "length 1"}));
  EXPECT_TRUE(says(fileRefusal("tips: 1\n", false), {"f.yaml:1: ", "unknown key 'tips'"}));
  EXPECT_TRUE(
      says(fileRefusal("points:\n  - {position_m: [0, 0, 0]}\n", true), {"f.yaml: ", "3 points at least", "1"}));
  EXPECT_TRUE(says(fileRefusal("points:\n  - {at: [0, 0, 0]}\n", true), {"f.yaml:2: ", "unknown key 'points[0].at'"}));
  EXPECT_THROW(loadKnownPoints("/nowhere.yaml"), RegistrationError);
  EXPECT_THROW(saveRegistration({}, "/nowhere/left.yaml"), RegistrationError);
}

TEST(RegistrationFile, PointsWithoutNamesAreNumbered) {
  const auto points = parseKnownPoints(
      "points: [{position_m: [0, 0, 0]}, {name: apex, position_m: [1, 0, 0]}, {position_m: [0, 1, 0]}]", "f.yaml");
  EXPECT_EQ(points[0].name, "point 1");
  EXPECT_EQ(points[1].name, "apex");
}

}  // namespace
}  // namespace viscera
