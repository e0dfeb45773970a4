// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "model/shape/solid/solid_shell.h"

namespace viscera {

/// Part of a mesh, for the check of empty space in its grid.
struct NamedShell {
  const Shell* shell;
  std::string name;
};

/// Checks the empty space between parts. Grids are dense, so space between distant parts is traversed cell by cell.
/// @throws LatticeError  a large grid would consist almost entirely of the empty space between parts: names the part
/// and its distance, and the distance accepted at this spacing
void requireParted(const std::vector<NamedShell>& shells, double spacing_m);

/// Returns text for an error about the spacing where the true reason is a distant part; empty where there is none.
std::string farPartNote(const std::vector<NamedShell>& shells);

}  // namespace viscera
