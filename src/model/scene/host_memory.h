// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace viscera {

struct Scene;

/// Returns the memory that this process can use without swapping [bytes]: that of the machine, or what the limit of its
/// control group (of version 1 or 2, such as a container's) leaves, where that is less. Infinite where neither is
/// known.
/// @param root  of the file system, for tests
double availableBytes(const std::string& root = "");

/// Memory per cell of a solid's lattice [bytes], with nodes, springs, surface mesh, solver and renderer. Slope of the
/// peak of memory over cells of `viscera run` for a full box of 0.1 m at 2 and at 1.25 mm: 641 on the CPU, 579 on the
/// GPU (llvmpipe, with its buffers in host memory).
constexpr double kBytesPerFilledCell = 650;

/// Additional memory of a partly filled cell [bytes]: its moments in the solid, the lattice and the solver.
constexpr double kBytesPerPartialCell = 350;

/// Additional memory per cell for contacts between nodes [bytes]: lists of neighbours. Where an implicit integrator
/// solves for contacts (solver/contact/node_pairs.h), also lists of the targets of increments, pairs and their forces.
/// Slopes of the same measurement, for boxes of 40^3 and 60^3 cells on the CPU: 204 to 224, and 1031 to 1077.
constexpr double kBytesPerCellOfContacts = 230, kBytesPerCellOfSolvedContacts = 1080;

/// Returns the memory per cell of a scene's bodies [bytes].
double bytesPerFilledCell(const Scene& scene);

/// Checks that a solid's tissue fits in memory.
/// @param filled_cells  of a solid   @param bytes_per_cell  bytesPerFilledCell()   @param available_bytes  for tests
/// @throws LatticeError  the cells need more memory than there is; names the spacing that fits
void requireTissueMemory(size_t filled_cells, double spacing_m, double bytes_per_cell,
                         double available_bytes = availableBytes());

}  // namespace viscera
