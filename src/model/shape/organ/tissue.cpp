// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/organ/tissue.h"

#include <filesystem>

#include "model/scene/structure_rules.h"
#include "model/shape/enclosed/enclosed_solid.h"
#include "model/shape/files/msh_reader.h"
#include "model/shape/mesh/part_color.h"
#include "model/shape/organ/clamp_planes.h"
#include "model/shape/organ/label_mesh.h"
#include "model/shape/organ/placing.h"
#include "model/shape/organ/plain_tissue.h"
#include "model/shape/organ/tube_tissue.h"
#include "model/shape/solid/joined_parts.h"
#include "model/shape/solid/solid_shell.h"
#include "viscera/math/error.h"
#include "viscera/model/shape/mesh_import.h"

namespace viscera {
namespace {

TriangleMesh refined(const TriangleMesh& mesh, double longest_edge_m) {
  double area_m2 = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3d a = mesh.positions_m[t[0]].cast<double>();
    area_m2 +=
        0.5 * (mesh.positions_m[t[1]].cast<double>() - a).cross(mesh.positions_m[t[2]].cast<double>() - a).norm();
  }
  requireShell(area_m2, longest_edge_m);
  return refine(mesh, longest_edge_m);
}

/// Tissue from a mesh file, or from labels of a scan. Labels and groups of volumes may touch: they share triangles.
class MeshTissue : public Tissue {
 public:
  MeshTissue(const BodyConfig& config, const std::string& folder)
      : labels_(config.source == TissueSource::kLabels), touch_(labels_ || isMsh(config.mesh_file)) {
    read(config, folder);
    const Pose placed = toBodyFrame(mesh_.positions_m, config);
    move(mesh_.positions_m, bodyPose(config));
    file_pose = bodyPose(config) * placed;
    moveDetail(mesh_, file_pose);
    if (touch_) skin_ = withoutSharedBorders(mesh_);
    moments_ = fillsInPart(config);
    enclosed_ = config.fill == Fill::kEnclosed;
    gap_m_ = config.gap_m;
    const bool is_whole = touch_ || enclosed_ || isNetwork(config.structure);
    bounds_ = is_whole ? boundsOf(mesh_.positions_m) : filledBounds(mesh_);
    planes_ = clampPlanes(config, bounds());
  }

  Filling fill(double spacing_m, const Progress& progress) const override {
    VoxelReport report;
    try {
      if (enclosed_) {
        std::string note;
        Solid solid = voxeliseEnclosed(touch_ ? skin_ : mesh_, spacing_m, gap_m_, moments_, planes_, note, progress);
        return {std::move(solid), note};
      }
      Solid solid = moments_ ? voxeliseByMoments(mesh_, spacing_m, planes_, &report, progress)
                             : voxelise(mesh_, spacing_m, &report, progress);
      return {std::move(solid), report.text()};
    } catch (const MeshError& error) {
      throw MeshError((labels_ ? "scan '" : "mesh file '") + path_ + "': " + error.what());
    }
  }

  /// Returns a surface closed where the solid is, except for gaps between patches: no view inside through a hole.
  TriangleMesh surface(const Solid&) const override {
    if (touch_) return skin_;
    return enclosed_ ? mesh_ : withCaps(mesh_);
  }
  TriangleMesh shell(double spacing_m) const override { return refined(touch_ ? skin_ : mesh_, spacing_m); }
  Eigen::AlignedBox3d bounds() const override { return bounds_; }

 private:
  void read(const BodyConfig& config, const std::string& folder) {
    path_ = (std::filesystem::path(folder) / (labels_ ? config.scan.file : config.mesh_file)).string();
    if (labels_) {
      mesh_ = labelMesh(config, folder, notes);
      return;
    }
    ImportReport report;
    mesh_ = facingOutward(importMesh(path_, config.unit_scale_m, &report, config.import_limits, config.textures));
    notes.push_back(path_ + ": " + report.text());
    notes.insert(notes.end(), report.appearance_notes.begin(), report.appearance_notes.end());
  }

  std::string path_;
  TriangleMesh mesh_;
  TriangleMesh skin_;  ///< outer border of parts that may touch
  bool labels_, touch_;
  bool moments_ = false, enclosed_ = false;
  double gap_m_ = 0;
  Eigen::AlignedBox3d bounds_;  ///< box of the filled region
  NodePlanes planes_;
};

/// Returns colours as a mesh file would give them. @return null without colours
std::shared_ptr<const SurfaceDetail> partDetail(const std::vector<Vector3d>& part_colors) {
  if (part_colors.empty()) return nullptr;
  auto detail = std::make_shared<SurfaceDetail>();
  for (size_t part = 0; part < part_colors.size(); ++part) addPartColor(part, part_colors[part], *detail);
  return detail;
}

Phantom phantomOf(const BodyConfig& config) {
  switch (config.phantom) {
    case Anatomy::kHeart:
      if (!config.scan.labels.empty()) throw SceneError("scan.labels must be empty: the heart is one piece");
      return heartPhantom(config.phantom_length_m, config.phantom_wall_scale);
    case Anatomy::kGallbladder:
      return gallbladderPhantom(config.phantom_length_m, config.phantom_wall_scale, config.phantom_seed,
                                config.scan.labels);
  }
  throw SceneError("body '" + config.name + "': unknown phantom");
}

class PhantomTissue : public Tissue {
 public:
  explicit PhantomTissue(const BodyConfig& config)
      : phantom_(phantomOf(config)), moments_(fillsInPart(config)), skin_spacing_m_(config.skin_spacing_m) {
    const Pose pose = pose_ = bodyPose(config);
    has_vessels_ = config.phantom == Anatomy::kHeart && config.textures && config.skin_spacing_m > 0;
    length_m_ = config.phantom_length_m;
    wall_scale_ = config.phantom_wall_scale;
    const Eigen::AlignedBox3d box = movedBox(phantom_.min_m, phantom_.max_m, pose);
    phantom_.min_m = box.min();
    phantom_.max_m = box.max();
    phantom_.field = movedField(phantom_.field, pose);
    planes_ = clampPlanes(config, bounds());
    if (config.textures) detail_ = partDetail(phantom_.part_colors);
  }

  Filling fill(double spacing_m, const Progress& progress) const override {
    const Phantom& p = phantom_;
    const DistanceField field = p.field_for_cells ? movedField(p.field_for_cells(spacing_m), pose_) : p.field;
    if (moments_) return {voxeliseByMoments(field, p.part_names, p.min_m, p.max_m, spacing_m, planes_, progress), ""};
    return {voxelise(field, p.part_names, p.min_m, p.max_m, spacing_m, progress), ""};
  }

  /// Returns the surface mesh. With partly filled cells walls may be thinner than a cell: the mesh still contains them.
  TriangleMesh surface(const Solid& solid) const override {
    double spacing_m = solid.spacing_m;
    if (skin_spacing_m_ > 0) spacing_m = std::min(spacing_m, skin_spacing_m_);
    for (const Wall& wall : phantom_.walls)
      if (moments_) spacing_m = std::min(spacing_m, kSkinInWall * wall.thickness_m);
    return shell(spacing_m);
  }
  TriangleMesh shell(double spacing_m) const override {
    TriangleMesh mesh = extractSkin(phantom_.field, phantom_.part_names, phantom_.min_m, phantom_.max_m, spacing_m);
    mesh.detail = detail_;
    return mesh;
  }

  PlacedPaint paint() const override {
    if (!has_vessels_) return {};
    PlacedPaint paint = heartPaint(length_m_, wall_scale_);
    const Pose to_body = pose_.inverse();
    paint.shift += paint.turn * (to_body.position_m / paint.unit_m);
    paint.turn = paint.turn * to_body.orientation;
    return paint;
  }

  Eigen::AlignedBox3d bounds() const override { return {phantom_.min_m, phantom_.max_m}; }
  /// Returns no walls where cells are partly filled: walls thinner than a cell have no holes then.
  std::vector<Wall> walls() const override { return moments_ ? std::vector<Wall>{} : phantom_.walls; }

 private:
  static constexpr double kSkinInWall = 0.75;  ///< share of a wall's thickness: no cell of the surface misses a wall
  Phantom phantom_;
  bool moments_;
  double skin_spacing_m_, length_m_ = 1, wall_scale_ = 1;
  bool has_vessels_ = false;
  Pose pose_;
  NodePlanes planes_;
  std::shared_ptr<const SurfaceDetail> detail_;  ///< colours of the parts; null: none
};

}  // namespace

Pose bodyPose(const BodyConfig& config) {
  return {config.position_m, rotationFromDegrees(config.rotation_deg)};
}

namespace {

std::unique_ptr<Tissue> tissueOf(const BodyConfig& config, const std::string& folder) {
  switch (config.source) {
    case TissueSource::kMesh:
    case TissueSource::kLabels:
      return std::make_unique<MeshTissue>(config, folder);
    case TissueSource::kPhantom:
      return std::make_unique<PhantomTissue>(config);
    case TissueSource::kSheet:
      return sheetTissue(config);
    case TissueSource::kBall:
      return ballTissue(config);
    case TissueSource::kTube:
      return tubeTissue(config);
    case TissueSource::kBox:
      return boxTissue(config);
  }
  throw SceneError("body '" + config.name + "': unknown source");
}

}  // namespace

std::unique_ptr<Tissue> makeTissue(const BodyConfig& config, const std::string& folder) {
  const std::string fault = structureFault(config);
  if (!fault.empty()) throw SceneError("body '" + config.name + "': " + fault);
  std::unique_ptr<Tissue> tissue = tissueOf(config, folder);
  if (config.source == TissueSource::kMesh || config.source == TissueSource::kLabels) return tissue;
  const double turn_deg = config.up_axis == UpAxis::kY ? 90 : 0;
  tissue->file_pose = bodyPose(config) * Pose{Vector3d::Zero(), rotationFromDegrees({turn_deg, 0, 0})};
  return tissue;
}

}  // namespace viscera
