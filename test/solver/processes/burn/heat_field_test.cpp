// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Heat in tissue against exact solutions, and its balance.
#include "solver/processes/burn/heat_field.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kStep_s = 1.0 / 240;
constexpr double kHeatFieldBalance = 1e-9;  // of all heat: rounding of sums in float64
constexpr double kSlab = 0.01;              // of the rise at the surface: steps are of first order, and a third of it
constexpr double kSlabOfSheet = 0.015;      // the same; at the border triangles are halved, and nodes differ
constexpr double kSameDepth_m = 1e-6;
constexpr double kPoint = 0.02;  // of the rise, four spacings and more from a source: the lattice errs by 1 / (4 n^2)
constexpr double kRate = 1e-3;   // of a dose: its steps are not exact

Scene heatedBlock(const std::string& size, double spacing_m, const std::string& structure = "lattice") {
  return parseScene("bodies: [{source: " + std::string(structure == "surface" ? "sheet" : "box") +
                        ", structure: " + structure + ", box_size_m: [" + size +
                        "], spacing_m: " + std::to_string(spacing_m) + ", material: {density_kg_per_m3: 1060}}]",
                    "heat.yaml");
}

HeatConstants conducting() {
  HeatConstants out;
  out.perfusion_per_s = out.air_w_per_m2_k = 0;
  return out;
}

double diffusivity_m2_per_s(const HeatConstants& c) {
  return c.conductivity_w_per_m_k / (1060 * c.heat_j_per_kg_k);
}

/// Visits the slots of a model with one body, with their positions.
template <class Visit>
void forEach(const Model& model, const HeatField& field, const Visit& visit) {
  for (uint32_t slot = 0; slot < model.slots(); ++slot)
    if (field.graph().mass_kg[slot] > 0) visit(slot, restPosition(model.bodies[0], slot));
}

/// Expects the solution of a bar with a constant flux into its end at -x: the rise at depth x is 2 q sqrt(a t / pi) / k
/// exp(-x^2 / 4 a t) - q x / k erfc(x / sqrt(4 a t)), Carslaw and Jaeger 2.9.
void expectSlab(const Scene& scene, double tolerance) {
  const Model model = buildModel(scene);
  const HeatConstants constants = conducting();
  HeatField field(model, constants);
  Eigen::AlignedBox3d box;
  double all_kg = 0, end = 0;
  forEach(model, field, [&](uint32_t slot, const Vector3d& at) {
    box.extend(at);
    all_kg += field.graph().mass_kg[slot];
  });
  const double low_m = box.min().x(), length_m = box.sizes().x();
  const auto shareOf = [&](const Vector3d& at) {  // of the end: half at its borders
    double share = at.x() < low_m + 1e-7 ? 1 : 0;
    for (int axis = 1; axis < 3; ++axis)
      if (std::min(at[axis] - box.min()[axis], box.max()[axis] - at[axis]) < 1e-7) share *= 0.5;
    return share;
  };
  forEach(model, field, [&](uint32_t, const Vector3d& at) { end += shareOf(at); });
  const double area_m2 = all_kg / 1060 / length_m, flux_w_per_m2 = 5000, time_s = 20;
  for (int t = 0; t < std::lround(time_s / kStep_s); ++t) {
    forEach(model, field, [&](uint32_t slot, const Vector3d& at) {
      if (shareOf(at) > 0) field.give(slot, kStep_s * flux_w_per_m2 * area_m2 * shareOf(at) / end);
    });
    field.step(kStep_s);
  }
  const double a = diffusivity_m2_per_s(constants), k = constants.conductivity_w_per_m_k;
  const double surface_k = 2 * flux_w_per_m2 * std::sqrt(a * time_s / M_PI) / k;
  std::map<long, std::pair<double, double>> layers;  // by depth: mass, and rise times mass
  forEach(model, field, [&](uint32_t slot, const Vector3d& at) {
    std::pair<double, double>& layer = layers[std::lround((at.x() - low_m) / kSameDepth_m)];
    layer.first += field.graph().mass_kg[slot];
    layer.second += field.graph().mass_kg[slot] * (field.temperature_c(slot) - 37);
  });
  ASSERT_GT(layers.size(), 60U);
  for (const auto& [depth, layer] : layers) {
    const double x = kSameDepth_m * static_cast<double>(depth);
    const double exact_k = surface_k * std::exp(-x * x / (4 * a * time_s)) -
                           flux_w_per_m2 * x / k * std::erfc(x / std::sqrt(4 * a * time_s));
    EXPECT_NEAR(layer.second / layer.first, exact_k, tolerance * surface_k) << "at depth " << x;
  }
}

TEST(HeatField, SlabOfAConstantFluxIsAsCarslawAndJaegerHaveIt) {
  expectSlab(heatedBlock("0.016, 0.001, 0.001", 0.00025), kSlab);
  expectSlab(heatedBlock("0.016, 0.001, 0.001", 0.00025, "explicit"), kSlab);
  expectSlab(heatedBlock("0.016, 0.008, 0.001", 0.00025, "surface"), kSlabOfSheet);
}

/// Expects the solution of a point source, P / (4 pi k r) erfc(r / sqrt(4 a t)), from the same book, 10.4.
void expectPoint(const Scene& scene, double tolerance) {
  const Model model = buildModel(scene);
  const HeatConstants constants = conducting();
  HeatField field(model, constants);
  uint32_t source = 0;
  double nearest_m = 1;
  Vector3d centre = Vector3d::Zero();
  forEach(model, field, [&](uint32_t slot, const Vector3d& at) {
    if (at.norm() >= nearest_m) return;
    nearest_m = at.norm();
    source = slot;
    centre = at;
  });
  const double power_w = 0.1, time_s = 20;  // the source stays below 100 C
  for (int t = 0; t < std::lround(time_s / kStep_s); ++t) {
    field.give(source, kStep_s * power_w);
    field.step(kStep_s);
  }
  const double a = diffusivity_m2_per_s(constants), h = model.bodies[0].lattice.spacing_m;
  int compared = 0;
  forEach(model, field, [&](uint32_t slot, const Vector3d& at) {
    const double r = (at - centre).norm();
    if (r < 4 * h || r > 7 * h) return;
    const double exact_k =
        power_w / (4 * M_PI * constants.conductivity_w_per_m_k * r) * std::erfc(r / std::sqrt(4 * a * time_s));
    const double least_k = power_w / (4 * M_PI * constants.conductivity_w_per_m_k * 4 * h);
    EXPECT_NEAR(field.temperature_c(slot) - 37, exact_k, tolerance * least_k) << "at radius " << r;
    ++compared;
  });
  EXPECT_GT(compared, 100);
}

TEST(HeatField, PointSourceIsAsCarslawAndJaegerHaveIt) {
  expectPoint(heatedBlock("0.022, 0.022, 0.022", 0.001), kPoint);
}

TEST(HeatField, AllHeatIsStoredOrHasGoneWhereItIsSaidToHaveGone) {
  for (const std::string structure : {"lattice", "explicit", "surface"}) {
    SCOPED_TRACE(structure);
    const Model model =
        buildModel(heatedBlock(structure == "surface" ? "0.02, 0.02, 0.001" : "0.02, 0.02, 0.008", 0.002, structure));
    HeatField field(model);
    uint32_t some = 0;
    forEach(model, field, [&](uint32_t slot, const Vector3d&) { some = slot; });
    const double given_j = 60;
    for (int t = 0; t < 480; ++t) {
      field.give(some, given_j / 480);
      field.step(kStep_s);
    }
    BurnReport seen = field.seen();
    EXPECT_GT(seen.steam_j, 0.1 * given_j);
    EXPECT_GT(seen.hottest_c, 60);
    for (int t = 0; t < 4000 && field.isWarm(); ++t) field.step(1);
    for (const BurnReport& then : {seen, field.seen()}) {
      EXPECT_NEAR(then.given_j, given_j, kHeatFieldBalance * given_j);
      EXPECT_NEAR(then.stored_j + then.steam_j + then.perfused_j + then.surface_j, given_j,
                  kHeatFieldBalance * given_j);
    }
    EXPECT_FALSE(field.isWarm()) << "it cools down, and then costs nothing";
    EXPECT_GT(field.seen().perfused_j, 0);
    EXPECT_GT(field.seen().surface_j, 0);
  }
}

TEST(HeatField, WaterBoilsAtAHundredDegreesUntilNoneIsLeft) {
  const Model model = buildModel(heatedBlock("0.002, 0.002, 0.002", 0.002));
  const HeatConstants constants = conducting();
  HeatField field(model, constants);
  const uint32_t slot = model.bodies[0].lattice.active_slots[0];
  const double kg = field.graph().mass_kg[slot], water_kg = constants.water_share * kg;
  const double to_boil_j = 63 * kg * constants.heat_j_per_kg_k;
  field.give(slot, to_boil_j);
  EXPECT_NEAR(field.temperature_c(slot), 100, 1e-6);
  EXPECT_NEAR(field.boiled(slot), 0, 1e-9);
  field.give(slot, 0.5 * water_kg * constants.boiling_j_per_kg);
  EXPECT_NEAR(field.temperature_c(slot), 100, 1e-6);
  EXPECT_NEAR(field.boiled(slot), 0.5, 1e-6);
  field.give(slot, 0.5 * water_kg * constants.boiling_j_per_kg +
                       10 * (kg * constants.heat_j_per_kg_k - water_kg * constants.water_j_per_kg_k));
  EXPECT_NEAR(field.temperature_c(slot), 110, 1e-6) << "what is dry heats on";
  EXPECT_NEAR(field.boiled(slot), 1, 1e-9);
}

TEST(HeatField, DoseIsArrhenius) {
  const Model model = buildModel(heatedBlock("0.002, 0.002, 0.002", 0.002));
  const HeatConstants constants = conducting();
  const auto coagulatedAfter = [&](double at_c, double time_s) {
    HeatField field(model, constants);
    forEach(model, field, [&](uint32_t slot, const Vector3d&) {
      field.give(slot, (at_c - 37) * field.graph().mass_kg[slot] * constants.heat_j_per_kg_k);
    });
    for (int t = 0; t < std::lround(time_s / kStep_s); ++t) field.step(kStep_s);
    return field.coagulated(model.bodies[0].lattice.active_slots[0]);
  };
  const double rate_per_s = 7.39e39 * std::exp(-2.577e5 / (8.314462 * 333.15));
  EXPECT_NEAR(1 / rate_per_s, 3.43, 0.01) << "s at 60 C";
  EXPECT_NEAR(coagulatedAfter(60, 2), 1 - std::exp(-2 * rate_per_s), kRate);
  EXPECT_LT(coagulatedAfter(50, 2), 0.04);
  EXPECT_GT(coagulatedAfter(70, 2), 0.99);
  EXPECT_EQ(coagulatedAfter(42, 100), 0) << "no one is cooked by a fever";
}

TEST(HeatField, CutTissueConductsNoHeat) {
  const Model model = buildModel(heatedBlock("0.008, 0.002, 0.002", 0.002));
  HeatField field(model, conducting());
  CutSprings cuts;
  cuts.nodes = model.bodies[0].lattice.nodes;
  const Lattice& lattice = model.bodies[0].lattice;
  for (const uint32_t slot : lattice.active_slots) {  // across the middle
    const double x = lattice.restPosition(slot).x();
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const int64_t far = lattice.neighborSlot(slot, s);
      if (far >= 0 && (x < 1e-4) != (lattice.restPosition(static_cast<uint32_t>(far)).x() < 1e-4))
        setSpringCount(cuts.nodes[slot], s, 0);
    }
  }
  field.setCuts(cuts);
  forEach(model, field, [&](uint32_t slot, const Vector3d& at) {
    if (at.x() < -0.003) field.give(slot, 0.2);
  });
  for (int t = 0; t < 2400; ++t) field.step(kStep_s);
  forEach(model, field, [&](uint32_t slot, const Vector3d& at) {
    if (at.x() < 1e-4)
      EXPECT_GT(field.temperature_c(slot), 38);
    else
      EXPECT_EQ(field.temperature_c(slot), 37);
  });
}

}  // namespace
}  // namespace viscera
