// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// The one layout of GPU memory, valid as GLSL 4.50 (std430) and as C++17: constants, bindings, structs.
// In C++ everything is in namespace viscera::layout.
#ifndef VISCERA_LAYOUT_H
#define VISCERA_LAYOUT_H

#ifdef __cplusplus
#include <cstdint>
namespace viscera::layout {
using uint = std::uint32_t;
struct alignas(16) vec4 {
  float x, y, z, w;
};
struct alignas(16) uvec4 {
  uint x, y, z, w;
};
struct alignas(16) ivec4 {
  int x, y, z, w;
};
#else
// What the two languages spell differently where the CPU backend compiles GLSL as C++ (src/solver/cpu/glsl.h).
#define INOUT(T) inout T
#define OUT(T) out T
#define xyz(v) (v).xyz
#define xyzw(v) (v)
#endif

// Lattice nodes are stored in bricks of 4x4x4 slots: slot = 64 * brick + x + 4 y + 16 z (coordinates within the brick).
const uint kBrickEdge = 4u;
const uint kBrickSlots = 64u;
const uint kSpringsPerNode = 18u;
const uint kAxialSprings = 6u;
const uint kMaxStyluses = 2u;
const uint kMaxBodies = 16u;
const uint kGroupSize = 64u;

// NodeBits.lo: six axial counts of 3 bits (quarters of the axial stiffness, 0..4), then:
const uint kMassShift = 18u;     // 4 bits: solid cells around the node, 1..8 eighths of a cell's mass
const uint kFixedBit = 1u << 22; // fixed in space
const uint kGrabShift = 23u;     // 2 bits: 0 free, 1 + stylus index while held
const uint kGrabMask = 3u << 23;
const uint kSeveredBit = 1u << 25; // at least one spring of this node was cut
const uint kCellBit = 1u << 26;  // the cell whose lowest corner is this node is filled and whole
const uint kAxialMask = (1u << 18) - 1u;
// NodeBits.hi: twelve diagonal counts of 2 bits (halves of the diagonal stiffness, 0..2), then the body index:
const uint kBodyShift = 24u;
const uint kDiagonalMask = (1u << 24) - 1u;

// Tool modes, as in ToolMotion.info.x
const uint kModeNone = 0u;
const uint kModeProbe = 1u;
const uint kModeGrab = 2u;
const uint kModeCut = 3u;
const uint kModeCutParticles = 4u;

// Storage buffer bindings, the same in every kernel
const uint kBindActive = 0u;        // uint[active]: slots of active nodes, brick by brick
const uint kBindBricks = 1u;        // Brick[bricks]
const uint kBindBodies = 2u;        // BodyParams[bodies]
const uint kBindNodes = 3u;         // NodeBits[slots]
const uint kBindDisplacementIn = 4u;  // vec4[slots]: xyz m
const uint kBindVelocityIn = 5u;      // vec4[slots]: xyz m/s
const uint kBindDisplacementOut = 6u;
const uint kBindVelocityOut = 7u;
const uint kBindToolMotions = 8u;   // uniform block ToolMotion[kMaxStyluses]: one substep of the tick's
const uint kBindGrabOffsets = 9u;   // vec4[slots]: position of a held node in the stylus frame [m]
const uint kBindImpulses = 10u;     // vec4[kMaxStyluses * slots]: momentum given to the node this tick [N s]
const uint kBindStats = 11u;        // TickStats[1]
const uint kBindPartials = 12u;     // scratch of the reductions
const uint kBindSurfaceNodes = 13u;   // uint[]: slots to which skin vertices are bound
const uint kBindNodeNormals = 14u;    // vec4[slots]: xyz approximate normal, w trust in it 0..1
const uint kBindSkinBindings = 15u;   // SkinBinding[vertices]
const uint kBindSkinPositions = 16u;  // float[3 * vertices] [m]
const uint kBindSkinNormals = 17u;    // uint[vertices]: packed normals
const uint kBindSkinTriangles = 18u;  // uint[3 * triangles]: vertex indices
const uint kBindSkinTies = 19u;       // Tie[]
const uint kBindSkinTieStarts = 20u;  // uint[triangles + 1]
const uint kBindSkinAlive = 21u;      // uint[triangles]: 1 whole, 0 torn
const uint kBindSkinLive = 22u;       // uint[3 * triangles]: indices drawn; a torn triangle is (0, 0, 0)
const uint kBindSkinColors = 23u;     // uint[vertices]: RGBA8
const uint kBindCells = 24u;          // uint[cells]: slots of the lowest corners
const uint kBindCellForces = 25u;     // vec4[3 * slots]: what a cell's volume does to its corners, see volume.comp
const uint kBindCompensation = 26u;   // vec4[2 * slots]: what the sums of displacement [m] and velocity [m/s] have lost
const uint kBindIncrement = 27u;      // vec4[slots]: implicit integrators: displacement gained in this substep [m]
const uint kBindIncrementOut = 28u;   // the same, next iterate; holds the last but one until then
const uint kBindStaleBricks = 29u;    // uint[bricks]: StateView::stale_bricks
const uint kBindGuard = 30u;          // uint[1 + 2 iterations]: see implicit.glsl
const uint kBindPositions = 31u;      // vec4[slots]: verlet_paper: x [m]
const uint kBindPositionsBefore = 32u;  // vec4[slots]: verlet_paper: x one substep ago [m]; written with the next x
const uint kBindSavedDisplacement = 33u;  // vec4[slots]: a good state of the governor's ring
const uint kBindSavedVelocity = 34u;      // vec4[slots]

// Texture units: buffers seen through texel fetches
const uint kUnitDisplacement = 0u;  // rgba32f, as kBindDisplacementIn
const uint kUnitVelocity = 1u;      // rgba32f, as kBindVelocityIn
const uint kUnitBricks = 2u;        // r32ui, as kBindBricks
const uint kUnitSpringStiffness = 3u;  // r32f [9 * slots]: N/m of a node's even springs; bodies with parts
const uint kUnitNodeMass = 4u;         // r32f [slots]: kg
const uint kUnitCellBulk = 5u;         // r32f [slots]: J
const uint kUnitCellForces = 6u;       // rgba32f, as kBindCellForces
const uint kUnitIncrement = 7u;        // rgba32f, as kBindIncrement
const uint kUnitPositions = 8u;        // rgba32f, as kBindPositions

struct NodeBits {
  uint lo;
  uint hi;
};

struct Brick {
  int coord_x, coord_y, coord_z;  // of the brick, in bricks from its body's node (0, 0, 0)
  uint body;
  uint neighbors[27];  // brick index at (dx+1) + 3 (dy+1) + 9 (dz+1); this brick itself where there is none
  uint pad;
};
const uint kBrickWords = 32u;
const uint kBrickNeighborWord = 4u;  // word of Brick.neighbors[0]

struct BodyParams {
  vec4 origin_spacing;      // xyz: rest position of node (0, 0, 0) [m, tissue frame]; w: spacing h [m]
  float axial_quarter_n_per_m;  // a quarter of the axial stiffness: what one solid cell gives an edge
  float diagonal_half_n_per_m;  // half of the diagonal stiffness: what one solid cell gives a face diagonal
  float mass_eighth_kg;
  float drag_per_s;         // gamma
  float dashpot_s;          // axial dashpot coefficient over spring stiffness, c/k [s]
  float bulk_j;             // lambda_V h^3: a cell of volume V has the energy volumeEnergy(bulk_j, V/V0 - 1)
  float pad0, pad1;
};

// One stylus over one substep, tissue frame.
struct ToolMotion {
  vec4 from;         // xyz tip at the start [m]; w contact radius [m]
  vec4 to;           // xyz tip at the end [m]; w largest node speed after release [m/s]
  vec4 orientation;  // quaternion xyzw at the end
  vec4 blade_from;   // xyz far end of the blade at the start [m]; w half thickness of the particle eraser [m]
  vec4 blade_to;     // xyz far end of the blade at the end [m]
  uvec4 info;        // x mode
  uvec4 pad0, pad1;  // two styluses make 256 bytes, the coarsest alignment of a uniform block
};

const float kCollapsed = 0.3f;  // of a spring's rest length

// What one tick leaves behind, read back as one small block.
struct TickStats {
  vec4 impulse[2];        // xyz momentum given to the nodes by each stylus over the tick [N s]
  vec4 angular[2];        // xyz its moment about the stylus tip at the end of the tick [N m s]
  uint springs_cut;       // since the last reset
  uint nonfinite;         // nodes with a non-finite displacement or velocity
  uint max_stretch_bits;  // float bits of max |L - l0| / l0 over springs
  uint max_speed_bits;    // float bits of max |v| [m/s]
  uint grabbed[2];        // nodes held by each stylus
  uint touched[2];        // nodes that got an impulse from each stylus in the tick
  uint collapsed;         // springs shorter than kCollapsed of their rest length
  uint max_rate_bits;     // float bits of max over free nodes of (2 sum k + volume) / m [1/s2]: dt_safe = 2 / sqrt of it
  float kinetic_j;
  float elastic_j;        // springs and volumes
  uint inverted;          // whole cells turned inside out
  uint pad[3];
};

// A skin vertex bound to the lattice (EGVE eqs 4 to 9).
struct SkinBinding {
  uint slot0, slot1, slot2;
  uint springs;            // spring index of edges 01, 12, 20 (5 bits each); bit 31: interpolated basis is defined
  vec4 weights;            // xyz barycentric weights; w unused
  vec4 offset_constant;    // xyz offset in (T, N, B) of the triangle [m]
  vec4 offset_interpolated;  // xyz offset in (T_c, N_c, B_c) [m]
  vec4 normal_constant;      // xyz shading normal in (T, N, B)
  vec4 normal_interpolated;  // xyz shading normal in (T_c, N_c, B_c)
};
const uint kInterpolatedBit = 1u << 31;
// An approximate normal is a sum of unit vectors (VR05 eq 5): 0 inside the body, 1 on a concave edge, 3.8 on a flat
// face. Trust in it grows from 0 to 1 between these two lengths of the sum.
const float kNormalSumNone = 0.25f;
const float kNormalSumFull = 0.75f;

// A spring that a skin triangle depends on. Ties come in groups: a group holds while one of its springs is alive,
// a triangle is whole while all of its groups hold.
struct Tie {
  uint slot;
  uint spring;  // index 0..17; kTieEndBit closes the group
};
const uint kTieEndBit = 1u << 8;

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
