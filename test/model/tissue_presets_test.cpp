// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/tissue_presets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>

#include "model/scene/scene_text.h"
#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

using test::says;

MaterialConfig materialOf(const std::string& material, const Overrides& overrides = {}) {
  return parseScene("bodies: [{material: {" + material + "}}]\n", "s.yaml", overrides).bodies.at(0).material;
}

std::string nameOfLabel(const std::string& label) {
  const TissuePreset* preset = tissueOfLabel(label);
  return preset ? preset->name : "";
}

template <class Config>
void expectNumbers(const Config& config, double young_modulus_pa, double poisson_ratio, double density_kg_per_m3) {
  EXPECT_EQ(config.young_modulus_pa, young_modulus_pa);
  EXPECT_EQ(config.poisson_ratio, poisson_ratio);
  EXPECT_EQ(config.density_kg_per_m3, density_kg_per_m3);
}

/// Returns whether a value is rounded to two digits.
bool hasTwoDigits(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1), digits = value / unit;
  return std::abs(digits - std::round(digits)) < 1e-9;
}

TEST(TissuePresets, EveryRowIsWithinItsRangeAndSaysHowAndWhereItWasMeasured) {
  std::set<std::string> names;
  for (const TissuePreset& preset : tissuePresets()) {
    SCOPED_TRACE(preset.name);
    EXPECT_TRUE(names.insert(preset.name).second);
    EXPECT_LE(preset.low_pa, preset.young_modulus_pa);
    EXPECT_LE(preset.young_modulus_pa, preset.high_pa);
    for (const double value : {preset.low_pa, preset.young_modulus_pa, preset.high_pa})
      EXPECT_TRUE(hasTwoDigits(value)) << value;
    EXPECT_GE(preset.poisson_ratio, 0);
    EXPECT_LE(preset.poisson_ratio, 0.49);
    EXPECT_GE(preset.density_kg_per_m3, 250);
    EXPECT_LE(preset.density_kg_per_m3, 2000);
    EXPECT_EQ(std::fmod(preset.density_kg_per_m3, 10), 0);
    EXPECT_GT(std::string(preset.test).size(), 10U);
    EXPECT_TRUE(std::regex_search(preset.source, std::regex("(19|20)[0-9][0-9]"))) << "no year: " << preset.source;
    EXPECT_EQ((std::string(preset.test) + preset.source).find('|'), std::string::npos) << "spoils the table";
    EXPECT_EQ(std::string(preset.toughness_test).find('|'), std::string::npos) << "spoils the table";
    EXPECT_EQ(preset.toughness_j_per_m2 > 0, std::string(preset.toughness_test).size() > 10);
    if (preset.toughness_j_per_m2 > 0) {
      EXPECT_TRUE(hasTwoDigits(preset.toughness_j_per_m2));
    }
    EXPECT_EQ(std::string(preset.stiffening_test).find('|'), std::string::npos) << "spoils the table";
    EXPECT_EQ(preset.stiffening > 0, std::string(preset.stiffening_test).size() > 10);
    if (preset.stiffening > 0) {
      EXPECT_TRUE(hasTwoDigits(preset.stiffening));
    }
    expectNumbers(materialOf(std::string("tissue: ") + preset.name), preset.young_modulus_pa, preset.poisson_ratio,
                  preset.density_kg_per_m3);
  }
}

TEST(TissuePresets, GiveWhatTheSceneDoesNot) {
  expectNumbers(materialOf("young_modulus_pa: 9000, tissue: liver"), 9000, 0.49, 1060);
  expectNumbers(materialOf("tissue: liver, poisson_ratio: 0.4, density_kg_per_m3: 1000"), 6400, 0.4, 1000);
  EXPECT_EQ(materialOf("tissue: liver").mass_damping_per_s, MaterialConfig{}.mass_damping_per_s);
}

TEST(TissuePresets, GiveTheirToughnessWhereItIsAskedForAlone) {
  EXPECT_EQ(materialOf("tissue: liver").cut.toughness_j_per_m2, 0);
  const BodyConfig body =
      parseScene(
          "bodies: [{material: {tissue: liver, cut: {toughness_j_per_m2: auto}}, parts: [{part: a}, "
          "{part: b, tissue: skin}, {part: c, cut: {toughness_j_per_m2: 7}}]}]\n",
          "s.yaml")
          .bodies.at(0);
  EXPECT_EQ(body.material.cut.toughness_j_per_m2, 160);
  EXPECT_EQ(body.parts.at(0).cut.toughness_j_per_m2, 160);
  EXPECT_EQ(body.parts.at(1).cut.toughness_j_per_m2, 1100);
  EXPECT_EQ(body.parts.at(2).cut.toughness_j_per_m2, 7);
  for (const char* tissue : {"", "tissue: brain, "}) {
    EXPECT_TRUE(
        says(test::messageOf<SceneError>([&] { materialOf(std::string(tissue) + "cut: {toughness_j_per_m2: auto}"); }),
             {"s.yaml: body 'tissue': material.cut.toughness_j_per_m2: auto needs a tissue with a known toughness "
              "(liver,"}));
  }
}

TEST(TissuePresets, GiveTheirStiffeningWhereItIsAskedForAlone) {
  EXPECT_EQ(materialOf("tissue: skin").stiffening, 0);
  EXPECT_EQ(materialOf("tissue: skin, stiffening: auto").stiffening, 11);
  EXPECT_EQ(materialOf("tissue: skin, stiffening: 3").stiffening, 3);
  for (const char* tissue : {"", "tissue: spleen, "}) {
    EXPECT_TRUE(says(test::messageOf<SceneError>([&] { materialOf(std::string(tissue) + "stiffening: auto"); }),
                     {"s.yaml: body 'tissue': material.stiffening: auto needs a tissue with a known stiffening "
                      "(skin, heart_muscle, brain, lung), not "}));
  }
  EXPECT_TRUE(says(test::messageOf<SceneError>([&] { materialOf("tissue: skin, law: springs, stiffening: auto"); }),
                   {"needs material.law: neo_hookean"}));
}

TEST(TissuePresets, OfAPartGoBeforeItsBodysMaterialAndBehindItsOwnNumbers) {
  const BodyConfig body = parseScene(
                              "bodies: [{material: {tissue: liver, poisson_ratio: 0.3}, parts: [{part: a}, "
                              "{part: b, tissue: prostate_cancer, density_kg_per_m3: 1100}]}]\n",
                              "s.yaml")
                              .bodies.at(0);
  expectNumbers(body.parts.at(0), 6400, 0.3, 1060);
  expectNumbers(body.parts.at(1), 24000, 0.49, 1100);
  EXPECT_TRUE(body.parts[0].tissue.empty());
  const std::vector<std::string> notes = tissueNotes(body);
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_TRUE(says(
      notes[0], {"tissue liver: E 6400 Pa (3900 to 8000, strain < 1 %), nu 0.3 from the scene instead of 0.49, density "
                 "1060 kg/m3; ",
                 "Obrzut et al. 2019"}));
  EXPECT_TRUE(says(notes[1], {"part b, tissue prostate_cancer: E 24000 Pa", "density 1100 kg/m3 from the scene"}));
}

TEST(TissuePresets, AnUnknownNameIsRefusedWithAllThatThereAre) {
  std::vector<std::string> parts = {"s.yaml:2: 'bodies[0].material.tissue' must be one of ", "found 'livre'"};
  for (const TissuePreset& preset : tissuePresets()) parts.emplace_back(preset.name);
  const auto refused = [](const std::string& tissue) {
    return test::messageOf<SceneError>(
        [&] { parseScene("bodies:\n  - material: {tissue: " + tissue + "}\n", "s.yaml"); });
  };
  EXPECT_TRUE(says(refused("livre"), parts));
  EXPECT_TRUE(says(refused("[liver]"), {"'bodies[0].material.tissue' must be one of ", "found a list of 1"}));
  EXPECT_TRUE(says(refused("''"), {"'bodies[0].material.tissue' must be one of "}));
}

TEST(TissuePresets, FromOutsideGoBeforeNumbersOfTheFileAndBehindThoseFromOutside) {
  const std::string tissue = "bodies[0].material.tissue=spleen", young = "bodies[0].material.young_modulus_pa=7";
  expectNumbers(materialOf("mass_damping_per_s: 3", {tissue}), 17000, 0.49, 1050);
  expectNumbers(materialOf("young_modulus_pa: 5, poisson_ratio: 0.2, tissue: liver", {tissue}), 17000, 0.49, 1050);
  expectNumbers(materialOf("young_modulus_pa: 5", {tissue, young}), 7, 0.49, 1050);
  expectNumbers(materialOf("young_modulus_pa: 5", {young, tissue}), 7, 0.49, 1050);
  expectNumbers(materialOf("", {"bodies[0].material={tissue: spleen, poisson_ratio: 0.1}"}), 17000, 0.1, 1050);
}

TEST(TissuePresets, OfASurfaceHaveTheNuOfItsSprings) {
  const Scene scene = parseScene(
      "bodies: [{source: sheet, structure: surface, material: {tissue: small_intestine_wall}, spacing_m: 0.01}]\n",
      "s.yaml");
  expectNumbers(scene.bodies.at(0).material, 240000, MaterialConfig{}.poisson_ratio, 1030);
  const std::vector<std::string> notes = buildModel(scene).bodies.at(0).notes;
  EXPECT_TRUE(says(notes.at(0), {"tissue small_intestine_wall: E 240000 Pa", "nu of its springs"}));
}

TEST(TissuePresets, ASceneIsWhatItsNumbersAre) {
  const auto text = [](const std::string& material) {
    return sceneText(parseScene("bodies: [{material: {" + material + "}}]\n", "s.yaml"));
  };
  const std::string with = text("tissue: kidney, poisson_ratio: 0.45");
  EXPECT_EQ(with, text("young_modulus_pa: 5000, poisson_ratio: 0.45, density_kg_per_m3: 1050"));
  EXPECT_TRUE(says(with, {"bodies[0].material.young_modulus_pa=5000\n", "bodies[0].material.poisson_ratio=0.45"}));
}

TEST(TissuePresets, LabelsAreKnownByAllOfTheirWords) {
  EXPECT_EQ(nameOfLabel("liver"), "liver");
  EXPECT_EQ(nameOfLabel("Spleen"), "spleen");
  EXPECT_EQ(nameOfLabel("left_kidney"), "kidney");
  EXPECT_EQ(nameOfLabel("KidneyRight 2"), "kidney");
  EXPECT_EQ(nameOfLabel("lung_upper_lobe_left"), "lung");
  EXPECT_EQ(nameOfLabel("thyroid_gland"), "thyroid");
  EXPECT_EQ(nameOfLabel("heart_myocardium"), "heart_muscle");
  EXPECT_EQ(nameOfLabel("Prostate Tumor"), "prostate_cancer");
  for (const char* other : {"", "7", "left", "liver_vessels", "kidney_cyst_left", "gallbladder", "heart", "delivery"})
    EXPECT_EQ(nameOfLabel(other), "") << other;
}

}  // namespace
}  // namespace viscera
