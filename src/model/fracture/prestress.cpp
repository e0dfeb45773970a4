// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/fracture/prestress.h"

#include <algorithm>
#include <cmath>

#include "model/fracture/prestress_balance.h"
#include "model/scene/structure_rules.h"

namespace viscera {

namespace {

/// Balance of the tensions of a sheet's springs.
class SpringBalance : public PrestressBalance {
 public:
  explicit SpringBalance(const Body& body) : PrestressBalance(body), network_(*body.network) {
    const Eigen::Matrix3d strain = strainsByLabel(body)[0];
    for (const NetworkSpring& spring : network_.springs) {
      const Vector3d offset = network_.positions_m[spring.b] - network_.positions_m[spring.a];
      const double length_m = offset.norm();
      lengths_m_.push_back(length_m);
      offsets_.push_back(length_m > 0 ? Vector3d(offset / length_m) : Vector3d::Zero());
      const double k = spring.against_bending ? 0 : spring.stiffness_n_per_m;
      tensions_n_.push_back(k * length_m * offsets_.back().dot(strain * offsets_.back()));
      largest_n_ = std::max(largest_n_, std::abs(tensions_n_.back()));
    }
  }

  double restLength_m(size_t i) const {
    const double k = network_.springs[i].stiffness_n_per_m;
    return k > 0 ? lengths_m_[i] - tensions_n_[i] / k : lengths_m_[i];
  }

 private:
  double energy() const override {
    double sum = 0;
    for (size_t i = 0; i < tensions_n_.size(); ++i) {
      const double k = network_.springs[i].stiffness_n_per_m;
      if (k > 0) sum += tensions_n_[i] * tensions_n_[i] / k;
    }
    return sum;
  }

  void pulls(Field& out) const override {
    for (size_t i = 0; i < tensions_n_.size(); ++i) {
      out[network_.springs[i].a] += tensions_n_[i] * offsets_[i];
      out[network_.springs[i].b] -= tensions_n_[i] * offsets_[i];
    }
  }

  void multiply(const Field& at_m, Field& out) const override {
    for (size_t i = 0; i < offsets_.size(); ++i) {
      const NetworkSpring& spring = network_.springs[i];
      if (spring.against_bending) continue;
      const Vector3d pull = spring.stiffness_n_per_m * offsets_[i].dot(at_m[spring.b] - at_m[spring.a]) * offsets_[i];
      out[spring.a] -= pull;
      out[spring.b] += pull;
    }
  }

  void addStiffness(std::vector<double>& sums) const override {
    for (const NetworkSpring& spring : network_.springs) {
      if (spring.against_bending) continue;
      sums[spring.a] += spring.stiffness_n_per_m;
      sums[spring.b] += spring.stiffness_n_per_m;
    }
  }

  void take(const Field& at_m) override {
    for (size_t i = 0; i < tensions_n_.size(); ++i) {
      const NetworkSpring& spring = network_.springs[i];
      if (!spring.against_bending)
        tensions_n_[i] += spring.stiffness_n_per_m * offsets_[i].dot(at_m[spring.b] - at_m[spring.a]);
    }
  }

  const SpringNetwork& network_;
  std::vector<double> lengths_m_, tensions_n_;
  Field offsets_;
};

}  // namespace

void addSheetPrestress(Body& body) {
  if (!isPrestressed(body.material, body.parts)) return;
  requirePrestrains(body);
  SpringBalance balance(body);
  body.notes.push_back(balance.find());
  std::vector<NetworkSpring>& springs = body.network->springs;
  for (size_t i = 0; i < springs.size(); ++i) {
    if (!springs[i].against_bending) springs[i].rest_length_m = balance.restLength_m(i);
  }
}

}  // namespace viscera
