// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/scissors_edge.h"

#include <algorithm>
#include <cmath>

#include "model/scene/tool_kinds.h"

namespace viscera {

namespace {

void write(const Vector3d& from, layout::vec4& to) {
  to.x = static_cast<float>(from.x());
  to.y = static_cast<float>(from.y());
  to.z = static_cast<float>(from.z());
}

}  // namespace

Scissors scissorsOf(const ScissorsConfig& config) {
  return {config.blade_length_m, kClosedBlades_rad};
}

double crossing_m(const Scissors& scissors, double opening_rad) {
  const double half = 0.5 * std::max(opening_rad, scissors.closed_rad);
  return scissors.length_m * std::sin(0.5 * scissors.closed_rad) / std::sin(half);
}

double crossingPerRadian_m(const Scissors& scissors, double opening_rad) {
  if (opening_rad <= scissors.closed_rad) return 0;
  return 0.5 * crossing_m(scissors, opening_rad) / std::tan(0.5 * opening_rad);
}

void setEdge(const Scissors& scissors, const Closing& closing, layout::ToolMotion& out) {
  const double wide = std::tan(0.5 * std::max(closing.from_rad, scissors.closed_rad));
  const auto end = [&](double opening_rad, double side) {
    const double at_m = crossing_m(scissors, opening_rad);
    return Vector3d(side * wide * at_m, 0, scissors.length_m - at_m);
  };
  write(closing.from * end(closing.begin_rad, 1), out.from);
  write(closing.to * end(closing.end_rad, 1), out.to);
  write(closing.from * end(closing.begin_rad, -1), out.blade_from);
  write(closing.to * end(closing.end_rad, -1), out.blade_to);
}

double closingMoment_n_m(const Scissors& scissors, double opening_rad, double edge_n) {
  return edge_n * crossingPerRadian_m(scissors, opening_rad);
}

}  // namespace viscera
