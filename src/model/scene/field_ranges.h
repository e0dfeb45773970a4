// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace viscera {

// A visitor of keys has one function for each kind of key:
// * number(key, double&, Range, unit, text)
// * numberOrAuto(key, double&, bool& is_auto, Range, unit, text)
// * integer(key, int&, Range, text)
// * text(key, std::string&, text)
// * boolean(key, bool&, text)
// * vector(key, Vector3d&, Range, unit, text)
// * vectorOrNone(key, std::optional<Vector3d>&, Range, unit, text)
// * choice(key, Enum&, {{name, value}...}, text)
// * tissue(key, Struct&, text): sets young_modulus_pa, poisson_ratio and density_kg_per_m3, which come after it
// * group(key, Struct&, text)
// * listedGroup(key, Struct&, text): a group with keys that a table has elsewhere
// * list(key, std::vector<Struct>&, max_count, text, defaults of an item = {})

/// Accepted values, inclusive at both ends.
struct Range {
  double min, max;
};
template <class E>
struct Choice {
  const char* name;
  E value;
};
template <class E>
using Choices = std::vector<Choice<E>>;

constexpr Range kLength{0, 10};         // m: organs and rooms
constexpr Range kCoordinate{-10, 10};   // m
constexpr Range kDirection{-1e3, 1e3};  // any length but zero
constexpr Range kAngle{-360, 360};      // degrees

}  // namespace viscera
