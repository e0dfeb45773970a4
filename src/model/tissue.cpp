// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/tissue.h"

#include <filesystem>
#include <sstream>

#include "model/box_surface.h"
#include "model/solid_grid.h"
#include "model/solid_shell.h"
#include "viscera/math/error.h"
#include "viscera/model/mesh_import.h"
#include "viscera/model/phantom.h"

namespace viscera {
namespace {

void move(TriangleMesh& mesh, const Pose& pose) {
  for (Vector3f& position : mesh.positions_m) position = (pose * position.cast<double>()).cast<float>();
}

/// Turns the file's upward axis to z and moves the middle of its bounding box to the origin, where asked to.
void toBodyFrame(TriangleMesh& mesh, const BodyConfig& config) {
  if (config.up_axis == UpAxis::kY) {
    for (Vector3f& p : mesh.positions_m) p = Vector3f(p.x(), -p.z(), p.y());
  }
  if (!config.centered) return;
  Eigen::AlignedBox3f box;
  for (const Vector3f& p : mesh.positions_m) box.extend(p);
  const Vector3f middle = box.center();
  for (Vector3f& p : mesh.positions_m) p -= middle;
}

/// Box around a box that is turned and moved.
Eigen::AlignedBox3d movedBox(const Vector3d& min_m, const Vector3d& max_m, const Pose& pose) {
  const Vector3d half = 0.5 * (max_m - min_m), center = pose * (0.5 * (min_m + max_m));
  const Vector3d reach = pose.orientation.toRotationMatrix().cwiseAbs() * half;
  return {center - reach, center + reach};
}

DistanceField movedField(const DistanceField& field, const Pose& pose) {
  return [field, to_body = pose.inverse()](const Vector3d& point_m) { return field(to_body * point_m); };
}

class MeshTissue : public Tissue {
 public:
  MeshTissue(const BodyConfig& config, const std::string& folder) {
    path_ = (std::filesystem::path(folder) / config.mesh_file).string();
    ImportReport report;
    mesh_ = facingOutward(importMesh(path_, config.unit_scale_m, &report));
    toBodyFrame(mesh_, config);
    move(mesh_, bodyPose(config));
    notes.push_back(path_ + ": " + report.text());
  }

  Filling fill(double spacing_m, const Progress& progress) const override {
    VoxelReport report;
    try {
      Solid solid = voxelise(mesh_, spacing_m, &report, progress);
      return {std::move(solid), report.text()};
    } catch (const MeshError& error) {
      throw MeshError("mesh file '" + path_ + "': " + error.what());
    }
  }

  TriangleMesh surface(const Solid&) const override { return mesh_; }

  Eigen::AlignedBox3d bounds() const override {
    Eigen::AlignedBox3d box;
    for (const Vector3f& position : mesh_.positions_m) box.extend(position.cast<double>());
    return box;
  }

 private:
  std::string path_;
  TriangleMesh mesh_;
};

class PhantomTissue : public Tissue {
 public:
  explicit PhantomTissue(const BodyConfig& config)
      : phantom_(heartPhantom(config.phantom_length_m, config.phantom_wall_scale)) {
    const Pose pose = bodyPose(config);
    const Eigen::AlignedBox3d box = movedBox(phantom_.min_m, phantom_.max_m, pose);
    phantom_.min_m = box.min();
    phantom_.max_m = box.max();
    phantom_.field = movedField(phantom_.field, pose);
  }

  Filling fill(double spacing_m, const Progress& progress) const override {
    return {voxelise(phantom_.field, phantom_.part_names, phantom_.min_m, phantom_.max_m, spacing_m, progress), ""};
  }

  TriangleMesh surface(const Solid& solid) const override {
    return extractSkin(phantom_.field, phantom_.part_names, phantom_.min_m, phantom_.max_m, solid.spacing_m);
  }

  Eigen::AlignedBox3d bounds() const override { return {phantom_.min_m, phantom_.max_m}; }

 private:
  Phantom phantom_;
};

class BoxTissue : public Tissue {
 public:
  explicit BoxTissue(const BodyConfig& config) : size_m_(config.box_size_m), pose_(bodyPose(config)) {}

  Filling fill(double spacing_m, const Progress& progress) const override {
    if (isTurned()) return {fillTurned(spacing_m, progress), ""};
    requireSpacingWithin(size_m_, spacing_m);
    const Vector3d rounded_m = (size_m_ / spacing_m).array().round().max(1.0) * spacing_m;
    Solid solid = boxSolid(pose_.position_m - 0.5 * rounded_m, rounded_m, spacing_m);
    if (progress) progress("voxelise", 1);
    return {std::move(solid), roundingNote(rounded_m)};
  }

  TriangleMesh surface(const Solid& solid) const override {
    if (!isTurned()) return boxSurface(solid.origin_m, solid.spacing_m * solid.cells.cast<double>(), solid.cells);
    const Vector3i squares = (size_m_ / solid.spacing_m).array().ceil().max(1.0).cast<int>();
    TriangleMesh mesh = boxSurface(-0.5 * size_m_, size_m_, squares);
    move(mesh, pose_);
    return mesh;
  }

  Eigen::AlignedBox3d bounds() const override { return movedBox(-0.5 * size_m_, 0.5 * size_m_, pose_); }

 private:
  bool isTurned() const { return pose_.orientation.vec().norm() > kTurn; }

  Solid fillTurned(double spacing_m, const Progress& progress) const {
    const Vector3d half_m = 0.5 * size_m_;
    const DistanceField field = [half_m](const Vector3d& point_m) {
      return LabelledDistance{(point_m.cwiseAbs() - half_m).maxCoeff(), 0};
    };
    return voxelise(movedField(field, pose_), {"box"}, bounds().min(), bounds().max(), spacing_m, progress);
  }

  std::string roundingNote(const Vector3d& rounded_m) const {
    constexpr double kWorthTelling = 0.01;
    if (((rounded_m - size_m_).cwiseAbs().array() < kWorthTelling * size_m_.array()).all()) return "";
    std::ostringstream out;
    out << "box of " << size_m_.transpose() << " m rounded to whole cells: " << rounded_m.transpose() << " m";
    return out.str();
  }

  static constexpr double kTurn = 1e-9;  ///< rounding of a full turn, in half radians
  Vector3d size_m_;
  Pose pose_;
};

}  // namespace

Pose bodyPose(const BodyConfig& config) {
  return {config.position_m, rotationFromDegrees(config.rotation_deg)};
}

std::unique_ptr<Tissue> makeTissue(const BodyConfig& config, const std::string& folder) {
  if (config.skin == SkinSource::kInput && config.source != TissueSource::kMesh) {
    throw SceneError("body '" + config.name + "': skin: input needs source: mesh; use auto or volume");
  }
  switch (config.source) {
    case TissueSource::kMesh:
      return std::make_unique<MeshTissue>(config, folder);
    case TissueSource::kPhantom:
      return std::make_unique<PhantomTissue>(config);
    case TissueSource::kBox:
      return std::make_unique<BoxTissue>(config);
  }
  throw SceneError("body '" + config.name + "': unknown source");
}

}  // namespace viscera
