// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "solver/tissue/substep.h"
#include "viscera/layout/limits.h"
#include "viscera/layout/nodes.h"

// The SIMD kernels of the CPU backend, compiled for several instruction sets and chosen at run time. They work on
// bricks. A vector is the 4x4 nodes of a plane, or as many of its rows as the lanes hold.
namespace viscera::simd {

/// Returns the index of the stiffness of a node's spring. All springs of a plane of nodes are adjacent, so that they
/// are read in the order of memory, and those of planes without nodes are not read.
constexpr size_t springAt(size_t slot, size_t spring) {
  return (slot >> 4) * 288 + spring * 16 + (slot & 15);
}

/// Arrays of a CpuLattice by slot, and the output.
struct Arrays {
  const layout::Brick* bricks;
  const layout::BodyParams* bodies;
  const float* displacement;      ///< [3 * slots] m
  const float* velocity;          ///< [3 * slots] m/s
  float* next_displacement;       ///< [3 * slots]
  float* next_velocity;           ///< [3 * slots]
  float* compensation;            ///< [6 * slots] rounding errors of displacement, then of velocity (Kahan); or null
  const float* spring_stiffness;  ///< [18 * slots] N/m (springAt)
  const float* mobility;          ///< [slots] 1/kg
  const layout::NodeBits* nodes;  ///< [slots] bits that show whether a stylus holds the node; null where none can
  const float* wall_forces;       ///< [3 * slots] N, forces on nodes of cells in thin walls; null without any
  const uint8_t* in_wall;         ///< [bricks] 1: the brick has such nodes
  const float* cell_sums;         ///< [kCellSums * bricks] N, sums of CellJob for bodies with a law; null without
  const uint8_t* uniform;         ///< [bricks] 1: all springs of all nodes are intact and have full strength
  const uint16_t* idle_rows;      ///< [bricks] bit r: none of the four nodes from 4 r on can ever move
};

/// A probe or a shaft in a substep: nodes with tissue in this sphere or capsule are tested one by one
/// (shaders/solver/tools/contact.glsl).
struct Reach {
  float center_m[3];  ///< center of the sphere, or one end of the capsule's axis
  float radius_m;
  float axis_m[3];        ///< from there to the other end of the axis
  float inverse_length2;  ///< 1 over the square of its length [1/m2]; 0: a sphere
};
constexpr size_t kMostReaches = 2 * layout::kMaxStyluses;

struct LeapfrogJob {
  Arrays arrays;
  Substep step;
  float* predicted;  ///< [3 * slots] u + dashpot_s v (physics.md 2) [m]; null without dashpots on springs
  size_t reaches;    ///< number of probes and shafts
  Reach reach[kMostReaches];
  uint8_t* near;       ///< [bricks] set to 1 where a node is within reach of a probe; null without probes
  uint16_t* strained;  ///< [bricks] bit i / 4: the vector from node i on was strained in the last substep; kept between
                       ///< substeps
  float* speed2;       ///< [bricks] largest |v|^2 after the substep [m2/s2]
};

/// Kernel that makes one substep of leapfrog for the nodes of some bricks: shaders/solver/step/leapfrog.comp without
/// its contacts.
using BrickLeapfrog = void (*)(const LeapfrogJob& job, const uint32_t* bricks, size_t count);
/// Kernel that writes `predicted` of some bricks. Call it for all bricks that a step reads before that step.
using BrickPredict = void (*)(const LeapfrogJob& job, const uint32_t* bricks, size_t count);

// Numbers of cells, several per cell, are stored by plane of 4x4 cells, and within a plane one number after the other.
constexpr size_t cellNumberAt(uint32_t slot, uint32_t number, uint32_t numbers) {
  return size_t{slot >> 4} * (16 * numbers) + size_t{number} * 16 + (slot & 15);
}
constexpr uint32_t kMomentNumbers = 9;   ///< first, square and mixed moments (cell_modes.glsl)
constexpr uint32_t kTensionNumbers = 6;  ///< of a prestress: xx, yy, zz, yz, zx, xy
/// Numbers of a laminate: its normal, share of a, shear moduli of a and b over their mean, K/mu of a and of b.
constexpr uint32_t kLaminateNumbers = 8;
constexpr uint32_t kBrokenSprings = 24;  ///< springs within a cell: 12 edges, along x, y and z, then 12 face diagonals
/// Numbers of a broken cell: stiffness of its springs, then the shortening at rest of springs along nine directions.
constexpr uint32_t kBrokenNumbers = kBrokenSprings + 9;

// Forces of a brick's 64 cells on their corners, summed by node and stored by plane of nodes; the fifth plane is above
// the brick. Order: sums for the nodes of its own rows, for the row behind them, then [x, y, z, 0] for each row's right
// neighbour and for the corner behind that.
constexpr size_t ownSumsAt(int plane, int component) {
  return static_cast<size_t>(plane * 48 + component * 16);
}
constexpr size_t rightSumsAt(int plane) {
  return 240 + static_cast<size_t>(plane) * 16;
}
constexpr size_t behindSumsAt(int plane, int component) {
  return 320 + static_cast<size_t>(plane * 12 + component * 4);
}
constexpr size_t cornerSumsAt(int plane) {
  return 380 + static_cast<size_t>(plane) * 4;
}
constexpr size_t kCellSums = 400;

// Cells in thin walls (physics.md 1, Thin walls). They are gathered into groups of kWallLanes, as a brick has only a
// few of them. Numbers are stored one after the other within a group.
constexpr uint32_t kWallLanes = 16;
/// Nodes of a cell: its corners, then for each corner the nodes beyond it, outwards, along x, y and z.
constexpr uint32_t kWallNodes = 32;
/// By axis and edge: weights of the second differences at its lower and upper end (CpuWalls).
constexpr uint32_t kWallEnds = 24;
/// Numbers of a wall: its normal, rows along x, y and z, relieved share of the stress across it, variation.
constexpr uint32_t kWallNumbers = 8;
struct WallGroups {
  const uint32_t* bodies;  ///< [groups]
  const uint32_t* first;   ///< [groups + 1] where a group's nodes begin in `listed`
  const uint32_t* listed;  ///< [listed] nodes of each group, each once: index of their displacement in places
  const uint16_t* nodes;   ///< [groups][kWallNodes][kWallLanes] four times an index among the group's nodes
  const float* ends;       ///< [groups][kWallEnds][kWallLanes]
  const float* moments;    ///< [groups][kMomentNumbers][kWallLanes]
  const float* numbers;    ///< [groups][kWallNumbers][kWallLanes]
  const float* strengths;  ///< [groups][2][kWallLanes] rigidity [J], 0 where there is no cell; bulk over rigidity
  const float* const* laminates;  ///< [groups] [kLaminateNumbers][kWallLanes]; null where no cell has two materials
  const float* positions;         ///< [nodes][4] displacements over 4 h: x, y, z
  float* forces;                  ///< [listed][4] N, sums of the forces of a group's cells on its nodes: x, y, z
  float* measured;                ///< [groups][2][kWallLanes] energy [J], and stiffness over that at rest
};
struct WallJob {
  const layout::BodyParams* bodies;
  WallGroups walls;
};
/// Kernel that writes the forces, or the measurements, of some groups.
using WallForces = void (*)(const WallJob& job, const uint32_t* groups, size_t count);

/// Input and output of the forces of cells that obey a law (shaders/solver/tissue/law.glsl).
struct CellJob {
  Arrays arrays;
  const uint16_t* idle_rows;      ///< [bricks] bit r: the four cells from 4 r on never act on a node that moves
  const float* bulk;              ///< [slots] J, bulk of the cell above a node
  const float* rigidity;          ///< [slots] J, its rigidity; both are 0 where there is no cell
  const float* const* moments;    ///< [bricks] [9 * 64] moments of its cells (CpuStrengths); null where all are full
  const uint16_t* partial_rows;   ///< [bricks] bit r: at least one of the four cells from 4 r on is partly filled
  const float* const* tension;    ///< [bricks] [kTensionNumbers * 64] prestress of its cells; null where none has one
  const float* const* laminates;  ///< [bricks] [kLaminateNumbers * 64] of its cells; null where none has two materials
  const float* const* broken;     ///< [bricks] [kBrokenNumbers * 64] N, of cells with a law that have lost a spring
                                  ///< (CpuStrengths); null where all are intact
  bool parts;                     ///< bulk over rigidity differs within a body
  bool dashpot;                   ///< at least one body has a dashpot
  float* sums;                    ///< [kCellSums * bricks] N
};
/// Kernel that writes the sums of the cells of some bricks.
using BrickCells = void (*)(const CellJob& job, const uint32_t* bricks, size_t count);

/// Measurements of a brick (shaders/solver/step/measure.comp).
struct BrickStats {
  float max_stretch, max_speed;
  double kinetic_j, elastic_j;
  float max_stiffening;  ///< largest stiffness over that at rest, of cells with a law; 0 without
  uint32_t nonfinite, collapsed, inverted;
};

struct MeasureJob {
  Arrays arrays;
  CellJob cells;  ///< its rigidity is null without a law
  const layout::NodeBits* nodes;
  const float* mass;  ///< [slots] kg
  BrickStats* stats;  ///< [bricks]
};
using BrickMeasure = void (*)(const MeasureJob& job, const uint32_t* bricks, size_t count);

/// Margin, over the sizes involved, of the search for nodes around a blade. It exceeds the rounding errors (1e-6).
constexpr float kSweepMargin = 1e-4f;

/// A blade's sweep, as seen by the nodes of one body. All vectors are relative to the blade's first tip [m].
struct Sweep {
  float center_m[3], radius_m;  ///< sphere around everything that the blade may cut
  float axes[3][3];             ///< unit vectors of a box around the sweep
  float low_m[3], high_m[3];    ///< bounds along these axes
};

/// Bounds of the 64 positions of a brick, relative to the blade's first tip; infinite if some are not finite.
struct BrickPositions {
  float low_m[3], high_m[3];
  float speed2;  ///< largest |v|^2 [m2/s2]
  bool near;     ///< some positions are in the sphere
};

struct SweepJob {
  const layout::Brick* bricks;
  const layout::BodyParams* bodies;
  const float *displacement, *velocity;
  const float* reach_m;       ///< [slots] largest distance of a node's tissue from the node
  float from_m[3];            ///< the blade's first tip, tissue frame
  const Sweep* sweeps;        ///< [bodies]
  BrickPositions* positions;  ///< [bricks]
  uint8_t* outside;  ///< [slots] sides of the box beyond which a node is, with its tissue: bit 2 k low, 2 k + 1 high
};
/// Kernel that writes `places` of bricks first..last - 1.
using BrickSweep = void (*)(const SweepJob& job, size_t first, size_t last);
/// Kernel that writes `outside` of the slots of some bricks.
using BrickSides = void (*)(const SweepJob& job, const uint32_t* bricks, size_t count);

struct NetworkJob;  // network_kernels.h
/// Kernel that works on groups first..last - 1 of the rows: spreads their vectors for lookup by far ends, or does one
/// point-centric substep of leapfrog (shaders/solver/step/leapfrog.comp without contacts).
using NetworkGroups = void (*)(const NetworkJob& job, size_t first, size_t last);

/// The kernels of one instruction set. Each solver chooses its own, independently of others in the process.
struct Kernels {
  std::string target;  ///< such as AVX2
  BrickLeapfrog leapfrog;
  BrickPredict predict;
  BrickMeasure measure;
  BrickCells cells;
  WallForces walls;
  WallForces measure_walls;
  NetworkGroups spread_network;  ///< for all groups, before their leapfrog
  NetworkGroups leapfrog_network;
  BrickSweep sweep;
  BrickSides sides;
};

/// Returns the instruction sets in the binary that this processor has, best first.
std::vector<std::string> targets();
/// Returns the kernels of an instruction set.
/// @param target  one of targets(); empty: the best
/// @return nothing if it is not one of them
std::optional<Kernels> kernelsFor(const std::string& target);

}  // namespace viscera::simd
