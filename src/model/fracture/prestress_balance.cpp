// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/fracture/prestress_balance.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

using Eigen::Matrix3d;

// Limits of the rest shape over the given shape. Beyond them the linear balance is a poor approximation.
constexpr double kShortest = 0.3, kLongest = 1.5;
// Residual forces over the largest tension at convergence: the resolution of float32.
constexpr double kBalanced = 3e-8;
constexpr double kRemaining = 1e-6;  // largest accepted residual forces over the largest tension
constexpr int kMostSteps = 20000;

Matrix3d strainOf(const PrestressConfig& c) {
  const Matrix3d turn = rotationFromDegrees(c.axes_deg).toRotationMatrix();
  return c.strain * Matrix3d::Identity() + turn * c.strains.asDiagonal() * turn.transpose();
}

std::string keyOf(const Body& body) {
  return "body '" + body.name + "': material.prestress ";
}

double dot(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

double worst(const std::vector<Vector3d>& forces) {
  double out = 0;
  for (const Vector3d& force : forces) out = std::max(out, force.norm());
  return out;
}

std::vector<Vector3d> scaledBy(const std::vector<double>& scale, const std::vector<Vector3d>& field) {
  std::vector<Vector3d> out = field;
  for (size_t i = 0; i < out.size(); ++i) out[i] *= scale[i];
  return out;
}

}  // namespace

std::vector<Matrix3d> strainsByLabel(const Body& body) {
  const std::vector<std::string>& names = body.lattice.part_names;
  std::vector<Matrix3d> out(1 + names.size(), strainOf(body.material.prestress));
  for (const PartConfig& part : body.parts) {
    const auto at = std::find(names.begin(), names.end(), part.part);
    if (at != names.end()) out[static_cast<size_t>(at - names.begin()) + 1] = strainOf(part.prestress);
  }
  return out;
}

void requirePrestrains(const Body& body) {
  for (const Matrix3d& strain : strainsByLabel(body)) {
    const Vector3d lengths =
        Vector3d::Ones() - Eigen::SelfAdjointEigenSolver<Matrix3d>(strain, Eigen::EigenvaluesOnly).eigenvalues();
    const double share = lengths.minCoeff() < kShortest ? lengths.minCoeff() : lengths.maxCoeff();
    if (share >= kShortest && share <= kLongest) continue;
    TextOut text;
    text << keyOf(body) << "makes the stress-free length " << share << " of the length at rest; " << kShortest << " to "
         << kLongest << " is accepted. Use a smaller prestress";
    throw SceneError(text.str());
  }
}

void PrestressBalance::free(Field& forces) const {
  for (uint32_t slot = 0; slot < forces.size(); ++slot)
    if (isFixed(body_.lattice.nodes[slot])) forces[slot].setZero();
}

PrestressBalance::Field PrestressBalance::pullsNow() const {
  Field out(body_.lattice.nodes.size(), Vector3d::Zero());
  pulls(out);
  free(out);
  return out;
}

std::string PrestressBalance::find() {
  const double asked = energy();
  const size_t slots = body_.lattice.nodes.size();
  std::vector<double> inverse(slots, 0);
  addStiffness(inverse);
  for (double& sum : inverse) sum = sum > 0 ? 1 / sum : 0;
  Field at(slots, Vector3d::Zero()), left = pullsNow(), product(slots);
  Field scaled = scaledBy(inverse, left), direction = scaled;
  double gain = dot(left, scaled);
  int steps = 0;
  for (; steps < kMostSteps && worst(left) > kBalanced * largest_n_; ++steps) {
    std::fill(product.begin(), product.end(), Vector3d::Zero());
    multiply(direction, product);
    free(product);
    const double step = gain / dot(direction, product);
    for (size_t i = 0; i < slots; ++i) {
      at[i] += step * direction[i];
      left[i] -= step * product[i];
    }
    scaled = scaledBy(inverse, left);
    const double next = dot(left, scaled);
    for (size_t i = 0; i < slots; ++i) direction[i] = scaled[i] + next / gain * direction[i];
    gain = next;
  }
  take(at);
  const double remaining = worst(pullsNow()) / largest_n_;
  TextOut text;
  if (!(remaining <= kRemaining)) {
    text << keyOf(body_) << "cannot be balanced in the given shape: " << remaining
         << " of the largest tension remains after " << steps << " steps";
    throw SceneError(text.str());
  }
  text << "prestress: " << std::lround(100 * (asked > 0 ? std::sqrt(energy() / asked) : 0))
       << " % of the requested strain is in balance in the given shape; remaining forces: " << remaining
       << " of the largest tension, after " << steps << " steps";
  return text.str();
}

}  // namespace viscera
