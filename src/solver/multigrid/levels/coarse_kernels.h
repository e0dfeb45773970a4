// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace viscera::multigrid {

/// A matrix in blocks of 3x3, see BlockMatrix. A vector of 16 floats from the begin of the last block on is read.
struct BlockRows {
  const uint32_t *starts, *columns;
  const float* numbers;
};

/// y = A x, or y -= A x, of some rows. @param x, y  four floats a node, the last one 0
using MultiplyRows = void (*)(const BlockRows& matrix, const float* x, float* y, bool subtract, size_t first,
                              size_t end);

/// Of the best instruction set that the processor has.
MultiplyRows multiplyRows();

}  // namespace viscera::multigrid
