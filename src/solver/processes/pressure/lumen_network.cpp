// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/pressure/lumen_network.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

constexpr double kLumenPi = 3.14159265358979323846;
constexpr double kViscosity_pa_s = 3.5e-3;  // of blood at high shear rates
constexpr double kBlood_kg_per_m3 = 1060;
constexpr double kDischarge = 0.6;    // of a sharp-edged hole
constexpr double kLeastShare = 1e-6;  // of the source's pressure: lower ones count as it in the orifice's law
constexpr double kConverged = 1e-5;   // of the source's pressure
constexpr int kMostRounds = 60;
constexpr double kSeep = 1e-6;  // of the largest conductance: what is neither supplied nor open loses its pressure

}  // namespace

double poiseuilleConductance(double area_m2, double length_m) {
  return area_m2 * area_m2 / (8 * kLumenPi * kViscosity_pa_s * length_m);
}

LumenNetwork::Flow LumenNetwork::solve(double source_pa, const Openings& at,
                                       const std::vector<double>& guess_pa) const {
  const auto count = static_cast<Eigen::Index>(stations.size());
  Flow out{std::vector<double>(stations.size(), 0), std::vector<double>(stations.size(), 0)};
  if (!(source_pa > 0)) return out;
  std::vector<Eigen::Triplet<double>> between;
  Eigen::VectorXd fixed = Eigen::VectorXd::Zero(count);  // of the diagonal
  Eigen::VectorXd supply = Eigen::VectorXd::Zero(count);
  double largest = 0;
  // Conductance of half a station, from its middle to its end.
  const auto half = [&](uint32_t i) {
    const LumenStation& station = stations[i];
    return poiseuilleConductance(at.narrowing[i] * station.area_m2, 0.5 * station.length_m);
  };
  for (const auto& [a, b] : links) {
    if (at.is_closed[a] || at.is_closed[b]) continue;
    const double of_a = half(a), of_b = half(b), joined = of_a + of_b > 0 ? of_a * of_b / (of_a + of_b) : 0;
    fixed[a] += joined;
    fixed[b] += joined;
    between.emplace_back(a, b, -joined);
    between.emplace_back(b, a, -joined);
    largest = std::max(largest, joined);
  }
  for (uint32_t i = 0; i < stations.size(); ++i) {
    if (stations[i].supply_m3_per_s == 0 || at.is_closed[i]) continue;
    const double source = stations[i].supply_m3_per_s / source_pa;
    const double within = stations[i].length_m > 0 ? half(i) : 0;
    const double joined = stations[i].length_m > 0 ? source * within / (source + within) : source;
    fixed[i] += joined;
    supply[i] = joined * source_pa;
    largest = std::max(largest, source);
  }
  double least_supply = largest;
  for (Eigen::Index i = 0; i < count; ++i)
    if (supply[i] > 0) least_supply = std::min(least_supply, supply[i] / source_pa);
  fixed.array() += kSeep * least_supply;
  for (Eigen::Index i = 0; i < count; ++i) between.emplace_back(static_cast<int>(i), static_cast<int>(i), 0);
  Eigen::SparseMatrix<double> all(count, count);
  all.setFromTriplets(between.begin(), between.end());
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt;
  ldlt.analyzePattern(all);
  Eigen::VectorXd pressure = Eigen::Map<const Eigen::VectorXd>(guess_pa.data(), count);
  for (int round = 0; round < kMostRounds; ++round) {
    for (Eigen::Index i = 0; i < count; ++i) {
      const double now_pa = std::max(pressure[i], kLeastShare * source_pa);
      all.coeffRef(i, i) =
          fixed[i] + kDischarge * at.open_m2[static_cast<size_t>(i)] * std::sqrt(2 / (kBlood_kg_per_m3 * now_pa));
    }
    ldlt.factorize(all);
    const Eigen::VectorXd next = ldlt.solve(supply);
    const double change_pa = (next - pressure).cwiseAbs().maxCoeff();
    pressure = next;
    if (change_pa < kConverged * source_pa) break;
  }
  for (size_t i = 0; i < stations.size(); ++i) {
    const double pressure_pa = std::clamp(pressure[static_cast<Eigen::Index>(i)], 0.0, source_pa);
    out.pressure_pa[i] = pressure_pa;
    out.outflow_m3_per_s[i] = kDischarge * at.open_m2[i] * std::sqrt(2 * pressure_pa / kBlood_kg_per_m3);
  }
  return out;
}

}  // namespace viscera
