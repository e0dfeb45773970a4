// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/tissue_presets.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "math/number_text.h"
#include "model/scene/structure_rules.h"

namespace viscera {
namespace {

constexpr double kWet = 0.49;  ///< nu on a scale of seconds, in which no water leaves: as near to 1/2 as lattices allow

constexpr const char* kElastography = "< 1 %";  ///< some 10 um of waves that are centimetres long

// Two digits, as tests of one tissue differ by more. E is three times a measured shear modulus.
const std::vector<TissuePreset> kPresets = {
    {"liver", 6400, 3900, 8000, kWet, 1060, kElastography,
     "MR elastography of 102 healthy people, 4.1 to 8.0 kPa; ultrasound of 50 has means of 3.9 to 4.7",
     "Obrzut et al. 2019, Pol Arch Intern Med; Viceconti et al. 2025, World J Radiol", "hepar", 160,
     "needles of four widths, ox, 164 +- 6; other needles 76 to 185, blades 187 to 225, pig. Gokgol et al. 2012, Med "
     "Eng "
     "Phys 34:882; [review](#toughness)"},
    {"spleen", 17000, 2900, 23000, kWet, 1050, kElastography,
     "ultrasound elastography of 59 healthy people, 16.6 +- 2.5 kPa; means of others are 2.9 and 19 to 23",
     "J Ultrasound 2016, PMC5059412; Arda et al. 2011, AJR 197:532; Viceconti et al. 2025", ""},
    {"kidney", 5000, 2100, 7900, kWet, 1050, kElastography, "ultrasound elastography of the cortex, 127 healthy people",
     "Arda et al. 2011, AJR 197:532", "kidneys, kidney cortex, renal cortex"},
    {"pancreas", 4800, 1800, 7800, kWet, 1050, kElastography,
     "ultrasound elastography of 127 healthy people; of 50 others the means are 5.2 to 7.6 kPa",
     "Arda et al. 2011, AJR 197:532; Viceconti et al. 2025, World J Radiol", ""},
    {"thyroid", 11000, 7900, 14000, kWet, 1000, kElastography, "ultrasound elastography of 127 healthy people",
     "Arda et al. 2011, AJR 197:532", ""},
    {"salivary_gland", 10000, 6900, 14000, kWet, 1030, kElastography,
     "ultrasound elastography of 127 healthy people, parotid and submandibular", "Arda et al. 2011, AJR 197:532",
     "parotid, submandibular"},
    {"prostate", 17000, 8000, 26000, kWet, 1030, "", "indentation of 46 specimens, where there is no cancer",
     "Ahn et al. 2010, Urology 76:1007", ""},
    {"prostate_cancer", 24000, 9600, 39000, kWet, 1030, "", "indentation of 46 specimens, where there is cancer",
     "Ahn et al. 2010, Urology 76:1007", "prostate tumor, prostate tumour"},
    {"uterus", 30000, 30000, 90000, kWet, 1050, "1, 2 %",
     "compression of 1 to 2 %, 24 women, from 0.1 to 100 Hz; cervix too", "Kiss et al. 2006, Phys Med Biol 51:3683",
     "cervix, uterine cervix"},
    {"breast", 3000, 1900, 4200, kWet, 1020, "", "suction in vivo, fat and gland together, 7 volunteers",
     "In vivo measurement of breast tissues stiffness using a light aspiration device, Clin Biomech 2022", "breasts"},
    {"fat", 1600, 660, 2500, kWet, 910, "",
     "indentation below the skin in MR, pig; MR elastography of 10 women at 50 Hz has 2.3 kPa",
     "Sims et al. 2010, Biomech Model Mechanobiol 9:703; Hatt et al. 2023, J Mech Behav Biomed Mater",
     "subcutaneous fat, adipose", 4100,
     "trouser tear, pig: torn, not cut; a sharp blade may need less. [Review](#toughness)"},
    {"skin", 56000, 40000, 73000, 0.48, 1150, "",
     "suction in vivo, breast, 7 volunteers; other tests and skins differ by far more",
     "In vivo measurement of breast tissues stiffness using a light aspiration device, Clin Biomech 2022", "", 1100,
     "needle, pig, 1136; scissors 1700 (rat), 2800 (chicken); torn 17,000 to 30,000. [Review](#toughness)", 11,
     "[pig, two ways](#stiffening)"},
    {"muscle", 11000, 3000, 15000, kWet, 1050, kElastography,
     "ultrasound elastography at rest, calf; MR elastography of the buttock has 3 kPa. Fibrous: lattices are isotropic",
     "Arda et al. 2011, AJR 197:532; Hatt et al. 2023, J Mech Behav Biomed Mater",
     "muscles, autochthon, iliopsoas, gluteus maximus, gluteus medius, gluteus minimus, masseter", 2100,
     "notched strips, pig, 550 to 8000, of which this is the middle by factors; strips that small may break elsewhere. "
     "[Review](#toughness)"},
    {"heart_muscle", 7800, 6000, 21000, kWet, 1040, kElastography,
     "ultrasound elastography at the end of diastole, 20 to 80 years. Fibrous: lattices are isotropic",
     "Villemain et al. 2019, JACC Cardiovasc Imaging", "myocardium, heart myocardium", 0, "", 9.8,
     "[human, shear](#stiffening)"},
    {"brain", 1600, 1100, 5600, kWet, 1040, "",
     "flat punch, ox: grey 1.4 +- 0.3, white 1.9 +- 0.6 kPa; indentation of pigs in vivo has 5.6 at once",
     "Budday et al. 2015, J Mech Behav Biomed Mater 46:318; table 1 of J Funct Biomater 3:839, 2012", "", 0, "", 22,
     "[human cortex](#stiffening)"},
    {"lung", 1700, 740, 3900, 0.43, 290, "",
     "indentation and tension, dog: 1.5 to 2 times the pressure of the air, 5 to 20 cm of water; here 10",
     "Lai-Fook et al. 1976, J Appl Physiol 40:508", "lungs", 0, "", 1.2, "[rat, slices](#stiffening)"},
    {"cartilage", 1000000, 480000, 1600000, 0.02, 1100, "",
     "creep indentation, human tibia, drained: after minutes; within seconds nu is near 1/2",
     "Keenan et al. 2009, Comput Methods Biomech Biomed Engin 12:415", "articular cartilage", 410,
     "notched strips, 140 to 1200, of which this is the middle by factors. [Review](#toughness)"},
    {"meniscus", 180000, 96000, 270000, 0.32, 1100, "", "compression to equilibrium, drained: after minutes; ox, 6",
     "Danso et al. 2018, J Biomech", ""},
    {"small_intestine_wall", 240000, 180000, 310000, kWet, 1030, "small",
     "biaxial tension at low strain, pig, 33: 310 kPa along, 180 around", "Terry et al. 2014, IJECB 2:4", ""},
    {"gallbladder_wall", 260000, 230000, 280000, kWet, 1060, "", "slow tests, compiled: mu 85 +- 8.2 kPa",
     "table 1 of Phys Med Biol 64:225001, 2019", ""},
    {"bile_duct_wall", 500000, 300000, 700000, kWet, 1060, "", "slow tests, compiled: mu 166 +- 67 kPa",
     "table 1 of Phys Med Biol 64:225001, 2019", ""},
    {"hepatic_artery_wall", 630000, 490000, 770000, kWet, 1050, "", "slow tests, compiled: mu 210 +- 47 kPa",
     "table 1 of Phys Med Biol 64:225001, 2019", ""},
    {"hepatic_vein_wall", 620000, 210000, 1000000, kWet, 1050, "small", "slow tension at small strain, pig, 20",
     "Umale et al. 2011, J Biomech 44:1678", ""}};

std::string numberOf(double value) {
  TextOut out;
  out << value;
  return value < 1e6 ? out.str() : std::to_string(static_cast<long>(value));
}

/// Returns the words in lower case, without sides, lobes and numbers: "KidneyLeft_2" gives "kidney".
std::vector<std::string> wordsOf(const std::string& text) {
  static const std::set<std::string> kAside = {"left", "right", "l",     "r",     "upper",  "middle", "lower",
                                               "lobe", "gland", "organ", "whole", "tissue", "segment"};
  std::vector<std::string> words(1);
  bool was_small = false;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalpha(byte) == 0 || (was_small && std::isupper(byte) != 0)) words.emplace_back();
    if (std::isalpha(byte) != 0) words.back() += static_cast<char>(std::tolower(byte));
    was_small = std::islower(byte) != 0;
  }
  words.erase(std::remove_if(words.begin(), words.end(),
                             [](const std::string& word) { return word.empty() || kAside.count(word) > 0; }),
              words.end());
  return words;
}

/// Returns a note on which values of a preset are in use.
template <class Config>
std::string noteOf(const Config& config, bool of_springs) {
  const TissuePreset& preset = *tissueNamed(config.tissue);
  const auto value = [](const std::string& name, double value, double of_preset, const std::string& unit) {
    return name + " " + numberOf(value) + unit +
           (value == of_preset ? "" : " from the scene instead of " + numberOf(of_preset) + unit);
  };
  return std::string("tissue ") + preset.name + ": " +
         value("E", config.young_modulus_pa, preset.young_modulus_pa, " Pa") + " (" + numberOf(preset.low_pa) + " to " +
         numberOf(preset.high_pa) + (*preset.strain ? std::string(", strain ") + preset.strain : "") + "), " +
         (of_springs ? "nu of its springs" : value("nu", config.poisson_ratio, preset.poisson_ratio, "")) + ", " +
         value("density", config.density_kg_per_m3, preset.density_kg_per_m3, " kg/m3") + "; " + preset.test + "; " +
         preset.source;
}

}  // namespace

const std::vector<TissuePreset>& tissuePresets() {
  return kPresets;
}

const TissuePreset* tissueNamed(const std::string& name) {
  const auto found =
      std::find_if(kPresets.begin(), kPresets.end(), [&](const TissuePreset& preset) { return name == preset.name; });
  return found == kPresets.end() ? nullptr : &*found;
}

const TissuePreset* tissueOfLabel(const std::string& label) {
  const std::vector<std::string> words = wordsOf(label);
  if (words.empty()) return nullptr;
  for (const TissuePreset& preset : kPresets) {
    if (words == wordsOf(preset.name)) return &preset;
    TextIn labels(preset.labels);
    for (std::string other; std::getline(labels, other, ',');) {
      if (words == wordsOf(other)) return &preset;
    }
  }
  return nullptr;
}

std::string tissuesWith(double TissuePreset::*number) {
  std::string out;
  for (const TissuePreset& preset : kPresets) {
    if (preset.*number > 0) out += (out.empty() ? "" : ", ") + std::string(preset.name);
  }
  return out;
}

std::string tissueTable() {
  TextOut out;
  out << "| tissue | E, Pa | from, to, Pa | strain | nu | density, kg/m3 | J, J/m2 | b | test of E | source | test and "
         "source "
         "of J | test of b |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const TissuePreset& p : kPresets) {
    out << "| `" << p.name << "` | " << numberOf(p.young_modulus_pa) << " | " << numberOf(p.low_pa) << ", "
        << numberOf(p.high_pa) << " | " << p.strain << " | " << p.poisson_ratio << " | " << p.density_kg_per_m3 << " | "
        << (p.toughness_j_per_m2 > 0 ? numberOf(p.toughness_j_per_m2) : "") << " | "
        << (p.stiffening > 0 ? numberOf(p.stiffening) : "") << " | " << p.test << " | " << p.source << " | "
        << p.toughness_test << " | " << p.stiffening_test << " |\n";
  }
  return out.str();
}

/// Returns a note if the tissue is softer than organs are, else empty.
std::string softNote(const std::string& what, double young_modulus_pa) {
  constexpr double kSoftest_pa = 100;  // fat and brain have a few hundred (docs/tissues.md)
  if (young_modulus_pa >= kSoftest_pa) return "";
  return what + ": a young_modulus_pa of " + numberText(young_modulus_pa) +
         " Pa is softer than any organ; was it given in kPa?";
}

std::vector<std::string> tissueNotes(const BodyConfig& body) {
  std::vector<std::string> notes;
  if (const std::string note = softNote("material", body.material.young_modulus_pa); !note.empty())
    notes.push_back(note);
  for (const PartConfig& part : body.parts)
    if (const std::string note = softNote("part " + part.part, part.young_modulus_pa); !note.empty())
      notes.push_back(note);
  if (body.target_nodes > 0 && !body.auto_spacing && body.spacing_m != BodyConfig{}.spacing_m)
    notes.push_back("spacing_m " + numberText(body.spacing_m) + " is ignored: target_nodes " +
                    std::to_string(body.target_nodes) + " sets the resolution of the lattice");
  if (!body.material.tissue.empty()) notes.push_back(noteOf(body.material, isNetwork(body.structure)));
  for (const PartConfig& part : body.parts) {
    if (!part.tissue.empty()) notes.push_back("part " + part.part + ", " + noteOf(part, false));
  }
  return notes;
}

}  // namespace viscera
