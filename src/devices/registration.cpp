// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "devices/registration.h"

#include <algorithm>

#include "devices/millimetres.h"
#include "math/decompositions.h"

namespace viscera {
namespace {

/// Returns the RMS distance of points from the line of best fit.
double spread(const Eigen::Matrix3Xd& points_m) {
  const Vector3d mean_m = points_m.rowwise().mean();
  Matrix3d squares = Matrix3d::Zero();
  for (Eigen::Index i = 0; i < points_m.cols(); ++i) {
    const Vector3d off_m = points_m.col(i) - mean_m;
    squares += off_m * off_m.transpose();
  }
  const Vector3d values_m2 = principalValues(squares);
  return std::sqrt(std::max(values_m2[0] + values_m2[1], 0.0) / static_cast<double>(points_m.cols()));
}

void requireSpread(const Eigen::Matrix3Xd& points_m, const std::string& which) {
  const double found_m = spread(points_m);
  if (found_m >= kLeastSpread_m) return;
  throw RegistrationError(which + " points are on one line or at one position: they are " + millimetres(found_m) +
                          " mm off it; at least " + millimetres(kLeastSpread_m) + " mm is needed");
}

}  // namespace

Registration solveRegistration(const std::vector<KnownPoint>& known, const std::vector<Vector3d>& touched,
                               const RegistrationLimits& limits) {
  if (touched.size() != known.size())
    throw RegistrationError("not every known point was touched: " + std::to_string(touched.size()) + " of " +
                            std::to_string(known.size()) + " are");
  if (known.size() < kLeastPoints)
    throw RegistrationError("a registration needs " + std::to_string(kLeastPoints) + " points at least, but has " +
                            std::to_string(known.size()));
  const auto count = static_cast<Eigen::Index>(known.size());
  Eigen::Matrix3Xd from_m(3, count), to_m(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    from_m.col(i) = touched[static_cast<size_t>(i)];
    to_m.col(i) = known[static_cast<size_t>(i)].position_m;
  }
  requireSpread(to_m, "the known");
  requireSpread(from_m, "the touched");
  const Eigen::Matrix4d motion = rigidMotion(from_m, to_m);
  Registration out;
  out.base.position_m = motion.topRightCorner<3, 1>();
  out.base.orientation = Quaterniond(motion.topLeftCorner<3, 3>()).normalized();
  double squares = 0;
  for (size_t i = 0; i < known.size(); ++i) {
    out.distances_m.push_back((out.base * touched[i] - known[i].position_m).norm());
    squares += out.distances_m.back() * out.distances_m.back();
  }
  out.residual_m = std::sqrt(squares / static_cast<double>(known.size()));
  if (!(out.residual_m <= limits.residual_m))
    throw RegistrationError("the touched points do not fit the known ones: residual " + millimetres(out.residual_m) +
                            " mm; at most " + millimetres(limits.residual_m) +
                            " mm is accepted (each: " + distancesText(known, out) +
                            " mm). Touch them in this order, in metres, with the tip known");
  return out;
}

std::string distancesText(const std::vector<KnownPoint>& known, const Registration& registration) {
  std::string out;
  for (size_t i = 0; i < known.size(); ++i)
    out += (i ? ", " : "") + known[i].name + " " + millimetres(registration.distances_m[i]);
  return out;
}

}  // namespace viscera
