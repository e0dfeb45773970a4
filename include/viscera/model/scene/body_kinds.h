// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

// Values of the keys of a body.

enum class TissueSource { kPhantom, kMesh, kBox, kSheet, kBall, kTube, kLabels };
enum class Anatomy { kHeart, kGallbladder };
enum class Structure { kLattice, kExplicit, kSurface };
enum class SkinSource { kAuto, kInput, kVolume };
enum class Mapping { kAuto, kOneToOne, kConstant, kInterpolated, kAlongNormal };  ///< see docs/surface.md
enum class UpAxis { kZ, kY };
enum class FixedShape { kBox, kSphere, kPlane, kPart };
/// Fluid that leaves tissue where it is cut.
enum class Fluid { kBlood, kBile };
/// Region of a mesh that is tissue.
enum class Fill {
  kParts,    ///< inside of each of its parts
  kEnclosed  ///< region that all parts enclose together, with gaps closed
};

/// Law of a lattice's cells (docs/physics.md 1).
enum class Law {
  kAuto,       ///< the law that lawOf() (structure_rules.h) chooses
  kSprings,    ///< springs, as in VR05: Poisson's ratio is 1/4, cells are full or empty
  kNeoHookean  ///< hyperelastic energy of each cell's deformation gradient; cells may be partly filled
};

/// Source of the second derivatives of cells in thin walls along the lattice's axes (physics.md 1, Thin walls).
enum class Walls {
  kCells,  ///< the cells' own corners
  kRows    ///< rows of nodes
};

/// Rule by which weights of springs and masses are assembled (physics.md 1).
enum class Weights {
  kCell,  ///< each solid cell adds k/4 to its edges, k/2 to its face diagonals, m/8 to its nodes
  kPaper  ///< every spring and every node counts in full (VR05)
};

}  // namespace viscera
