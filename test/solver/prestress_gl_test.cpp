// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Tissue with a prestress is in equilibrium from the first tick on, with any integrator.
#include <gtest/gtest.h>

#include "math/float_bits.h"
#include "support/solver_rig.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kSpacing_m = 0.005;
constexpr double kStill = 1e-4;  // of the spacing: displacement due to float32 forces of springs strained by 5 %

/// Returns a sheet and, with leapfrog, a slab, each fixed on two sides, with strains that differ along their axes.
Scene prestressedScene(Integrator integrator) {
  const std::string held =
      "fixed: [{shape: plane, point_m: [-0.018, 0, 0], normal: [1, 0, 0]}, "
      "{shape: plane, point_m: [0.018, 0, 0], normal: [-1, 0, 0]}]";
  const std::string prestress = "prestress: {strain: 0.03, strains: [0.03, 0, 0.01], axes_deg: [0, 0, 20]}";
  const std::string slab =
      "  - {name: slab, source: box, box_size_m: [0.04, 0.03, 0.02], spacing_m: 0.005, material: {poisson_ratio: "
      "0.45, " +
      prestress + "}, " + held + "}\n";
  return parseScene("bodies:\n" + (integrator == Integrator::kLeapfrog ? slab : "") +
                        "  - {name: sheet, source: sheet, structure: surface, box_size_m: [0.04, 0.03, 0.01], "
                        "position_m: [0, 0, 0.1], spacing_m: 0.005, material: {" +
                        prestress + "}, " + held +
                        "}\n"
                        "environment: {gravity_m_per_s2: [0, 0, 0]}\n"
                        "solver: {sleep_speed_m_per_s: 0}\n",
                    "prestress.yaml");
}

class Prestressed : public OnSolver {};
INSTANTIATE_TEST_SUITE_P(Solvers, Prestressed,
                         solversUnderTest({Integrator::kLeapfrog, Integrator::kVerletPaper, Integrator::kPd}),
                         solverSuffix);

TEST_P(Prestressed, TissueStaysWhereItIsUntilItIsCut) {
  const Scene scene = prestressedScene(GetParam().integrator);
  const Model model = buildModel(scene);
  const auto solver = make(model, scene);
  for (int t = 0; t < 10; ++t) solver->step({});
  const HostState state = solver->readState();
  double farthest_m = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b)
    for (const uint32_t slot : model.bodies[b].lattice.active_slots)
      farthest_m = std::max(farthest_m, xyz(state.displacement_m[model.slotOffset(b) + slot]).norm());
  EXPECT_LT(farthest_m, kStill * kSpacing_m);
  const layout::TickStats stats = lastStats(*solver);
  EXPECT_GT(floatFromBits(stats.max_stretch_bits), 0.02F);  // and it is strained nevertheless
  EXPECT_EQ(solver->health().trips, 0U);
}

}  // namespace
}  // namespace viscera
