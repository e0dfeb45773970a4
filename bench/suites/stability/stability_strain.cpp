// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Ratio of the fastest mode of strained springs to that at rest, which strainFactor() must cover, from the float64
// reference's stiffness matrices. For cells of a law it follows from their strain itself (docs/physics.md 2).
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "bench/harness/specimens/block.h"
#include "bench/suites/stability/stability_suite.h"
#include "solver/ticks/stable_step.h"
#include "viscera/solver/material.h"
#include "viscera/solver/stability_monitor.h"

namespace viscera::bench {

namespace {

constexpr double kStabilityStrainSpacing_m = 0.005;
constexpr uint32_t kStabilityStrainSeed = 5;
constexpr double kChecked = 2;  // stretch up to which measured substeps are longer than the strained ones

/// A method of straining a block. @param at  position from its centre, -1 to 1 per axis   @param size  amount; 0: none
struct Strain {
  const char* name;
  double largest_size;
  std::function<Vector3d(const Vector3d& at, double size, std::mt19937& random)> position;
};

std::vector<Strain> strains() {
  using Random = std::mt19937;
  return {
      {"stretched along x, thinned as by nu 0.45", 4,
       [](const Vector3d& at, double s, Random&) -> Vector3d {
         const double across = std::pow(1 + s, -0.45);
         return {(1 + s) * at.x(), across * at.y(), across * at.z()};
       }},
      {"stretched along a diagonal", 4,
       [](const Vector3d& at, double s, Random&) -> Vector3d {
         const Vector3d along = Vector3d(1, 1, 0).normalized();
         const double across = std::pow(1 + s, -0.45), of = along.dot(at);
         return across * (at - of * along) + (1 + s) * of * along;
       }},
      {"sheared", 4,
       [](const Vector3d& at, double s, Random&) -> Vector3d {
         return {at.x() + 2 * s * at.z(), at.y(), at.z()};
       }},
      {"one node pulled out", 4,
       [](const Vector3d& at, double s, Random&) -> Vector3d {
         const double near = std::exp(-4 * (at - Vector3d::UnitZ()).squaredNorm());
         return at + 3 * s * near * Vector3d::UnitZ();
       }},
      {"twisted", 4,
       [](const Vector3d& at, double s, Random&) -> Vector3d {
         const double angle = 1.5 * s * at.z();
         return {std::cos(angle) * at.x() - std::sin(angle) * at.y(),
                 std::sin(angle) * at.x() + std::cos(angle) * at.y(), at.z()};
       }},
      {"pressed along z, widened to keep its volume", 0.95,
       [](const Vector3d& at, double s, Random&) -> Vector3d {
         const double across = 1 / std::sqrt(1 - s);
         return {across * at.x(), across * at.y(), (1 - s) * at.z()};
       }},
      {"widened by a random amount at every node", 6,
       [](const Vector3d& at, double s, Random& random) -> Vector3d {
         std::uniform_real_distribution<double> chance(-1, 1);
         return at + 0.15 * s * Vector3d(chance(random), chance(random), chance(random)) + 0.5 * s * at;
       }},
  };
}

struct Stretch {
  double largest = 0, shortest = 1;  ///< |L - l0| / l0, L / l0
};

Stretch stretchOf(const ReferenceSolver& reference, const Field& u_m) {
  Stretch out;
  for (const uint32_t slot : reference.active) {
    for (uint32_t s = 0; s < reference.springsOf(slot); ++s) {
      if (!reference.isFirstEnd(slot, s) || !reference.isWhole(slot, s)) continue;
      const double strain = reference.strain(u_m, slot, s);
      out.largest = std::max(out.largest, std::abs(strain));
      out.shortest = std::min(out.shortest, 1 + strain);
    }
  }
  return out;
}

/// Returns omega_max [1/s].
double fastestMode(const ReferenceSolver& reference, const Field& u_m) {
  Eigen::VectorXd per_root(reference.dofs());
  for (const uint32_t slot : reference.active)
    per_root.segment<3>(reference.dof(slot, 0)).setConstant(1 / std::sqrt(reference.mass(slot)));
  const Eigen::MatrixXd scaled =
      per_root.asDiagonal() * Eigen::MatrixXd(reference.stiffnessMatrix(u_m)) * per_root.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled, Eigen::EigenvaluesOnly);
  return std::sqrt(solver.eigenvalues().maxCoeff());
}

Field strained(const ReferenceSolver& reference, const Strain& strain, int cells, double size) {
  const double half_m = 0.5 * cells * kStabilityStrainSpacing_m;
  std::mt19937 random(kStabilityStrainSeed);  // the same random numbers for every size
  Field u_m(reference.slots(), Vector3d::Zero());
  for (const uint32_t slot : reference.active) {
    const Vector3d rest = reference.restPosition(slot), at = rest / half_m - Vector3d::Ones();
    u_m[slot] = half_m * (strain.position(at, size, random) + Vector3d::Ones()) - rest;
  }
  return u_m;
}

/// Returns the displacements at the size with the given largest stretch. Stretch grows with size.
Field strainedTo(const ReferenceSolver& reference, const Strain& strain, int cells, double stretch) {
  double low = 0, high = strain.largest_size;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (stretchOf(reference, strained(reference, strain, cells, middle)).largest < stretch ? low : high) = middle;
  }
  return strained(reference, strain, cells, low);
}

}  // namespace

void strainOfStability(Report& report) {
  const int cells = report.isShort() ? 3 : 5;
  Table table("fastest mode of strained springs over that at rest, and the measured substep over what is stable there",
              {{"strained"},
               {"stretch"},
               {"shortest spring", "l0", 3},
               {"omega", "at rest", 3},
               {"substep", "dt_safe", 3},
               {"over limit", "", 3}});
  double worst = 0;
  report.stage("strained springs");
  const MaterialConfig material;
  const Model model = blockModel(Vector3i::Constant(cells), kStabilityStrainSpacing_m, material);
  const ReferenceSolver reference(model, Vector3d::Zero(), 1e-4);
  const double at_rest = fastestMode(reference, Field(reference.slots(), Vector3d::Zero()));
  const double dt_safe_s = safeTimeStep(model);
  for (const Strain& strain : strains()) {
    for (const double wanted : {0.5, 1.0, 1.5, 2.0, 3.0}) {
      const Field u_m = strainedTo(reference, strain, cells, wanted);
      const Stretch stretch = stretchOf(reference, u_m);
      if (stretch.largest < 0.99 * wanted || stretch.shortest < layout::kCollapsed) continue;
      const double omega = fastestMode(reference, u_m);
      const double dt_s =
          measuredSubstep_s(SolverConfig{}, material.stiffness_damping_ratio, dt_safe_s, 2 / at_rest, stretch.largest);
      if (wanted <= kChecked) worst = std::max(worst, 0.5 * dt_s * omega);
      table.add(
          {strain.name, stretch.largest, stretch.shortest, omega / at_rest, dt_s / dt_safe_s, 0.5 * dt_s * omega});
    }
  }
  report.note("Tissue with a spring shorter than 0.3 of its length is left out: it has the strained substep.\n");
  report.add(table, "strain");
  report.checkAtMost("measured substep over what is stable in strained tissue", worst, 1);
}

}  // namespace viscera::bench
