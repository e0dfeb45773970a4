// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/organ/plain_tissue.h"

#include <cmath>

#include "math/number_text.h"
#include "model/scene/structure_rules.h"
#include "model/shape/mesh/box_surface.h"
#include "model/shape/mesh/plain_meshes.h"
#include "model/shape/organ/clamp_planes.h"
#include "model/shape/organ/placing.h"
#include "model/shape/solid/node_depths.h"
#include "model/shape/solid/solid_grid.h"
#include "model/shape/solid/solid_moments.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

class BoxTissue : public Tissue {
 public:
  explicit BoxTissue(const BodyConfig& config)
      : size_m_(config.box_size_m), pose_(bodyPose(config)), moments_(fillsInPart(config)) {
    planes_ = clampPlanes(config, bounds());
  }

  Filling fill(double spacing_m, const Progress& progress) const override {
    if (moments_ && (isTurned() || !isWhole(spacing_m).all())) return {fillByShares(spacing_m, progress), ""};
    if (isTurned()) return {fillTurned(spacing_m, progress), ""};
    requireSpacingWithin(size_m_, spacing_m);
    const Vector3d rounded_m = (size_m_ / spacing_m).array().round().max(1.0) * spacing_m;
    Solid solid = boxSolid(pose_.position_m - 0.5 * rounded_m, rounded_m, spacing_m);
    if (progress) progress("voxelise", 1);
    return {std::move(solid), roundingNote(rounded_m)};
  }

  TriangleMesh surface(const Solid& solid) const override {
    if (!isTurned() && solid.partial.empty())
      return boxSurface(solid.origin_m, solid.spacing_m * solid.cells.cast<double>(), solid.cells);
    const Vector3i squares = (size_m_ / solid.spacing_m).array().ceil().max(1.0).cast<int>();
    TriangleMesh mesh = boxSurface(-0.5 * size_m_, size_m_, squares);
    move(mesh.positions_m, pose_);
    return mesh;
  }

  TriangleMesh shell(double spacing_m) const override {
    requireSpacingWithin(size_m_, spacing_m);
    requireShell(2 * (size_m_.x() * size_m_.y() + size_m_.y() * size_m_.z() + size_m_.z() * size_m_.x()), spacing_m);
    const Vector3i squares = (size_m_ / spacing_m).array().round().max(1.0).cast<int>();
    TriangleMesh mesh = boxSurface(-0.5 * size_m_, size_m_, squares);
    move(mesh.positions_m, pose_);
    return mesh;
  }

  Eigen::AlignedBox3d bounds() const override { return movedBox(-0.5 * size_m_, 0.5 * size_m_, pose_); }

 private:
  bool isTurned() const { return pose_.orientation.vec().norm() > kTurn; }

  Eigen::Array<bool, 3, 1> isWhole(double spacing_m) const {
    constexpr double kRounding = 1e-4;  // in cells, as in grids
    const Eigen::Array3d cells = size_m_.array() / spacing_m;
    return (cells - cells.round()).abs() < kRounding && cells > 0.5;
  }

  /// Fills cells in part where faces pass through them. The lower faces are between cells. Exceptions are a box that is
  /// rotated, or one that is fixed by a plane across an axis along which its length is no integer number of cells.
  Solid fillByShares(double spacing_m, const Progress& progress) const {
    requireSpacingWithin(bounds().sizes(), spacing_m);
    NodePlanes planes = planes_;
    const Eigen::Array<bool, 3, 1> whole = isWhole(spacing_m);
    for (int axis = 0; axis < 3 && !isTurned(); ++axis) {
      if (whole[axis] || !planes[axis]) planes[axis] = bounds().min()[axis];
    }
    Solid solid = emptySolid(bounds().min(), bounds().max(), spacing_m, {"box"}, planes);
    const std::vector<Volume> box = {{boxShell(-0.5 * size_m_, 0.5 * size_m_, pose_), 0}};
    fillByMoments(box, solid, progress);
    if (solid.filledCells() == 0)
      throw LatticeError("the box is too thin: no cell would be filled enough; use a smaller spacing_m");
    measureDepths(box, solid);
    return solid;
  }

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
    TextOut out;
    out << "box of " << size_m_.transpose() << " m is rounded to whole cells: " << rounded_m.transpose() << " m";
    return out.str();
  }

  static constexpr double kTurn = 1e-9;  ///< rounding of a full turn, in half radians
  Vector3d size_m_;
  Pose pose_;
  bool moments_;
  NodePlanes planes_;
};

class SheetTissue : public Tissue {
 public:
  explicit SheetTissue(const BodyConfig& config)
      : size_m_(config.box_size_m.x(), config.box_size_m.y(), 0), pose_(bodyPose(config)) {}

  Filling fill(double, const Progress&) const override { throw LatticeError("a sheet has no volume"); }
  TriangleMesh surface(const Solid&) const override { throw LatticeError("a sheet has no volume"); }

  TriangleMesh shell(double spacing_m) const override {
    requireSpacingWithin(size_m_, spacing_m);
    requireShell(size_m_.x() * size_m_.y(), spacing_m);
    const SheetGrid grid = sheetGrid(size_m_.x(), size_m_.y(), spacing_m);
    TriangleMesh mesh = sheetMesh(grid.rows, grid.columns, spacing_m, SheetSides::kStraight);
    move(mesh.positions_m, pose_);
    return mesh;
  }

  Eigen::AlignedBox3d bounds() const override { return movedBox(-0.5 * size_m_, 0.5 * size_m_, pose_); }

 private:
  Vector3d size_m_;
  Pose pose_;
};

class BallTissue : public Tissue {
 public:
  explicit BallTissue(const BodyConfig& config)
      : radius_m_(config.ball_radius_m),
        pose_(bodyPose(config)),
        moments_(fillsInPart(config)),
        skin_spacing_m_(config.skin_spacing_m) {
    planes_ = clampPlanes(config, bounds());
  }

  Filling fill(double spacing_m, const Progress& progress) const override {
    const Eigen::AlignedBox3d box = bounds();
    if (moments_) return {voxeliseByMoments(field(), {"ball"}, box.min(), box.max(), spacing_m, planes_, progress), ""};
    return {voxelise(field(), {"ball"}, box.min(), box.max(), spacing_m, progress), ""};
  }

  TriangleMesh surface(const Solid& solid) const override {
    return shell(skin_spacing_m_ > 0 ? std::min(skin_spacing_m_, solid.spacing_m) : solid.spacing_m);
  }

  TriangleMesh shell(double spacing_m) const override {
    requireSpacingWithin(bounds().sizes(), spacing_m);
    requireShell(4 * std::acos(-1.0) * radius_m_ * radius_m_, spacing_m);
    TriangleMesh mesh = ballMesh(radius_m_, spacing_m);
    move(mesh.positions_m, pose_);
    return mesh;
  }

  Eigen::AlignedBox3d bounds() const override {
    const Vector3d reach = Vector3d::Constant(radius_m_);
    return {pose_.position_m - reach, pose_.position_m + reach};
  }

 private:
  DistanceField field() const {
    return [middle = pose_.position_m, radius_m = radius_m_](const Vector3d& point_m) {
      return LabelledDistance{(point_m - middle).norm() - radius_m, 0};
    };
  }

  double radius_m_;
  Pose pose_;
  bool moments_;
  double skin_spacing_m_;
  NodePlanes planes_;
};

}  // namespace

void requireShell(double area_m2, double spacing_m) {
  requireSpacing(spacing_m);
  constexpr double kMostNodes = 20e6;
  const double node_m2 = std::sqrt(0.75) * spacing_m * spacing_m;
  if (area_m2 <= kMostNodes * node_m2) return;
  TextOut out;
  out << "spacing_m " << spacing_m << " gives about " << area_m2 / node_m2 << " nodes, more than " << kMostNodes
      << "; spacing_m must be at least " << std::sqrt(area_m2 / (kMostNodes * std::sqrt(0.75)));
  throw LatticeError(out.str());
}

std::unique_ptr<Tissue> boxTissue(const BodyConfig& config) {
  return std::make_unique<BoxTissue>(config);
}

std::unique_ptr<Tissue> sheetTissue(const BodyConfig& config) {
  return std::make_unique<SheetTissue>(config);
}

std::unique_ptr<Tissue> ballTissue(const BodyConfig& config) {
  return std::make_unique<BallTissue>(config);
}

}  // namespace viscera
