// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace viscera {

struct Scene;

/// Memory that this process can have without swapping [bytes]: what the machine has, or what its control group (of
/// version 1 or 2, such as a container's) leaves of a limit, where that is less. Infinite where none is told.
/// @param root  of the file system, for tests
double availableBytes(const std::string& root = "");

/// What a solid's lattice takes for each of its cells, with nodes, springs, skin, and what steps and shows them
/// [bytes]. Slope of the peak of memory over cells of `viscera run` of a full box of 0.1 m at 2 and at 1.25 mm: 641 on
/// the CPU, 579 on the GPU (llvmpipe, whose buffers are in the host's memory).
constexpr double kBytesPerFilledCell = 650;

/// What a cell that is tissue in part takes beyond that: its moments in the solid, the lattice and the solver.
constexpr double kBytesPerPartialCell = 350;

/// What contacts between nodes take beyond that for each cell: lists of who is near, and, where an implicit integrator
/// solves for them (solver/contact/node_pairs.h), lists where increments lead, pairs and their forces. Slopes of the
/// same, of boxes of 40^3 and 60^3 cells on the CPU: 204 to 224, and 1031 to 1077.
constexpr double kBytesPerCellOfContacts = 230, kBytesPerCellOfSolvedContacts = 1080;

/// What a scene's bodies take for each of their cells [bytes].
double bytesPerFilledCell(const Scene& scene);

/// @param filled_cells  of a solid   @param bytes_per_cell  bytesPerFilledCell()   @param available_bytes  for tests
/// @throws LatticeError  they need more memory than there is; names the spacing that fits
void requireTissueMemory(size_t filled_cells, double spacing_m, double bytes_per_cell,
                         double available_bytes = availableBytes());

}  // namespace viscera
