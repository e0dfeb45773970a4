// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/model/scene/body_config.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace VISCERA_PUBLIC viscera {

/// What an import left out, summed over parts.
struct ImportReport {
  int parts = 0;
  int stray_points = 0;                       ///< point primitives dropped
  int stray_lines = 0;                        ///< line primitives dropped
  int degenerate_triangles = 0;               ///< triangles without area or with a repeated vertex dropped
  int parts_dropped = 0;                      ///< parts that hold no triangle
  std::vector<std::string> appearance_notes;  ///< other content that was left out or could not be used, one line each
  std::string text() const;                   ///< returns what was left out in one line for a person
};

/// Reads a triangle mesh (OBJ, STL, PLY, glTF, GLB, the borders of Gmsh volumes; where the limits allow it, other
/// formats of assimp). Vertices with equal positions within a part are welded, and node transforms are applied. Every
/// mesh of the file becomes a part with the name of its node or mesh; every physical group of volumes becomes a part
/// with its name or number. Colours, textures and normal maps are read into TriangleMesh::detail; missing ones are
/// noted and are no error.
/// @param unit_scale_m  metres per file unit, > 0   @param with_appearance  false: shape alone
/// @throws MeshError  missing or corrupt file, no triangle at all, a non-finite coordinate, more than the limits accept
/// or than memory holds
TriangleMesh importMesh(const std::string& path, double unit_scale_m, ImportReport* report = nullptr,
                        const ImportLimits& limits = {}, bool with_appearance = true);

}  // namespace viscera
