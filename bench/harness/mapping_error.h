// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bench/harness/mapped_body.h"
#include "bench/harness/table.h"

namespace viscera::bench {

/// Deviation of a mapped surface from the body.
struct MappingError {
  double mean = 0, p95 = 0, max = 0;       ///< position errors, in spacings of the lattice
  double normal_mean = 0, normal_p95 = 0;  ///< errors of shading normals [deg]
};

/// Measures the error of a mapping.
/// @param model  model with nodes displaced by `deformation`; the mapping is that of its surface
/// @param deformation  also applied to the surface's vertices; smooth enough for differences of 1e-4 spacings
MappingError mappingError(const Model& model, const Deformation& deformation,
                          MovedNormals normals = MovedNormals::kCarried);

/// Returns the columns of errors, which follow those that describe the measurement; appendError() adds one row's cells.
std::vector<Column> errorColumns();
void appendError(const MappingError& error, std::vector<Cell>& row);

}  // namespace viscera::bench
