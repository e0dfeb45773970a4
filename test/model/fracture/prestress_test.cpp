// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/fracture/prestress.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "model/body/network_builder.h"
#include "model/body_samples.h"

namespace viscera::test {
namespace {

constexpr double kBalanced = 1e-6;  // residual forces of springs over the largest, for float32 rest lengths
constexpr double kExact = 1e-6;     // for strains: stiffness is float32
constexpr double kHalf_m = 0.1, kThick_m = 0.005, kRim_m = 0.002;

std::vector<FixedConfig> heldAround(double half_x_m, double half_y_m) {
  std::vector<FixedConfig> out(4);
  for (int side = 0; side < 4; ++side) {
    out[static_cast<size_t>(side)].shape = FixedShape::kPlane;
    out[static_cast<size_t>(side)].normal = Vector3d::Unit(side / 2) * (side % 2 ? -1 : 1);
    out[static_cast<size_t>(side)].point_m =
        -out[static_cast<size_t>(side)].normal * ((side / 2 == 0 ? half_x_m : half_y_m) - kRim_m);
  }
  return out;
}

/// Returns a slab that is fixed all around: strains in its plane cannot relax.
BodyConfig heldSlab(double nu, double strain) {
  BodyConfig config = boxConfig({2 * kHalf_m, 2 * kHalf_m, kThick_m}, kThick_m);
  config.material.poisson_ratio = nu;
  config.material.prestress.strain = strain;
  config.fixed = heldAround(kHalf_m, kHalf_m);
  return config;
}

/// Returns skin that would shrink on fat that would not, in one mesh; fixed all around.
BodyConfig skinOnFat(double border_m, double nu) {
  TriangleMesh fat = boxMesh(Vector3f(-0.03f, -0.02f, 0), Vector3f(0.03f, 0.02f, static_cast<float>(border_m)));
  TriangleMesh skin = boxMesh(Vector3f(-0.03f, -0.02f, static_cast<float>(border_m)), Vector3f(0.03f, 0.02f, 0.02f));
  fat.part_names = {"fat"};
  skin.part_names = {"skin"};
  BodyConfig config = meshConfig(joined(fat, skin, false), 0.005);
  config.material.poisson_ratio = nu;
  PartConfig part{"skin", 100e3, nu, 1100};
  part.prestress.strain = 0.1;
  config.parts = {part};
  config.fixed = heldAround(0.03, 0.02);
  return config;
}

/// Returns the stress over mu of the cell with this node as its lowest corner.
Eigen::Matrix3d stressAt(const Body& body, const Vector3i& node) {
  const std::array<float, 6>& six = body.prestress.at(static_cast<size_t>(body.lattice.slotAt(node)));
  Eigen::Matrix3f out;
  out << six[0], six[5], six[4], six[5], six[1], six[3], six[4], six[3], six[2];
  return out.cast<double>();
}

/// Returns the largest force on a free node at its position, computed as in the kernels, over the largest spring force.
double unbalanced(const Body& body) {
  const NetworkLinks links = linksOf(*body.network);
  double worst = 0, largest = 0;
  for (const uint32_t slot : body.lattice.active_slots) {
    Vector3d sum = Vector3d::Zero();
    for (uint32_t i = links.starts[slot]; i < links.starts[slot + 1]; ++i) {
      const layout::Link& link = links.links[i];
      const Vector3d offset(link.offset_length.x, link.offset_length.y, link.offset_length.z);
      const double l0 = static_cast<double>(link.offset_length.w);
      const double force = static_cast<double>(link.stiffness * link.prestrain_m2) / (offset.norm() + l0);
      sum += force * offset.normalized();
      largest = std::max(largest, std::abs(force));
    }
    if (!isFixed(body.lattice.nodes[slot])) worst = std::max(worst, sum.norm());
  }
  EXPECT_GT(largest, 0);
  return worst / largest;
}

std::string noteOf(const Body& body) {
  for (const std::string& note : body.notes)
    if (contains(note, "prestress: ")) return note;
  return "";
}

TEST(Prestress, WithoutItTissueIsAtRestWhereItIs) {
  BodyConfig config = heldSlab(0.25, 0);
  Body body = build(config);
  EXPECT_EQ(noteOf(body), "");
  EXPECT_TRUE(body.prestress.empty());
  config.structure = Structure::kExplicit;
  body = build(config);
  EXPECT_EQ(noteOf(body), "");
  for (const layout::Link& link : linksOf(*body.network).links) EXPECT_EQ(link.prestrain_m2, 0);
}

/// In its plane the stress is that of the given strain while the slab is free to become thinner: E e / (1 - nu), for
/// any nu.
TEST(Prestress, AHeldSlabHasTheStressOfPlaneStress) {
  constexpr double kStrain = 0.01;  // small enough for the law to be linear
  for (const double nu : {0.0, 0.25, 0.4, 0.45}) {
    SCOPED_TRACE(nu);
    const Body body = build(heldSlab(nu, kStrain));
    const double mu = body.material.young_modulus_pa / (2 * (1 + nu));
    const Vector3i middle(body.lattice.nodes_per_axis.x() / 2, body.lattice.nodes_per_axis.y() / 2, 0);
    const Eigen::Matrix3d stress = stressAt(body, middle);
    const double law = body.material.young_modulus_pa * kStrain / (1 - nu) / mu;
    // The rim cannot become thinner: a zone as wide as the thickness, of half a width of 20.
    constexpr double kNearRim = 0.04;
    EXPECT_NEAR(stress(0, 0), law, kNearRim * law);
    EXPECT_NEAR(stress(1, 1), law, kNearRim * law);
    EXPECT_NEAR(stress(2, 2), 0, kNearRim * law);
  }
}

TEST(Prestress, ASheetThatIsHeldKeepsAllOfIt) {
  BodyConfig config;
  config.source = TissueSource::kSheet;
  config.structure = Structure::kSurface;
  config.box_size_m = {0.06, 0.05, 0.01};
  config.spacing_m = 0.004;
  config.material.prestress.strains = {0.1, 0.02, 0};
  config.material.prestress.axes_deg = {0, 0, 90};
  config.fixed = heldAround(0.026, 0.021);
  const Body body = build(config);
  EXPECT_LT(unbalanced(body), kBalanced);
  EXPECT_TRUE(contains(noteOf(body), "100 % of the requested strain")) << noteOf(body);
  for (const NetworkSpring& spring : body.network->springs) {
    const Vector3d offset = body.network->positions_m[spring.b] - body.network->positions_m[spring.a];
    const Vector3d n = offset.normalized();
    const double strain = 0.02 * n.x() * n.x() + 0.1 * n.y() * n.y();  // rotated by a quarter turn
    EXPECT_NEAR(spring.rest_length_m / offset.norm(), 1 - strain, kExact);
  }
}

TEST(Prestress, WhatNothingHoldsKeepsNone) {
  constexpr double kNone = 1e-5;  // over mu
  BodyConfig config = boxConfig({0.04, 0.04, 0.04}, 0.01);
  config.material.prestress.strain = 0.1;
  const Body body = build(config);
  EXPECT_TRUE(contains(noteOf(body), "prestress: 0 % of the requested strain")) << noteOf(body);
  for (const std::array<float, 6>& six : body.prestress)
    for (const float s : six) EXPECT_NEAR(s, 0, kNone);
}

/// Borders on a layer of nodes and within cells that both parts share.
TEST(Prestress, SkinPullsAtFatThatIsAtRestAndBothBalance) {
  for (const double border_m : {0.015, 0.0175}) {
    for (const double nu : {0.25, 0.45}) {
      SCOPED_TRACE(testing::Message() << border_m << " m, nu " << nu);
      const Body body = build(skinOnFat(border_m, nu));
      const double of_fat = stressAt(body, {6, 4, 1})(0, 0), of_skin = stressAt(body, {6, 4, 3})(0, 0);
      EXPECT_GT(of_skin, 0.02);                    // skin is under tension
      EXPECT_LT(std::abs(of_fat), 0.2 * of_skin);  // each over its own mu
    }
  }
}

TEST(Prestress, RefusesWhatTissueCannotHave) {
  BodyConfig config = heldSlab(0.25, 0.05);
  config.structure = Structure::kExplicit;
  EXPECT_TRUE(contains(errorOf<SceneError>(config), "material.prestress needs structure lattice or surface"));
  config = heldSlab(0.25, 0.05);
  config.material.law = Law::kSprings;
  EXPECT_TRUE(
      contains(errorOf<SceneError>(config), "material.prestress of structure lattice needs material.law: neo_hookean"));
  config = heldSlab(0.25, 0.5);
  config.material.prestress.strains = {0.5, 0, 0};
  const std::string error = errorOf<SceneError>(config);
  for (const char* piece : {"body 'slab'", "material.prestress", "0.3 to 1.5"})
    EXPECT_TRUE(contains(error, piece)) << error;
}

}  // namespace
}  // namespace viscera::test
