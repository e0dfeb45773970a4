// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera {

// What the keys of a body choose among.

enum class TissueSource { kPhantom, kMesh, kBox, kSheet, kBall, kLabels };
enum class Structure { kLattice, kExplicit, kSurface };
enum class SkinSource { kAuto, kInput, kVolume };
enum class Mapping { kAuto, kOneToOne, kConstant, kInterpolated, kAlongNormal };  ///< see docs/mappings.md
enum class UpAxis { kZ, kY };
enum class FixedShape { kBox, kSphere, kPlane, kPart };
/// What of a mesh is tissue.
enum class Fill {
  kParts,    ///< the inside of each of its parts
  kEnclosed  ///< what all of them enclose together, gaps closed
};

/// What the cells of a lattice are made of (docs/physics.md 1).
enum class Law {
  kAuto,       ///< what lawOf() (structure_rules.h) says
  kSprings,    ///< springs, as in VR05: Poisson's ratio is 1/4, cells are full or empty
  kNeoHookean  ///< a hyperelastic energy per cell, of its deformation gradient; cells are tissue in part
};

/// Where cells in thin walls have their second derivatives along the lattice's axes from (physics.md 1, Thin walls).
enum class Walls {
  kCells,  ///< from what their own corners show
  kRows    ///< from rows of nodes
};

/// How spring and mass weights are assembled (physics.md 1).
enum class Weights {
  kCell,  ///< each solid cell adds k/4 to its edges, k/2 to its face diagonals, m/8 to its nodes
  kPaper  ///< every spring and every node counts in full (VR05)
};

}  // namespace viscera
