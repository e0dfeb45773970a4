// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/model/scene/body_config.h"

namespace viscera {

/// A tissue by its name in scenes (`material.tissue`), as published measurements have it (docs/tissues.md).
struct TissuePreset {
  const char* name;
  double young_modulus_pa, low_pa, high_pa;  ///< at small strain; between tests and people it is from low to high
  double poisson_ratio, density_kg_per_m3;
  const char *test, *source;      ///< of E
  const char* labels;             ///< what label maps call it besides, a comma between
  double toughness_j_per_m2 = 0;  ///< of what a blade parts; 0: not known
  const char* toughness_test = "";
  double stiffening = 0;  ///< MaterialConfig::stiffening; 0: not known
  const char* stiffening_test = "";
};

const std::vector<TissuePreset>& tissuePresets();

/// @return null: there is none of that name
const TissuePreset* tissueNamed(const std::string& name);

/// The preset whose name, or another that label maps have for it, is that of a label, word by word; sides, lobes and
/// numbers aside: "left_kidney", "Liver", "lung_upper_lobe_left", but not "liver_vessels".   @return null: none
const TissuePreset* tissueOfLabel(const std::string& label);

/// Names of those of which a number is known. @param number  such as &TissuePreset::toughness_j_per_m2
std::string tissuesWith(double TissuePreset::*number);

/// Markdown table of all presets.
std::string tissueTable();

/// What bodies took from presets and what the scene says instead: one line each, for a person.
std::vector<std::string> tissueNotes(const BodyConfig& body);

/// Takes E, nu and density of a preset; those that the scene gives come afterwards. @tparam Config  material or part
template <class Config>
void takeTissue(Config& config) {
  const TissuePreset& preset = *tissueNamed(config.tissue);
  config.young_modulus_pa = preset.young_modulus_pa;
  config.poisson_ratio = preset.poisson_ratio;
  config.density_kg_per_m3 = preset.density_kg_per_m3;
}

}  // namespace viscera
