// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Blood that flows down tissue, against the exact film, and its balance.
#include "solver/processes/bleed/blood_film.h"
#include "viscera/model/scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace viscera {
namespace {

constexpr double kTick_s = 1.0 / 60;
constexpr double kBalance = 1e-9;  // of all blood: rounding of sums in float64
constexpr double kFilm = 0.06;     // of a film's thickness: steps from node to node are of first order
constexpr double kViscosity_m2_per_s = 3.3e-6, kG_m_per_s2 = 9.81;
const Vector3d kDown(0, 0, -kG_m_per_s2);

Model block(const std::string& size, double spacing_m = 0.002) {
  return buildModel(
      parseScene("bodies: [{source: box, box_size_m: [" + size + "], spacing_m: " + std::to_string(spacing_m) + "}]",
                 "film.yaml"));
}

template <class Visit>
void forEach(const Model& model, const HeatGraph& graph, const Visit& visit) {
  for (uint32_t slot = 0; slot < model.slots(); ++slot)
    if (graph.exposed_m2[slot] > 0) visit(slot, restPosition(model.bodies[0], slot));
}

uint32_t nearest(const Model& model, const HeatGraph& graph, const Vector3d& to_m) {
  uint32_t out = 0;
  double nearest_m = 1;
  forEach(model, graph, [&](uint32_t slot, const Vector3d& at) {
    if ((at - to_m).norm() >= nearest_m) return;
    nearest_m = (at - to_m).norm();
    out = slot;
  });
  return out;
}

/// The film left on a wall has the thickness sqrt(nu z / (g t)), with z below its upper end (Jeffreys 1930).
TEST(BloodFilm, DrainsFromAWallAsAFilmDoes) {
  const Model model = block("0.01, 0.01, 0.08");
  const HeatGraph graph(model, 1);
  BloodFilm film(model, graph, kDown);
  constexpr double kFirst_m = 0.0003, kTop_m = 0.039, kTime_s = 3;
  double given_m3 = 0;
  forEach(model, graph, [&](uint32_t slot, const Vector3d& at) {
    if (at.z() > kTop_m || at.z() < -kTop_m) return;
    film.give(slot, kFirst_m * graph.exposed_m2[slot]);
    given_m3 += kFirst_m * graph.exposed_m2[slot];
  });
  for (int t = 0; t < static_cast<int>(std::lround(kTime_s / kTick_s)); ++t) film.step(kTick_s);
  size_t compared = 0;
  forEach(model, graph, [&](uint32_t slot, const Vector3d& at) {
    if (at.z() > 0.01 || at.z() < -0.03) return;
    const double exact_m = std::sqrt(kViscosity_m2_per_s * (kTop_m - at.z()) / (kG_m_per_s2 * kTime_s));
    EXPECT_NEAR(film.thickness_m(slot), exact_m, kFilm * exact_m) << at.transpose();
    ++compared;
  });
  EXPECT_GT(compared, 100U);
  EXPECT_GT(film.dripped_m3(), 0);
  EXPECT_NEAR(film.onTissue_m3() + film.dripped_m3(), given_m3, kBalance * given_m3);
}

TEST(BloodFilm, SpreadsOnWhatIsFlatAndDripsFromBelowOnly) {
  const Model model = block("0.06, 0.06, 0.008");
  const HeatGraph graph(model, 1);
  BloodFilm film(model, graph, kDown);
  const uint32_t top = nearest(model, graph, {0, 0, 0.004}), bottom = nearest(model, graph, {0, 0, -0.004});
  constexpr double kDrop_m3 = 5e-8;
  film.give(top, kDrop_m3);
  for (int t = 0; t < 300; ++t) film.step(kTick_s);
  EXPECT_EQ(film.dripped_m3(), 0);
  EXPECT_GT(film.wet().size(), 12U);
  EXPECT_LT(film.thickness_m(top), 0.001) << "a drop of 50 mm3";
  EXPECT_NEAR(film.onTissue_m3(), kDrop_m3, kBalance * kDrop_m3);
  film.give(bottom, kDrop_m3);
  for (int t = 0; t < 300; ++t) film.step(kTick_s);
  EXPECT_GT(film.dripped_m3(), 0.5 * kDrop_m3);
  EXPECT_NEAR(film.onTissue_m3() + film.dripped_m3(), 2 * kDrop_m3, kBalance * kDrop_m3);
}

TEST(BloodFilm, StaysWhereNothingWeighs) {
  const Model model = block("0.02, 0.02, 0.008");
  const HeatGraph graph(model, 1);
  BloodFilm film(model, graph, Vector3d::Zero());
  const uint32_t top = nearest(model, graph, {0, 0, 0.004});
  film.give(top, 1e-8);
  for (int t = 0; t < 60; ++t) film.step(kTick_s);
  EXPECT_EQ(film.volume_m3(top), 1e-8);
  EXPECT_EQ(film.dripped_m3(), 0);
}

/// The sides of a cut are exposed, and blood does not cross it.
TEST(BloodFilm, RunsDownTheWallOfACutAndNotAcrossIt) {
  const Model model = block("0.02, 0.02, 0.02");
  const HeatGraph graph(model, 1);
  std::vector<uint8_t> is_cut(graph.links.size(), 0);
  const auto x = [&](uint32_t slot) { return restPosition(model.bodies[0], slot).x(); };
  for (size_t i = 0; i < graph.links.size(); ++i)
    is_cut[i] = (x(graph.links[i].a) < 0.001) != (x(graph.links[i].b) < 0.001);
  BloodFilm film(model, graph, kDown);
  film.setCuts(is_cut);
  uint32_t inside = 0;
  for (uint32_t slot = 0; slot < model.slots(); ++slot)
    if (graph.mass_kg[slot] > 0 && restPosition(model.bodies[0], slot).norm() < 1e-6) inside = slot;
  film.give(inside, 1e-7);
  for (int t = 0; t < 600; ++t) film.step(kTick_s);
  EXPECT_GT(film.dripped_m3(), 5e-8);
  for (const uint32_t slot : film.wet()) EXPECT_LT(x(slot), 0.001);
}

}  // namespace
}  // namespace viscera
