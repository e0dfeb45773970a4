// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "model/shape/solid/solid_shell.h"

namespace viscera {

/// A part as far as it matters to how much of the grid stays empty.
struct NamedShell {
  const Shell* shell;
  std::string name;
};

/// Grids are dense: what lies between parts that are far apart is walked cell by cell.
/// @throws LatticeError  by far the most of a large grid would be the empty space between parts: which part is how far
/// away, and how far it may be at this spacing
void requireParted(const std::vector<NamedShell>& shells, double spacing_m);

/// What to add to an error about the spacing where the true reason is a part far away; empty where there is none.
std::string farPartNote(const std::vector<NamedShell>& shells);

}  // namespace viscera
