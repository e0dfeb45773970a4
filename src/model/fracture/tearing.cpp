// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/fracture/tearing.h"

#include <algorithm>
#include <cmath>

#include "model/scene/integrators.h"
#include "viscera/math/error.h"
#include "viscera/model/body/elasticity.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

// Measured, see docs/verification_cutting.md 6.
constexpr double kOnset = 0.6;     // strain of an axial spring, over sqrt(G / (E h))
constexpr double kCounted = 0.88;  // share of G, as springs next to the tear soften too
// A plane across an axis crosses one axial spring and four diagonal ones per h^2. When it opens by d, an axial one is
// longer by d and a diagonal one by d / sqrt 2. With half the strain at onset they all fail together.
constexpr double kDiagonalOnset = 0.5;
constexpr double kAxialShare = 1.0 / 3, kDiagonalShare = 1.0 / 6;  // shares of h^2

double toughnessOf(const MaterialConfig& material) {
  return material.tear.toughness_j_per_m2;
}

}  // namespace

double TearLaw::left(bool axial, double extension_m) const {
  const Spring& s = springs[axial ? 0 : 1];
  if (extension_m <= s.onset_m) return 1;
  return std::max(0.0, s.onset_m / extension_m * (s.end_m - extension_m) / (s.end_m - s.onset_m));
}

TearLaw tearLawOf(const Body& body) {
  const MaterialConfig& material = body.material;
  const double h = body.lattice.spacing_m, toughness = toughnessOf(material);
  const double k = material.young_modulus_pa / (2 * (1 + material.poisson_ratio)) * h;  // mu h
  const double strain = kOnset * std::sqrt(toughness / (material.young_modulus_pa * h));
  TearLaw law;
  law.onset_strain = kDiagonalOnset * strain;
  law.springs[0].onset_m = strain * h;
  law.springs[1].onset_m = kDiagonalOnset * strain * std::sqrt(2.0) * h;
  const double shares[2] = {kAxialShare, kDiagonalShare};
  for (size_t i = 0; i < 2; ++i)
    law.springs[i].end_m = 2 * kCounted * toughness * shares[i] * h * h / (k * law.springs[i].onset_m);
  return law;
}

bool tears(const Body& body) {
  return toughnessOf(body.material) > 0;
}

bool tears(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const BodyConfig& body) { return toughnessOf(body.material) > 0; });
}

bool suturesTear(const Scene& scene) {
  return !scene.styluses.empty() && std::any_of(scene.sutures.begin(), scene.sutures.end(),
                                                [](const SutureConfig& suture) { return suture.feelsTissue(); });
}

}  // namespace viscera
