// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/model/scene/body_config.h"

namespace viscera {

/// Tissue by its name in scenes (`material.tissue`), with published measurements (docs/tissues.md).
struct TissuePreset {
  const char* name;
  /// E at small strain [Pa]; low to high is the range between tests and people.
  double young_modulus_pa, low_pa, high_pa;
  double poisson_ratio, density_kg_per_m3;
  const char* strain;             ///< strain at which E was measured; empty: not known
  const char *test, *source;      ///< measurement of E
  const char* labels;             ///< other names in label maps, separated by commas
  double toughness_j_per_m2 = 0;  ///< work per area of cut [J/m2]; 0: unknown
  const char* toughness_test = "";
  double stiffening = 0;  ///< MaterialConfig::stiffening; 0: unknown
  const char* stiffening_test = "";
};

const std::vector<TissuePreset>& tissuePresets();

/// Returns the preset of that name. @return null: there is none
const TissuePreset* tissueNamed(const std::string& name);

/// Returns the preset with a name, or another name in label maps, that equals a label word by word. Sides, lobes and
/// numbers are ignored: "left_kidney", "Liver", "lung_upper_lobe_left", but not "liver_vessels".   @return null: none
const TissuePreset* tissueOfLabel(const std::string& label);

/// Returns the names of the presets for which a number is known. @param number  such as
/// &TissuePreset::toughness_j_per_m2
std::string tissuesWith(double TissuePreset::*number);

/// Returns a Markdown table of all presets.
std::string tissueTable();

/// Returns the values that bodies took from presets and those that the scene overrides: one line each, for a person.
std::vector<std::string> tissueNotes(const BodyConfig& body);

/// Sets E, nu and density from a preset; values that the scene gives are set later. @tparam Config  material or part
template <class Config>
void takeTissue(Config& config) {
  const TissuePreset& preset = *tissueNamed(config.tissue);
  config.young_modulus_pa = preset.young_modulus_pa;
  config.poisson_ratio = preset.poisson_ratio;
  config.density_kg_per_m3 = preset.density_kg_per_m3;
}

}  // namespace viscera
