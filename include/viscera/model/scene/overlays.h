// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

/// Overlay of a camera, over the tissue or in place of its colours (EGVE figures 1, 2 and 6, GW figure 4).
enum class Overlay : uint32_t {
  kLattice = 1,  ///< axial springs between nodes that the surface mesh is bound to; all springs of a network
  kSprings = 2,  ///< the same with diagonal springs
  kNormals = 4,  ///< approximate normals of these nodes (VR05 eq 5); normals of a network's surface
  kStrain = 8,   ///< root mean square of (L - l0) / l0 over a node's intact springs, as a colour with a legend
  kForces = 16,  ///< forces on styluses and on bodies with force_n
  kWind = 32,    ///< velocity of the air
};

struct OverlayName {
  const char* name;
  Overlay value;
};
constexpr std::array<OverlayName, 6> kOverlayNames = {{{"lattice", Overlay::kLattice},
                                                       {"springs", Overlay::kSprings},
                                                       {"normals", Overlay::kNormals},
                                                       {"strain", Overlay::kStrain},
                                                       {"forces", Overlay::kForces},
                                                       {"wind", Overlay::kWind}}};

/// Set of overlays.
class VISCERA_PUBLIC Overlays {
 public:
  bool has(Overlay overlay) const { return (bits_ & static_cast<uint32_t>(overlay)) != 0; }
  void add(Overlay overlay) { bits_ |= static_cast<uint32_t>(overlay); }
  bool any() const { return bits_ != 0; }
  bool operator==(const Overlays& other) const { return bits_ == other.bits_; }

 private:
  uint32_t bits_ = 0;
};

/// Returns all names for messages: "lattice, springs, ...".
std::string overlayNames();
/// Returns the overlays of these names.
/// @throws SceneError  a name that no overlay has; lists the names
Overlays overlaysOf(const std::vector<std::string>& names);

}  // namespace viscera
