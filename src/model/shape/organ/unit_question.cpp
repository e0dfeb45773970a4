// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/organ/unit_question.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace viscera {
namespace {

struct Unit {
  double scale_m;
  const char* name;
};
constexpr std::array<Unit, 4> kUnits = {
    {{1e-3, "millimetres"}, {1e-2, "centimetres"}, {0.0254, "inches"}, {1e-6, "micrometres"}}};
constexpr double kNear = 4;  ///< factor around the expected width within which a second unit is named too

}  // namespace

std::string unitQuestion(const BodyConfig& config, const Vector3d& size_m, double usual_m) {
  const double width_m = size_m.maxCoeff(), units = width_m / config.unit_scale_m;
  const auto factor = [&](const Unit& unit) { return std::abs(std::log(units * unit.scale_m / usual_m)); };
  std::array<Unit, kUnits.size()> likely = kUnits;
  std::stable_sort(likely.begin(), likely.end(), [&](const Unit& a, const Unit& b) { return factor(a) < factor(b); });
  std::ostringstream out;
  out.precision(4);
  out << "mesh file '" << config.mesh_file << "' is " << width_m
      << " m wide; should it be unit_scale_m=" << likely[0].scale_m << " (" << likely[0].name << ")";
  if (factor(likely[1]) < std::log(kNear)) out << " or " << likely[1].scale_m << " (" << likely[1].name << ")";
  out << "?";
  return out.str();
}

}  // namespace viscera
