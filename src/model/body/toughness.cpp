// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/toughness.h"

#include <algorithm>

#include "model/scene/integrators.h"
#include "model/scene/yaml_reader.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

// Measured, docs/cutting.md.
constexpr double kCarried = 2.5;                        // of E h
constexpr double kCarriedAtSurface = 0.23;              // of E times the kernel: presses the tissue ahead by a third
constexpr double kLeastKernel = 3;                      // of h
constexpr double kKernelAtZero = 1, kKernelPerJ = 3.2;  // of h; its growth with J / (E h)

}  // namespace

double Toughness::carried_j_per_m2() const {
  return std::min(asked_j_per_m2, kCarried * young_modulus_pa * spacing_m);
}

double Toughness::carriedAtSurface_j_per_m2() const {
  return std::min(asked_j_per_m2, kCarriedAtSurface * young_modulus_pa * kernel_m());
}

double Toughness::kernel_m() const {
  const double carried = carried_j_per_m2() / (young_modulus_pa * spacing_m);
  return spacing_m * std::max(kKernelAtZero + kKernelPerJ * carried, kLeastKernel);
}

std::string Toughness::note() const {
  const double carried = carried_j_per_m2();
  if (carried >= asked_j_per_m2) return "";
  return "material.cut.toughness_j_per_m2 = " + numberText(asked_j_per_m2) + ": tissue of " +
         numberText(young_modulus_pa) + " Pa at a spacing of " + numberText(spacing_m) + " m carries " +
         numberText(carried) + " of it, and a blade in it gives " + numberText(100 * carried / asked_j_per_m2) +
         " % of the force (docs/cutting.md)";
}

Toughness toughnessOf(const Body& body) {
  Toughness out{body.material.cut.toughness_j_per_m2, body.material.young_modulus_pa, body.lattice.spacing_m};
  for (const PartConfig& part : body.parts)
    out.young_modulus_pa = std::min(out.young_modulus_pa, part.young_modulus_pa);
  return out;
}

bool resistsBlades(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const BodyConfig& body) { return body.material.cut.toughness_j_per_m2 > 0; });
}

bool cutsFreely(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const BodyConfig& body) { return !(body.material.cut.toughness_j_per_m2 > 0); });
}

void requireBladesFit(const Scene& scene) {
  if (!resistsBlades(scene)) return;
  const std::string key = "bodies[].material.cut.toughness_j_per_m2 above 0 ";
  if (scene.solver.integrator != Integrator::kLeapfrog)
    throw SceneError(key + "needs solver.integrator leapfrog or auto, not " + traitsOf(scene.solver.integrator).name);
}

}  // namespace viscera
