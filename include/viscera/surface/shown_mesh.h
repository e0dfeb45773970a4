// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// What a shown triangle is a part of.
enum class ShownKind : uint8_t {
  kSkin,   ///< the surface that the tissue came with
  kWound,  ///< walls that a cut has laid open
};

struct ShownBody {
  std::string name;
  Vector3d color = Vector3d::Ones();  ///< RGB, 0..1
};

/// Colour of the walls of a wound, deep under the skin: darker and redder. @param skin  RGB, 0..1
Vector3d woundColor(const Vector3d& skin);

/// Triangles that lie one behind the other, belong to one body and are of one kind.
struct ShownPatch {
  uint32_t body = 0;  ///< index into ShownTopology::bodies
  ShownKind kind = ShownKind::kSkin;
  size_t first = 0, count = 0;  ///< triangles
};

/// Which vertices make the triangles that are shown: torn ones are not there, split ones are in their pieces. Made
/// again only when a cut or a reset changes it, and then never changed: what shows the skin shares it.
struct ShownTopology {
  uint64_t revision = 0;            ///< another one where other triangles are shown; 1: the whole skin
  size_t vertices = 0;              ///< of the meshes that it belongs to, shown or not; wounds add some
  std::vector<uint32_t> triangles;  ///< [3 * n] vertex indices, counter-clockwise from outside
  std::vector<ShownBody> bodies;    ///< in the model's order
  std::vector<ShownPatch> patches;  ///< in the order of their triangles, at least one per body; covers them all

  size_t triangleCount() const { return triangles.size() / 3; }
  /// The patch that a triangle belongs to. @param triangle  < triangleCount()
  const ShownPatch& patchOf(size_t triangle) const;
};

/// The deformed skin of all bodies as it is shown, a value: copy it, keep it, write it to a file. Knows no OpenGL.
struct ShownMesh {
  std::vector<float> positions_m;  ///< [3 * vertices] tissue frame
  std::vector<uint32_t> normals;   ///< [vertices] packed, see packNormal
  /// [vertices] sRGB, red in the low byte, alpha 255; empty where bodies' colours are all there is: nothing was burnt
  /// and nothing has bled
  std::vector<uint32_t> colors = {};
  std::shared_ptr<const ShownTopology> topology;

  size_t vertices() const { return normals.size(); }
  Vector3f position_m(size_t vertex) const {
    return {positions_m[3 * vertex], positions_m[3 * vertex + 1], positions_m[3 * vertex + 2]};
  }
  Vector3f normal(size_t vertex) const;  ///< of length 1, to 1/511
};

/// Unit normal <-> three signed 10-bit fractions in a uint (x in the low bits), as GL_INT_2_10_10_10_REV.
uint32_t packNormal(const Vector3f& normal);
Vector3f unpackNormal(uint32_t packed);

/// Writes a binary PLY file: of every vertex x, y, z [m, tissue frame] and nx, ny, nz, and red, green, blue where the
/// mesh has colors, of every triangle its vertices, and as `body` and `kind` the number of its body and of its
/// ShownKind. Names of bodies are comments. Vertices keep their numbers, those that nothing is shown of too.
/// @param mesh  with a topology   @throws Error  the file cannot be written
void writePly(const ShownMesh& mesh, const std::string& path);

}  // namespace viscera
