// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/model/scene/body_config.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {

/// What an import left out, part by part in sum.
struct ImportReport {
  int parts = 0;
  int stray_points = 0;                 ///< point primitives dropped
  int stray_lines = 0;                  ///< line primitives dropped
  int degenerate_triangles = 0;         ///< triangles without area or with a repeated vertex dropped
  int parts_dropped = 0;                ///< parts that hold no triangle
  std::vector<std::string> look_notes;  ///< what else was left out or could not be used, a line each
  std::string text() const;             ///< what was left out in one line for a person
};

/// Reads a triangle mesh (OBJ, STL, PLY, glTF, GLB, of Gmsh volumes their borders; where the limits say so, what else
/// assimp reads). Vertices with
/// equal positions within a part are welded; node transforms are applied; every mesh of the file becomes a part named
/// after its node or mesh, every physical group of volumes one of its name or number.
/// Its colours, textures and normal maps come as TriangleMesh::detail; what is missing there is noted and is no error.
/// @param unit_scale_m  metres per file unit, > 0   @param with_look  false: shape alone
/// @throws MeshError  missing or corrupt file, no triangle at all, a non-finite coordinate, more than the limits accept
/// or than memory holds
TriangleMesh importMesh(const std::string& path, double unit_scale_m, ImportReport* report = nullptr,
                        const ImportLimits& limits = {}, bool with_look = true);

}  // namespace viscera
