// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Binding numbers of buffers and texture units. Owners bind with these numbers and shaders declare with them; each is used once.
#ifndef VISCERA_LAYOUT_BINDINGS_H
#define VISCERA_LAYOUT_BINDINGS_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// Storage buffer bindings, the same in every kernel
const uint kBindActive = 0u;        // uint[active]: slots of active nodes, brick by brick
const uint kBindBricks = 1u;        // Brick[bricks]
const uint kBindBodies = 2u;        // BodyParams[bodies]
const uint kBindNodes = 3u;         // NodeBits[slots]
const uint kBindDisplacementIn = 4u;  // vec4[slots]: xyz m
const uint kBindVelocityIn = 5u;      // vec4[slots]: xyz m/s
const uint kBindDisplacementOut = 6u;
const uint kBindVelocityOut = 7u;
const uint kBindToolMotions = 8u;   // uniform block ToolMotion[kMaxStyluses]: motions of one substep
const uint kBindGrabOffsets = 9u;   // vec4[slots]: position of a held node in the stylus frame [m]
const uint kBindImpulses = 10u;     // vec4[kMaxStyluses * slots]: momentum given to the node this tick [N s]
const uint kBindStats = 11u;        // TickStats[1]
const uint kBindPartials = 12u;     // scratch memory of the reductions
const uint kBindSurfaceNodes = 13u;   // SurfaceNode[]: nodes with approximate normals that vertices of the surface mesh follow
const uint kBindNodeNormals = 14u;    // vec4[slots]: xyz approximate normal, w confidence in it, 0..1
const uint kBindSkinBindings = 15u;   // SkinBinding[vertices]
const uint kBindSkinPositions = 16u;  // float[3 * vertices] [m]
const uint kBindSkinNormals = 17u;    // uint[vertices]: packed normals
const uint kBindSkinTriangles = 18u;  // uint[3 * triangles]: vertex indices
const uint kBindSpringStiffness = 19u;  // float[9 * slots] N/m, as kUnitSpringStiffness
const uint kBindCellStrengths = 20u;    // vec4[slots]: as kUnitCellBulk
const uint kBindSkinAlive = 21u;      // uint[triangles]: 0: replaced; kShownWhole; or a mask of the parts that are left of a split triangle
const uint kBindSkinLive = 22u;       // uint[3 * (triangles + 2 split)]: indices drawn; (0, 0, 0) draws nothing
const uint kBindSkinColors = 23u;     // uint[vertices]: RGBA8
const uint kBindCells = 24u;          // uint[cells]: slots of the cells' lowest corners
const uint kBindCellForces = 25u;     // vec4[kCellVectors * slots]: forces of cells on their corners, see cellVector(); with thin walls also those of rows
const uint kBindCompensation = 26u;   // vec4[2 * slots]: rounding errors of the sums of displacement [m] and velocity [m/s] (compensated summation)
const uint kBindIncrement = 27u;      // vec4[slots]: implicit integrators: displacement in this substep so far [m]
const uint kBindIncrementOut = 28u;   // the same, next iterate; until it is written it holds the iterate before the last
const uint kBindStaleBricks = 29u;    // uint[bricks]: StateView::stale_bricks
const uint kBindGuard = 30u;          // uint[1 + 2 iterations]: see implicit.glsl
const uint kBindPositions = 31u;      // vec4[slots]: verlet_paper: x [m]
const uint kBindPositionsBefore = 32u;  // vec4[slots]: verlet_paper: x one substep ago [m]; written with the next x
const uint kBindSavedDisplacement = 33u;  // vec4[slots]: a good state in the ring of the stability monitor
const uint kBindSavedVelocity = 34u;      // vec4[slots]
const uint kBindLinks = 35u;         // Link[links]: explicit connections, node by node
const uint kBindSprings = 36u;       // SpringEnds[springs]: each explicit connection once
const uint kBindSpringCut = 37u;     // float[springs]: 0: whole; else where the blade crossed it, as a fraction 0..1 of the length from a to b
const uint kBindWallNodes = 38u;     // uint[]: slots of the corners of cells in thin walls
const uint kBindRest = 39u;          // vec4[slots]: xyz rest position [m, tissue frame]
// Environment (environment.comp, collision_*.comp)
const uint kBindObstacles = 40u;        // uniform block ObstacleMotion[kMaxObstacles]: motions of one substep
const uint kBindBodyInfluences = 41u;   // uniform block vec4[kMaxBodies]: see environment.glsl
const uint kBindWindStarts = 42u;       // uint[slots + 1]: first ring triangle of each node
const uint kBindWindTriangles = 43u;    // WindTriangle[]
const uint kBindTouchDepths = 44u;      // float[slots]: which nodes may touch others, see touch_depths.h
const uint kBindBuckets = 45u;          // uint[3 * buckets + 1]: per bucket number of entries, first entry, cursor; then the total number of entries
const uint kBindUnsorted = 46u;         // uint[active]: slots, ordered by bucket
const uint kBindEntries = 47u;          // uvec4[active]: float bits of xyz position [m], slot; ordered by bucket, then by slot
const uint kBindEntriesBefore = 48u;    // vec4[active]: xyz position before the substep [m]
const uint kBindContacts = 49u;         // vec4[slots]: xyz sum of directions weighted by depth [m]; w number of contacts
const uint kBindCorrections = 50u;      // vec4[2 * slots]: change of velocity [m/s], then additional change of position [m]
const uint kBindPairs = 51u;            // uint[1 + 2 * most]: number of pairs, then their slots; for tests
const uint kBindRows = 52u;          // vec4[kRowVectors * slots]: second differences of rows of nodes over h; w 1 where there is a row
const uint kBindWallPulls = 53u;     // vec4[kWallVectors * slots]: derivatives of the energy of cells in thin walls by these differences [J]
const uint kBindRingVertices = 54u;    // RingVertex[]: vertices of the surface meshes of networks
const uint kBindRings = 55u;           // RingTriangle[]
const uint kBindSplitEdges = 56u;      // SplitEdge[]
const uint kBindSplitTriangles = 57u;  // SplitTriangle[]
const uint kBindCrossedEdges = 58u;    // uint[4 + split edges]: groups to dispatch (3), number of crossed edges, indices of these SplitEdges

const uint kBindPairWords = 59u;         // uint[1 + 2 * slots + most]: contacts between nodes in an implicit substep, see implicit_pairs.glsl
const uint kBindPairRows = 60u;          // vec4[2 * most]: the same contacts, see implicit_pairs.glsl
const uint kBindNodeContacts = 61u;      // vec4[3 * rows * slots]: implicit integrators: contacts of the substep, see implicit_contact.glsl
const uint kBindObstacleImpulses = 62u;  // vec4[obstacles * slots]: momentum that an obstacle gave the node this tick [N s]
const uint kBindNodePairs = 63u;         // vec4[3 * slots]: nodes with contacts to other nodes, see implicit_pairs.glsl
const uint kBindSurfaceOffsets = 64u;       // uint[slots]: displacements to the surface, see surface_offsets.h
const uint kBindAxialCut = 65u;          // float[3 * slots]: where springs were cut, as in HostState::axial_cut

// Overlays (surface/overlay/node_overlay.h)
const uint kBindOverlayNodes = 66u;       // vec4[slots]: xyz position [m], w strain
const uint kBindOverlayLinkStarts = 67u;  // uint[slots + 1]: first OverlayLink of a node
const uint kBindOverlayLinks = 68u;       // OverlayLink[]
const uint kBindOverlayLines = 69u;       // OverlayLine[]
const uint kBindOverlayIndices = 70u;     // uint[2 * lines]: slots of the ends of a line; the same slot twice where the spring is cut
const uint kBindOverlaySpikes = 71u;      // OverlaySpike[]
const uint kBindOverlayEnds = 72u;        // vec4[2 * spikes]: xyz of both ends [m]
const uint kBindStrainColors = 73u;       // uint[vertices]: RGBA8, colour by strain
const uint kBindCutSides = 74u;           // vec4[slots]: see cut_sides.glsl
const uint kBindWindowSlots = 75u;        // uint[]: nodes that the host reads in every substep, see node_window.comp
const uint kBindSleepingBricks = 76u;     // SleepingBrick[bricks], see awake_bricks.h
const uint kBindAwakeNodes = 77u;         // AwakeList, then uint[active]: slots of the nodes that are stepped
const uint kBindAwakeCells = 78u;         // AwakeList, then uint[cells]: slots of the lowest corners of the cells around these nodes
const uint kBindWindow = 79u;             // vec4[]: state of the nodes of kBindWindowSlots that the host reads, or changes that it makes
const uint kBindEdgeNodes = kBindPositions;  // count, uint[kMostEdgeNodes] slots, vec4[2 * kMostEdgeNodes]; leapfrog only, see edges.comp

// Texture units of buffers that are read by texel fetches. OpenGL guarantees 16 of them.
const uint kUnitDisplacement = 0u;  // rgba32f, as kBindDisplacementIn
const uint kUnitVelocity = 1u;      // rgba32f, as kBindVelocityIn
const uint kUnitBricks = 2u;        // r32ui, as kBindBricks
const uint kUnitSpringStiffness = 3u;  // r32f [9 * slots]: stiffness of a node's even springs [N/m], in nine planes, brick by brick; bodies with parts
const uint kUnitNodeMass = 4u;         // r32f [slots]: kg
const uint kUnitCellBulk = 5u;         // rgba32f [slots]: x bulk, y rigidity [J], z index of the moments, w stress
const uint kUnitCellForces = 6u;       // rgba32f, as kBindCellForces
const uint kUnitIncrement = 7u;        // rgba32f, as kBindIncrement
const uint kUnitPositions = 8u;        // rgba32f, as kBindPositions
const uint kUnitLinks = 9u;            // rgba32ui, two texels per Link of kBindLinks
const uint kUnitLinkStarts = 10u;      // r32ui [slots + 1]: first link of each node
const uint kUnitRows = 11u;            // rgba32f, as kBindRows
const uint kUnitWallPulls = 12u;       // rgba32f, as kBindWallPulls
const uint kUnitRest = 13u;            // rgba32f, as kBindRest
const uint kUnitCellMoments = 15u;     // rgba32f [3 * (1 + fills)]: CellMoments, those of a completely filled cell first; then stresses
// Texture units for drawing. They follow those of kernels, which share the context.
const uint kUnitShownCharts = 16u;     // r32ui [triangles drawn]: see Surface::liveCharts
const uint kUnitCharts = 17u;          // rgba32f, three texels per TextureChart
const uint kUnitMaterials = 18u;       // rgba32f, three texels per SurfaceMaterial
const uint kUnitColors = 19u;          // array of images: colours
const uint kUnitReliefs = 20u;         // array of images: normals and roughness
const uint kUnitGrain = 21u;           // 3D image: random variation of the tissue

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
