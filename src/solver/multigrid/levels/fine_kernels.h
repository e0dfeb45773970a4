// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include "viscera/layout/nodes.h"

// SIMD kernels of multigrid's finest level, compiled for several instruction sets. Numbers of a place come component by
// component, `places` floats apart; places without a node or a cell hold zeros.
namespace viscera::multigrid {

constexpr size_t kBlock = 16;          ///< places that are worked on together: the widest vector of floats
constexpr size_t kPairs = 9;           ///< springs that a node owns: those of even index (neighbors.h)
constexpr size_t kTangentNumbers = 4;  ///< of a spring: T = s s^T + t 1, as s and t
constexpr size_t kCornerNumbers = 24;  ///< forces of a cell on its corners

/// A body's box of places.
struct Box {
  ptrdiff_t row = 0, layer = 0;  ///< places to the next along y, and along z
  layout::BodyParams params{};
  float damping_rate_per_s = 0;  ///< d velocity / d displacement of the stage that is solved
};

/// kBlock places from `at` on.
struct Block {
  uint32_t at;
  uint32_t body;
};

/// What cells have beside springs.
enum class CellKind { kNone, kVolumes, kMoments, kPartialMoments };

struct FineArrays {
  size_t places;
  const Box* boxes;           ///< [bodies]
  const float* displacement;  ///< [3] m, at which all is linear
  const float* velocity;      ///< [3] m/s, for dashpots
  const float* stiffness;     ///< [kPairs] N/m
  const float* diagonal;      ///< [1] N/m of inertia and drag
  const float* free;          ///< [1] 1 of nodes that are solved for, 0 of others
  const float* bulk;          ///< [1] J of the cell above a place
  const float* rigidity;      ///< [1] J
  const float* moments;       ///< [9] of cells, over their shares, the first ones times 2 h; null where all are full
  const uint32_t*
      bend_block;      ///< [places / kBlock] 1 + which of `bends` has their cells' numbers, 0 none; null without any
  const float* bends;  ///< [kBendNumbers * kBlock] each, of cells in thin walls, those with strains times 2 h
  uint16_t* tangent;   ///< [kPairs * kTangentNumbers] sqrt(N/m), N/m
  float* edges;        ///< [9] mean edges of cells less their rest value, over h
  float* resists;      ///< [3] curvature of the volume's energy [J]; what moments are times [N/m], and how sure
  float* corners;      ///< [kCornerNumbers] N, corner by corner
  float* force;        ///< [3] N of springs, dashpots and cells
  float* inverse;      ///< [6] m/N of the block diagonal: xx, xy, xz, yy, yz, zz; 0 where not free
  CellKind cells;
};

/// Cells of some blocks: edges, resists, forces on corners, or forces alone. @param energy_j  of all, added to
using EvaluateCells = void (*)(const FineArrays& arrays, const Block* blocks, size_t count, double* energy_j);
/// Nodes of some blocks: tangent, force, inverse, or forces alone. After all cells. @param energy_j  of their springs,
/// added to
using EvaluateNodes = void (*)(const FineArrays& arrays, const Block* blocks, size_t count, double* energy_j);
/// Forces on the corners of cells that a change of displacement makes.
using ApplyCells = void (*)(const FineArrays& arrays, const float* x, const Block* blocks, size_t count);
/// y = A x, or y -= A x, of the nodes of some blocks; 0 where not free. After ApplyCells of the same x.
using ApplyNodes = void (*)(const FineArrays& arrays, const float* x, float* y, bool subtract, const Block* blocks,
                            size_t count);

/// A step of a smoother: r -= A x; d = again x + by D^-1 r; z = x + d, or z += carried x + d.
struct Smoothing {
  const float* x;
  float *r, *d, *z;
  const float* with;  ///< its product with z is summed; may be null
  float again, by, carried;
  bool fresh;  ///< z is not read
};
/// Of the nodes of some blocks, after ApplyCells of the same x. @param sum  with . z, added to
using SmoothNodes = void (*)(const FineArrays& arrays, const Smoothing& smoothing, const Block* blocks, size_t count,
                             double* sum);
/// copy = r, d = by D^-1 r.
using PreconditionNodes = void (*)(const FineArrays& arrays, const float* r, float by, float* copy, float* d,
                                   const Block* blocks, size_t count);
/// s += alpha p, r -= alpha q. @param sum  r . r, added to
using AdvanceNodes = void (*)(size_t places, float alpha, const float* p, const float* q, float* s, float* r,
                              const Block* blocks, size_t count, double* sum);
/// p = z + beta p; where beta is 0, p is not read.
using TurnNodes = void (*)(size_t places, float beta, const float* z, float* p, const Block* blocks, size_t count);
/// a . b, added to
using DotNodes = void (*)(size_t places, const float* a, const float* b, const Block* blocks, size_t count,
                          double* sum);

struct FineKernels {
  EvaluateCells linearise_cells;
  EvaluateNodes linearise_nodes;
  EvaluateCells evaluate_cells;
  EvaluateNodes evaluate_nodes;
  ApplyCells apply_cells;
  ApplyNodes apply_nodes;
  SmoothNodes smooth_nodes;
  PreconditionNodes precondition_nodes;
  AdvanceNodes advance_nodes;
  TurnNodes turn_nodes;
  DotNodes dot_nodes;
};

/// @param target  name of an instruction set that simd::targets() has; empty: the best
FineKernels fineKernelsFor(const char* target = "");

}  // namespace viscera::multigrid
