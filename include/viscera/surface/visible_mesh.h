// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/math/types.h"

namespace VISCERA_PUBLIC viscera {

/// Kind of surface that a shown triangle belongs to.
enum class SurfaceKind : uint8_t {
  kSkin,   ///< original surface of the tissue
  kWound,  ///< walls of cuts
};

struct VisibleBody {
  std::string name;
  Vector3d color = Vector3d::Ones();  ///< RGB, 0..1
};

/// Returns the colour of the walls of a wound, darker and redder than the surface. @param skin  RGB, 0..1
Vector3d woundColor(const Vector3d& skin);

/// Consecutive triangles of one body and of one kind.
struct VisiblePatch {
  uint32_t body = 0;  ///< index into VisibleTopology::bodies
  SurfaceKind kind = SurfaceKind::kSkin;
  size_t first = 0, count = 0;  ///< triangles
};

/// Vertices of the shown triangles: torn triangles are left out, split ones are replaced by their pieces. A cut or a
/// reset makes a new one; it never changes after that, so users of the mesh share it.
struct VisibleTopology {
  uint64_t revision = 0;            ///< differs where other triangles are shown; 1: the uncut mesh
  size_t vertices = 0;              ///< of the meshes that use it, shown or not; wounds add some
  std::vector<uint32_t> triangles;  ///< [3 * n] vertex indices, counter-clockwise from outside
  std::vector<VisibleBody> bodies;  ///< in the model's order
  std::vector<VisiblePatch>
      patches;  ///< in the order of their triangles, at least one per body; together all triangles

  size_t triangleCount() const { return triangles.size() / 3; }
  /// Returns the patch of a triangle. @param triangle  < triangleCount()
  const VisiblePatch& patchOf(size_t triangle) const;
};

/// The deformed surface mesh of all bodies as it is shown, as a value without OpenGL: copy it, keep it, write it to a
/// file.
struct VisibleMesh {
  std::vector<float> positions_m;  ///< [3 * vertices] tissue frame
  std::vector<uint32_t> normals;   ///< [vertices] packed, see packNormal
  /// [vertices] sRGB, red in the low byte, alpha 255; empty where vertices have the colours of their bodies: no
  /// part has its own, nothing was burnt and nothing has bled
  std::vector<uint32_t> colors = {};
  std::shared_ptr<const VisibleTopology> topology;

  size_t vertices() const { return normals.size(); }
  Vector3f position_m(size_t vertex) const {
    return {positions_m[3 * vertex], positions_m[3 * vertex + 1], positions_m[3 * vertex + 2]};
  }
  Vector3f normal(size_t vertex) const;  ///< of length 1, to 1/511
};

/// Packs a unit normal into three signed 10-bit fractions in a uint (x in the low bits), as GL_INT_2_10_10_10_REV, and
/// unpacks it.
uint32_t packNormal(const Vector3f& normal);
Vector3f unpackNormal(uint32_t packed);

/// Writes a binary PLY file. A vertex has x, y, z [m, tissue frame] and nx, ny, nz, and red, green, blue where the mesh
/// has colors. A triangle has its vertices, and as `body` and `kind` the numbers of its body and of its SurfaceKind.
/// Names of bodies are comments. Vertices keep their numbers, including those of no shown triangle.
/// @param mesh  with a topology   @throws Error  the file cannot be written
void writePly(const VisibleMesh& mesh, const std::string& path);

}  // namespace viscera
