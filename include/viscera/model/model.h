// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/model/body/lattice.h"
#include "viscera/model/body/skin.h"
#include "viscera/model/body/spring_network.h"
#include "viscera/model/scene/material_config.h"
#include "viscera/model/shape/solid.h"

namespace VISCERA_PUBLIC viscera {

struct Scene;

/// One piece of tissue, ready to simulate.
struct Body {
  std::string name;
  MaterialConfig material;
  std::vector<PartConfig> parts;  ///< parts with elasticities of their own
  Lattice lattice;                ///< lattice; of a body of structure surface only slots, in bricks without positions
  std::optional<SpringNetwork> network;  ///< explicit connections, which act instead of the lattice's
  /// [slots] initial stress of cells in the given shape over their mu (second Piola-Kirchhoff, as xx, yy, zz, yz, zx,
  /// xy); empty without a prestress.
  std::vector<std::array<float, 6>> prestress;
  Skin skin;
  Vector3d color = Vector3d::Ones();
  double roughness = 0.25, color_variation = 1;                      ///< appearance, see BodyConfig
  double specular_wetness = 0, cut_wall_texture = 0, blanching = 0;  ///< appearance, see BodyConfig
  std::vector<LayerConfig> layers;
  Vector3d force_n = Vector3d::Zero();  ///< force on the whole body [N]
  std::vector<std::string> notes;       ///< decisions of the preparation, for a person: one line each

  bool hasCells() const { return !network || network->of_lattice; }  ///< its nodes are corners of lattice cells
};

/// All bodies that are simulated. The slots of body b start at slotOffset(b) in the solver's buffers.
struct Model {
  std::vector<Body> bodies;

  uint32_t slotOffset(size_t body) const;
  size_t slots() const;
  size_t activeNodes() const;
  size_t springs() const;
  size_t skinVertices() const;
  size_t skinTriangles() const;
  bool hasNetwork() const;  ///< some body has explicit connections
  bool hasLattice() const;  ///< some body has implicit connections
};

/// Returns the rest position of a node of the body [m, tissue frame].
Vector3d restPosition(const Body& body, uint32_t slot);

/// Number of nodes of a body with `spacing_m: auto` where no machine is measured; only a session measures.
constexpr int kUnmeasuredNodes = 20000;

/// Builds every body of a scene: mesh or phantom -> solid -> lattice + surface mesh, with fixed nodes marked.
/// @throws MeshError     a mesh file that cannot be used, or that encloses no volume
/// @throws LatticeError  spacing_m or target_nodes out of reach; names the body
/// @throws SceneError    a fixed entry that matches no node or names no part; skin: input without a mesh
Model buildModel(const Scene& scene, const Progress& progress = {});

}  // namespace viscera
