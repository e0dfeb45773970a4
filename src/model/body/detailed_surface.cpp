// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/detailed_surface.h"

#include <algorithm>
#include <filesystem>

#include "model/body/skin_size.h"
#include "model/shape/detail/detail_atlas.h"
#include "model/shape/detail/detail_bake.h"
#include "model/shape/detail/detail_paint.h"
#include "model/shape/mesh/fewer_faces.h"
#include "model/shape/mesh/part_color.h"
#include "model/shape/organ/placing.h"
#include "model/shape/solid/solid_shell.h"
#include "viscera/math/error.h"
#include "viscera/model/shape/mesh_import.h"

namespace viscera {

namespace {

// Share of the surface that a mesh may miss before it counts as a mesh of something else.
constexpr double kElsewhere = 0.9;

TriangleMesh readDetail(const std::string& path, const DetailWanted& wanted, std::vector<std::string>& notes) {
  const BodyConfig& config = wanted.config;
  ImportReport report;
  TriangleMesh mesh =
      facingOutward(importMesh(path, config.unit_scale_m, &report, config.import_limits, config.textures));
  move(mesh.positions_m, wanted.file_pose);
  moveDetail(mesh, wanted.file_pose);
  notes.push_back("detail_mesh " + path + ": " + report.text());
  notes.insert(notes.end(), report.appearance_notes.begin(), report.appearance_notes.end());
  return mesh;
}

bool anyMaterial(const TriangleMesh& mesh, bool textured) {
  if (!mesh.detail) return false;
  const auto& all = mesh.detail->materials;
  return std::any_of(all.begin(), all.end(), [&](const SurfaceMaterial& of) {
    return textured ? of.color_texture.image >= 0 : of.has_color || of.color_texture.image >= 0;
  });
}

/// Returns the side of the texture's square [px]; a surface with too many faces for detail_px gets a larger one.
int neededSide(size_t faces, int detail_px, std::vector<std::string>& notes) {
  constexpr int kMost_px = 16384;  // largest detail_px
  const int needed_px = std::min(DetailAtlas::leastSide(faces), kMost_px);
  if (needed_px <= detail_px) return detail_px;
  const std::string side = std::to_string(needed_px);
  notes.push_back("skin: " + std::to_string(faces) + " faces need a detail texture of " + side + " x " + side +
                  " texels, which is larger than detail_px");
  return needed_px;
}

}  // namespace

TriangleMesh detailedSurface(TriangleMesh surface, const DetailWanted& wanted, std::vector<std::string>& notes,
                             const Progress& progress) {
  const BodyConfig& config = wanted.config;
  const size_t faces = surface.triangles.size();
  const bool fewer = config.skin_faces > 0 && static_cast<size_t>(config.skin_faces) < faces;
  TriangleMesh skin = fewer ? withFewerFaces(surface, static_cast<size_t>(config.skin_faces)) : surface;
  if (fewer) {
    notes.push_back("skin: " + std::to_string(faces) + " faces simplified to " + std::to_string(skin.triangles.size()));
  }
  requireSkinSize(skin, wanted.longest_edge_m, config.import_limits.max_triangles);
  if (!fewer && config.detail_mesh.empty() && !wanted.paint.paint) return skin;
  // Refine before baking: the shading normals between its vertices are then those that will be bound.
  skin = refine(skin, wanted.longest_edge_m);
  if (!fewer && config.detail_mesh.empty()) {
    return paintDetail(skin, wanted.paint, neededSide(skin.triangles.size(), config.detail_px, notes), progress);
  }
  const std::string path = (std::filesystem::path(wanted.folder) / config.detail_mesh).string();
  const bool own = config.detail_mesh.empty();
  const TriangleMesh detailed = own ? std::move(surface) : readDetail(path, wanted, notes);
  skin.charts.clear();
  BakeReport report;
  const int side_px = neededSide(skin.triangles.size(), config.detail_px, notes);
  TriangleMesh baked = bakeDetail({skin, detailed, anyMaterial(detailed, own), side_px}, &report, progress);
  if (report.uncovered_share > kElsewhere) {
    throw MeshError("detail_mesh '" + path + "' does not cover the skin: it is not near " +
                    std::to_string(static_cast<int>(100 * report.uncovered_share)) +
                    " % of it. Export it in the frame and unit of mesh_file: unit_scale_m, up_axis and the body's pose "
                    "apply to both");
  }
  notes.push_back(report.text());
  return baked;
}

TriangleMesh withPartColors(TriangleMesh mesh, const std::vector<PartConfig>& parts) {
  std::shared_ptr<SurfaceDetail> detail;
  for (const PartConfig& part : parts) {
    if (!part.color) continue;
    for (size_t p = 0; p < mesh.part_names.size(); ++p) {
      if (mesh.part_names[p] != part.part) continue;
      if (!detail)
        detail = mesh.detail ? std::make_shared<SurfaceDetail>(*mesh.detail) : std::make_shared<SurfaceDetail>();
      addPartColor(p, *part.color, *detail);
    }
  }
  if (detail) mesh.detail = std::move(detail);
  return mesh;
}

}  // namespace viscera
