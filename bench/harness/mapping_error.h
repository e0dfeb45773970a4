// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bench/harness/mapped_body.h"
#include "bench/harness/table.h"

namespace viscera::bench {

/// How far a mapped skin is from where the body is.
struct MappingError {
  double mean = 0, p95 = 0, max = 0;       ///< places, in spacings of the lattice
  double normal_mean = 0, normal_p95 = 0;  ///< shading normals [deg]
};

/// @param model  whose nodes go where `deformation` says; the mapping is that of its skin
/// @param deformation  also of the skin's vertices, and smooth enough for differences of 1e-4 spacings
MappingError mappingError(const Model& model, const Deformation& deformation,
                          MovedNormals normals = MovedNormals::kCarried);

/// Columns that follow those which say what was measured, and the cells of one row.
std::vector<Column> errorColumns();
void appendError(const MappingError& error, std::vector<Cell>& row);

}  // namespace viscera::bench
