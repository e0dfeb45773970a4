// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/fracture/toughness.h"

#include <algorithm>
#include <cmath>

#include "model/scene/integrators.h"
#include "model/scene/yaml/yaml_reader.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

// Measured, see docs/cutting.md.
constexpr double kCarried = 2.5;            // share of E h
constexpr double kCarriedAtSurface = 0.23;  // share of E times the kernel: indents the tissue ahead by a third
constexpr double kOfPoint = 0.4;            // share of E times the square of its kernel; 0.6 folds tissue
constexpr double kMostOfPoint = 9;          // in h: largest kernel of a point, as large as an edge's may be
constexpr double kLeastKernel = 3;          // in h
constexpr double kKernelAtZero = 1, kKernelPerJ = 3.2;  // in h; its growth with J / (E h)

/// Returns whether a body resists blades. @tparam B  Body or BodyConfig
template <class B>
bool resists(const B& body) {
  const auto part = [](const PartConfig& p) { return p.cut.toughness_j_per_m2 > 0; };
  const auto layer = [](const LayerConfig& l) { return l.toughness_j_per_m2 > 0; };
  return body.material.cut.toughness_j_per_m2 > 0 || std::any_of(body.parts.begin(), body.parts.end(), part) ||
         std::any_of(body.layers.begin(), body.layers.end(), layer);
}

}  // namespace

double Toughness::carried_j_per_m2() const {
  return std::min(asked_j_per_m2, kCarried * young_modulus_pa * spacing_m);
}

double Toughness::carriedAtSurface_j_per_m2(double body_kernel_m) const {
  return std::min(asked_j_per_m2, kCarriedAtSurface * young_modulus_pa * body_kernel_m);
}

double Toughness::kernel_m() const {
  const double carried = carried_j_per_m2() / (young_modulus_pa * spacing_m);
  return spacing_m * std::max(kKernelAtZero + kKernelPerJ * carried, kLeastKernel);
}

double Toughness::pointKernel_m(double width_m) const {
  const double wanted_m = std::sqrt(asked_j_per_m2 * width_m / (kOfPoint * young_modulus_pa));
  return std::clamp(wanted_m, kLeastKernel * spacing_m, kMostOfPoint * spacing_m);
}

double Toughness::ofPoint_n(double width_m, double kernel_m) const {
  return std::min(asked_j_per_m2 * width_m, kOfPoint * young_modulus_pa * kernel_m * kernel_m);
}

std::string Toughness::note(const std::string& key) const {
  const double carried = carried_j_per_m2();
  if (carried >= asked_j_per_m2) return "";
  return key + " = " + numberText(asked_j_per_m2) + ": tissue of " + numberText(young_modulus_pa) +
         " Pa at a spacing of " + numberText(spacing_m) + " m can represent only " + numberText(carried) +
         ", so a blade meets " + numberText(100 * carried / asked_j_per_m2) + " % of the true force (docs/cutting.md)";
}

Toughness toughnessOf(const Body& body) {
  return {body.material.cut.toughness_j_per_m2, body.material.young_modulus_pa, body.lattice.spacing_m};
}

std::vector<std::vector<Toughness>> toughnesses(const Body& body) {
  const std::vector<std::string>& names = body.lattice.part_names;
  std::vector<std::vector<Toughness>> out(1 + names.size(), {toughnessOf(body)});
  for (const PartConfig& part : body.parts) {
    const auto name = std::find(names.begin(), names.end(), part.part);
    if (name == names.end()) continue;  // strengths() reports it
    out[static_cast<size_t>(name - names.begin()) + 1] = {
        {part.cut.toughness_j_per_m2, part.young_modulus_pa, body.lattice.spacing_m}};
  }
  for (std::vector<Toughness>& of_label : out) {
    const Toughness below = of_label.back();
    for (size_t i = body.layers.size(); i > 0; --i) {
      const double of_layer = body.layers[i - 1].toughness_j_per_m2;
      of_label.insert(of_label.begin(), below);
      if (of_layer > 0) of_label.front().asked_j_per_m2 = of_layer;
    }
  }
  return out;
}

double kernelOf(const std::vector<std::vector<Toughness>>& toughnesses, double friction_n_per_m) {
  double most_m = 0;
  for (const std::vector<Toughness>& of_label : toughnesses) {
    for (Toughness toughness : of_label) {
      toughness.asked_j_per_m2 += friction_n_per_m;
      most_m = std::max(most_m, toughness.kernel_m());
    }
  }
  return most_m;
}

std::vector<std::string> toughnessNotes(const Body& body) {
  std::vector<std::string> notes = {toughnessOf(body).note("material.cut.toughness_j_per_m2")};
  const double h = body.lattice.spacing_m;
  for (size_t i = 0; i < body.parts.size(); ++i) {
    const PartConfig& part = body.parts[i];
    notes.push_back(Toughness{part.cut.toughness_j_per_m2, part.young_modulus_pa, h}.note("parts[" + std::to_string(i) +
                                                                                          "].cut.toughness_j_per_m2"));
  }
  for (size_t i = 0; i < body.layers.size(); ++i) {
    const Toughness layer{body.layers[i].toughness_j_per_m2, body.material.young_modulus_pa, h};
    notes.push_back(layer.note("layers[" + std::to_string(i) + "].toughness_j_per_m2"));
  }
  notes.erase(std::remove(notes.begin(), notes.end(), ""), notes.end());
  return notes;
}

bool resistsBlades(const Body& body) {
  return resists(body);
}

bool resistsBlades(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), resists<BodyConfig>);
}

bool cutsFreely(const Scene& scene) {
  return !std::all_of(scene.bodies.begin(), scene.bodies.end(), resists<BodyConfig>);
}

}  // namespace viscera
