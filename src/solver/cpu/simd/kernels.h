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
// bricks; a vector is the 4x4 nodes of a plane, or as many rows of them as it has lanes for.
namespace viscera::simd {

/// Index of the stiffness of a node's spring: all springs of a plane of nodes lie together, so that they are read in
/// the order in which they lie in memory, and none where no node of a plane is.
constexpr size_t springAt(size_t slot, size_t spring) {
  return (slot >> 4) * 288 + spring * 16 + (slot & 15);
}

/// Arrays of a CpuLattice, with its slots, and what is written.
struct Arrays {
  const layout::Brick* bricks;
  const layout::BodyParams* bodies;
  const float* displacement;      ///< [3 * slots] m
  const float* velocity;          ///< [3 * slots] m/s
  float* next_displacement;       ///< [3 * slots]
  float* next_velocity;           ///< [3 * slots]
  float* compensation;            ///< [6 * slots] what sums of displacement, then of velocity have lost; or null
  const float* spring_stiffness;  ///< [18 * slots] N/m (springAt)
  const float* mobility;          ///< [slots] 1/kg
  const layout::NodeBits* nodes;  ///< [slots] says who is held; null where none can be
  const float* wall_forces;       ///< [3 * slots] N on nodes of cells in thin walls; null without any
  const uint8_t* in_wall;         ///< [bricks] it has such nodes
  const float* cell_sums;         ///< [kCellSums * bricks] N, of CellJob, in bodies of a law; null without
  const uint8_t* uniform;         ///< [bricks] all springs of all nodes are whole and of full strength
  const uint16_t* idle_rows;      ///< [bricks] bit r: none of the four nodes from 4 r on will ever move
};

/// A probe in a substep: nodes that reach into this sphere are looked at one by one
/// (shaders/solver/tools/contact.glsl).
struct Reach {
  float center_m[3];
  float radius_m;
};

struct LeapfrogJob {
  Arrays arrays;
  Substep step;
  float* predicted;  ///< [3 * slots] u + dashpot_s v (physics.md 2) [m]; null without dashpots on springs
  size_t reaches;    ///< probes
  Reach reach[layout::kMaxStyluses];
  uint8_t* near;       ///< [bricks] set where a node is within reach of a probe; null without probes
  uint16_t* strained;  ///< [bricks] bit i / 4: the vector from node i on was strained in the last substep; kept here
  float* speed2;       ///< [bricks] largest |v|^2 after the substep [m2/s2]
};

/// One substep of leapfrog, as in shaders/solver/step/leapfrog.comp without its contacts, of the nodes of some bricks.
using BrickLeapfrog = void (*)(const LeapfrogJob& job, const uint32_t* bricks, size_t count);
/// Writes `predicted` of some bricks: of all that those to be stepped look at, before these are.
using BrickPredict = void (*)(const LeapfrogJob& job, const uint32_t* bricks, size_t count);

// Numbers of cells, several of each, lie plane by plane of 4x4 cells, and number by number within a plane.
constexpr size_t cellNumberAt(uint32_t slot, uint32_t number, uint32_t numbers) {
  return size_t{slot >> 4} * (16 * numbers) + size_t{number} * 16 + (slot & 15);
}
constexpr uint32_t kMomentNumbers = 9;   ///< first, square, mixed (cell_motion.glsl)
constexpr uint32_t kTensionNumbers = 6;  ///< of a stress at rest: xx, yy, zz, yz, zx, xy
/// Of a laminate: its normal, share of a, shear moduli of a and b over their mean, K/mu of a and of b.
constexpr uint32_t kLaminateNumbers = 8;
constexpr uint32_t kBrokenSprings = 24;  ///< within a cell: 12 edges, along x, y and z, then 12 face diagonals
/// Of a broken cell: stiffness of its springs, then how much shorter those along nine directions are at rest.
constexpr uint32_t kBrokenNumbers = kBrokenSprings + 9;

// Forces of a brick's 64 cells on their corners, summed by node, plane by plane of nodes (the fifth is that above the
// brick): on the nodes of its own rows, of the row behind them, then of each row's right neighbour and of the corner
// behind that, [x, y, z, 0] per node.
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

// Cells in thin walls (physics.md 1, Thin walls), in groups of kWallLanes: of few cells of a brick each, so that they
// are gathered. Numbers lie number by number within a group.
constexpr uint32_t kWallLanes = 16;
/// Of a cell: its corners, then beyond each corner, outwards, the nodes along x, y and z.
constexpr uint32_t kWallNodes = 32;
/// By axis and edge: how the second differences at its lower and upper end count (CpuWalls).
constexpr uint32_t kWallEnds = 24;
/// Of a wall: its normal, rows along x, y and z, share of the stress across that is free, variation.
constexpr uint32_t kWallNumbers = 8;
struct WallGroups {
  const uint32_t* bodies;         ///< [groups]
  const uint32_t* nodes;          ///< [groups][kWallNodes][kWallLanes] where displacements of its nodes begin in places
  const float* ends;              ///< [groups][kWallEnds][kWallLanes]
  const float* moments;           ///< [groups][kMomentNumbers][kWallLanes]
  const float* numbers;           ///< [groups][kWallNumbers][kWallLanes]
  const float* strengths;         ///< [groups][2][kWallLanes] rigidity [J], 0 where there is no cell; bulk over it
  const float* const* laminates;  ///< [groups] [kLaminateNumbers][kWallLanes]; null where none is of two materials
  const float* places;            ///< [nodes][4] displacements over 4 h, x, y, z
  float* forces;                  ///< [groups][kWallLanes][kWallNodes][4] of cells on their nodes, x, y, z [N]
  float* measured;                ///< [groups][2][kWallLanes] energy [J], and how much stiffer than at rest
};
struct WallJob {
  const layout::BodyParams* bodies;
  WallGroups walls;
};
/// Writes forces of some groups; or what is measured of them.
using WallForces = void (*)(const WallJob& job, const uint32_t* groups, size_t count);

/// Forces of cells that obey a law (shaders/solver/tissue/law.glsl).
struct CellJob {
  Arrays arrays;
  const uint16_t* idle_rows;     ///< [bricks] bit r: the four cells from 4 r on never do anything to a node that moves
  const float* bulk;             ///< [slots] J of the cell above a node
  const float* rigidity;         ///< [slots] J; both 0 where there is none
  const float* const* moments;   ///< [bricks] [9 * 64] of its cells (CpuStrengths); null where all are full
  const uint16_t* partial_rows;  ///< [bricks] bit r: some of the four cells from 4 r on is tissue in part
  const float* const* tension;   ///< [bricks] [kTensionNumbers * 64] of its cells; null where none is stressed at rest
  const float* const*
      laminates;               ///< [bricks] [kLaminateNumbers * 64] of its cells; null where none is of two materials
  const float* const* broken;  ///< [bricks] [kBrokenNumbers * 64] N of cells of a law that have lost a spring
                               ///< (CpuStrengths); null where all are whole
  bool parts;                  ///< bulk over rigidity differs within a body
  bool dashpot;                ///< some body has one
  float* sums;                 ///< [kCellSums * bricks] N
};
/// Sums of the cells of some bricks.
using BrickCells = void (*)(const CellJob& job, const uint32_t* bricks, size_t count);

/// What is measured of a brick (shaders/solver/step/measure.comp).
struct BrickStats {
  float max_stretch, max_speed;
  double kinetic_j, elastic_j;
  float max_stiffening;  ///< of cells of a law; 0 without
  uint32_t nonfinite, collapsed, inverted;
};

struct MeasureJob {
  Arrays arrays;
  CellJob cells;  ///< rigidity null without a law
  const layout::NodeBits* nodes;
  const float* mass;  ///< [slots] kg
  BrickStats* stats;  ///< [bricks]
};
using BrickMeasure = void (*)(const MeasureJob& job, const uint32_t* bricks, size_t count);

/// Greater than the errors of rounding where nodes are looked for around a blade, over the sizes at hand (1e-6).
constexpr float kSweepMargin = 1e-4f;

/// A blade's sweep as the nodes of a body may be met by it: all vectors are from its first tip [m].
struct Sweep {
  float center_m[3], radius_m;  ///< sphere around all that may be cut
  float axes[3][3];             ///< unit vectors of a box around the sweep itself
  float low_m[3], high_m[3];    ///< along the axes
};

/// Where the 64 places of a brick are, from the blade's first tip; without bounds if some are not finite.
struct BrickPlaces {
  float low_m[3], high_m[3];
  float speed2;  ///< largest |v|^2 [m2/s2]
  bool near;     ///< some are in the sphere
};

struct SweepJob {
  const layout::Brick* bricks;
  const layout::BodyParams* bodies;
  const float *displacement, *velocity;
  const float* reach_m;  ///< [slots] how far from a node its tissue may be
  float from_m[3];       ///< the blade's first tip, tissue frame
  const Sweep* sweeps;   ///< [bodies]
  BrickPlaces* places;   ///< [bricks]
  uint8_t* outside;      ///< [slots] on which sides of the box a node is, with its tissue: bits 2 k low, 2 k + 1 high
};
/// Writes `places` of bricks first..last - 1.
using BrickSweep = void (*)(const SweepJob& job, size_t first, size_t last);
/// Writes `outside` of some bricks' slots.
using BrickSides = void (*)(const SweepJob& job, const uint32_t* bricks, size_t count);

struct NetworkJob;  // network_kernels.h
/// Something done to groups first..last - 1 of the rows: their vectors spread for others to look up; or one substep of
/// leapfrog, point-centric, as in shaders/solver/step/leapfrog.comp without contacts.
using NetworkGroups = void (*)(const NetworkJob& job, size_t first, size_t last);

/// The kernels of one instruction set: a solver picks its own, whatever others in the process have.
struct Kernels {
  std::string target;  ///< such as AVX2
  BrickLeapfrog leapfrog;
  BrickPredict predict;
  BrickMeasure measure;
  BrickCells cells;
  WallForces walls;
  WallForces measure_walls;
  NetworkGroups spread_network;  ///< of all groups, before their leapfrog
  NetworkGroups leapfrog_network;
  BrickSweep sweep;
  BrickSides sides;
};

/// Instruction sets in the binary that this processor has, best first.
std::vector<std::string> targets();
/// @param target  one of targets(); empty: the best
/// @return nothing if it is not one of them
std::optional<Kernels> kernelsFor(const std::string& target);

}  // namespace viscera::simd
