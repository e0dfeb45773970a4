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
const uint kMaxObstacles = 16u;
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
const uint kBindSkinAlive = 21u;      // uint[triangles]: 0 torn, kShownWhole, or the parts that are left of a split one
const uint kBindSkinLive = 22u;       // uint[3 * (triangles + 2 split)]: indices drawn; a torn triangle is (0, 0, 0)
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
const uint kBindLinks = 35u;         // Link[links]: explicit connections, node by node
const uint kBindSprings = 36u;       // SpringEnds[springs]: each explicit connection once
const uint kBindSpringCut = 37u;     // float[springs]: 0 whole, else where the blade crossed it, 0..1 of the way from a to b
const uint kBindLinkForces = 38u;    // vec4[springs + owners]: edge-centric forces [N], see SpringOwner
const uint kBindRest = 39u;          // vec4[slots]: xyz rest position [m, tissue frame]
// Surroundings (surroundings.comp, collision.comp)
const uint kBindObstacles = 40u;        // uniform block ObstacleMotion[kMaxObstacles]: one substep of the tick's
const uint kBindBodyInfluences = 41u;   // uniform block vec4[kMaxBodies]: see surroundings.glsl
const uint kBindWindStarts = 42u;       // uint[slots + 1]: first ring triangle of a node
const uint kBindWindTriangles = 43u;    // WindTriangle[]
const uint kBindCollidable = 44u;       // uint[slots / 32 + 1]: bit slot % 32 of a node that may touch others from the start on
const uint kBindBuckets = 45u;          // uint[3 * buckets + 1]: entries, first entry, cursor of a bucket; then: entries in all
const uint kBindUnsorted = 46u;         // uint[active]: slots, bucket by bucket
const uint kBindEntries = 47u;          // uvec4[active]: float bits of xyz position [m], slot; bucket by bucket, ascending slots
const uint kBindEntriesBefore = 48u;    // vec4[active]: xyz position before the substep [m]
const uint kBindContacts = 49u;         // vec4[slots]: xyz sum of directions weighted by depth [m]; w number of contacts
const uint kBindCorrections = 50u;      // vec4[2 * slots]: change of velocity [m/s], then of position beside it [m]
const uint kBindPairs = 51u;            // uint[1 + 2 * most]: number of pairs, then their slots; for tests
const uint kBindSortItems = 52u;        // uvec2[partitions * sorted]: key, slot; staggered search
const uint kBindRanks = 53u;            // uint[partitions * slots]: place of a node in a partition's order
const uint kBindRingVertices = 54u;    // RingVertex[]: vertices of the skins of networks
const uint kBindRings = 55u;           // RingTriangle[]
const uint kBindSplitEdges = 56u;      // SplitEdge[]
const uint kBindSplitTriangles = 57u;  // SplitTriangle[]
const uint kBindCrossedEdges = 58u;    // uint[4 + split edges]: groups to dispatch (3), how many, which SplitEdges

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
const uint kUnitLinks = 9u;            // rgba32ui, two per Link of kBindLinks
const uint kUnitLinkStarts = 10u;      // r32ui [slots + 1]: first link of a node; edge-centric: rgba32ui, see EdgeForces
const uint kUnitSprings = 11u;         // rgba32ui, as kBindSprings: of the stand-alone kernels of bench gw
const uint kUnitLinkForces = 12u;      // rgba32f, as kBindLinkForces
const uint kUnitRest = 13u;            // rgba32f, as kBindRest
const uint kUnitSpringOwners = 11u;    // rgba32ui: SpringOwner[owners]; where kUnitSprings is not needed
const uint kUnitForceStarts = 14u;     // r32ui [slots + 1]: first place of the forces on a node

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
  uint connections;         // kImplicit, kExplicitLattice or kNetwork
  float pad;
};
// Connections of a body: springs of a lattice by offset and counts in NodeBits; the same lattice with its springs as links;
// or any graph of links, where the low 18 bits of NodeBits.lo say how many of a node's links are whole.
const uint kImplicit = 0u;
const uint kExplicitLattice = 1u;
const uint kNetwork = 2u;
const uint kValenceMask = kAxialMask;

// An explicit connection as one of its ends sees it.
struct Link {
  vec4 offset_length;  // xyz rest offset to the far end [m]; w rest length l0 [m]
  float stiffness;     // k [N/m]; 0 once it is cut
  float prestrain_m2;  // |offset|^2 - l0^2 [m2]: 0 for a spring that is at rest where its ends are
  uint far;            // slot of the far end
  uint lattice_spring; // low 5 bits: of an explicit lattice: its index 0..17 from this end; else kNoLatticeSpring
};
const uint kNoLatticeSpring = 31u;
const uint kLatticeSpringMask = 31u;
const uint kForcePlaceShift = 5u;  // Link.lattice_spring of a spring's owner: above these bits the place of its force on the far end

// An explicit connection once: slots of its ends, a < b, and its links there.
struct SpringEnds {
  uint a, b, link_a, link_b;
};

// Edge-centric forces (solver/edge_forces.h): a node that computes some of its springs, for their far ends too.
struct SpringOwner {
  uint slot;
  uint first, end;  // links of the springs that it owns
  uint place;       // of the sum of their forces on it; forces on it of springs that others own come behind
};

// One stylus over one substep, tissue frame.
struct ToolMotion {
  vec4 from;         // xyz tip at the start [m]; w contact radius [m]
  vec4 to;           // xyz tip at the end [m]; w largest node speed after release [m/s]
  vec4 orientation;  // quaternion xyzw at the end
  vec4 blade_from;   // xyz far end of the blade at the start [m]; w half thickness of the particle eraser [m]
  vec4 blade_to;     // xyz far end of the blade at the end [m]
  uvec4 info;        // x mode
  vec4 timing;       // x length of the substep before [s]; 0 where there was none
  uvec4 pad;         // two styluses make 256 bytes, the coarsest alignment of a uniform block
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
// Of SkinBinding.springs: a vertex of a network's skin, which is its node slot0; normal_constant is its normal at rest.
const uint kOneToOneBit = 1u << 30;
// A vertex of a network's skin, and where its ring begins and ends: the triangles around it.
struct RingVertex {
  uint vertex, slot, ring_begin, ring_end;
  vec4 rest_normal;
};
// A triangle as one of its corners sees it: the nodes of the other two, counter-clockwise.
struct RingTriangle {
  uint slot1, slot2, triangle, pad;
};
// An edge of a network's skin that is a spring. Where a blade crosses the spring two vertices appear: `vertex` hangs on
// the end `a`, the next one on `b`.
struct SplitEdge {
  uint a, b;  // indices into RingVertex[]
  uint spring;
  uint vertex;
};
// A triangle with such edges.
struct SplitTriangle {
  uint triangle;
  uint springs[3];   // of the edges 01, 12, 20, or kNoSpring
  uint vertices[6];  // of these edges: the one beside the edge's first corner, the one beside its second
  uint slots[3];     // nodes of its corners
  uint pad[3];
};
const uint kNoSpring = 0xffffffffu;
const float kErasedShare = 2.0f;  // spring_cut of a spring that was not crossed but erased: nothing of it is shown
// What is shown of a triangle.
const uint kShownWhole = 1u;
const uint kShownCorner = 2u;  // << corner 0, 1, 2: the piece at a corner that a cut has parted from the others
const uint kShownRest = 16u;   // << corner: the two triangles that are left without that corner

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

// A rigid obstacle over one substep, tissue frame.
struct ObstacleMotion {
  vec4 from;              // xyz origin at the start [m]; w radius [m]
  vec4 to;                // xyz origin at the end [m]; w half length of a capsule [m]
  vec4 from_orientation;  // quaternion xyzw
  vec4 to_orientation;
  vec4 velocity;          // xyz of its origin [m/s]; w friction
  vec4 spin;              // xyz angular velocity [rad/s]; w restitution
  vec4 half_size;         // xyz box: half edges [m]
  uvec4 info;             // x shape
};
const uint kShapePlane = 0u;
const uint kShapeSphere = 1u;
const uint kShapeCapsule = 2u;
const uint kShapeBox = 3u;

// A triangle (a, b, c) of a network's surface as node a sees it: the other corners, and the springs of its edges ab, bc, ca.
struct WindTriangle {
  uint b, c;
  uint springs[3];  // kNoSpring where no spring runs along the edge
  uint pad;
};

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
