// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/organ/tube_tissue.h"

#include "math/number_text.h"
#include "model/scene/structure_rules.h"
#include "model/shape/organ/clamp_planes.h"
#include "model/shape/organ/hollow_tube.h"
#include "model/shape/organ/placing.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr double kLeastWall = 0.5;      // cells: a thinner wall is lost in places
constexpr double kLeastLumen = 2;       // cells across: walls that are nearer share cells
constexpr double kSkinInWall = 0.75;    // share of the wall: no cell of the surface misses it
constexpr double kSpacingNoise = 1e-6;  // for a spacing that is meant to equal a limit

class TubeTissue : public Tissue {
 public:
  explicit TubeTissue(const BodyConfig& config)
      : tube_(config.tube, config.name),
        pose_(bodyPose(config)),
        moments_(fillsInPart(config)),
        skin_spacing_m_(config.skin_spacing_m) {
    planes_ = clampPlanes(config, bounds());
  }

  Filling fill(double spacing_m, const Progress& progress) const override {
    requireSpacing(spacing_m);
    const Eigen::AlignedBox3d box = bounds();
    const std::vector<std::string> names = tube_.partNames();
    if (moments_) return {voxeliseByMoments(field(), names, box.min(), box.max(), spacing_m, planes_, progress), ""};
    return {voxelise(field(), names, box.min(), box.max(), spacing_m, progress), ""};
  }

  TriangleMesh surface(const Solid& solid) const override {
    double spacing_m = std::min(solid.spacing_m, kSkinInWall * tube_.thinnestWall_m());
    if (skin_spacing_m_ > 0) spacing_m = std::min(spacing_m, skin_spacing_m_);
    return shell(spacing_m);
  }
  TriangleMesh shell(double spacing_m) const override {
    const Eigen::AlignedBox3d box = bounds();
    TriangleMesh mesh = extractSkin(field(), tube_.partNames(), box.min(), box.max(), spacing_m);
    moveOntoBorder([field = field()](const Vector3d& p) { return field(p).distance_m; }, 0.5 * spacing_m, mesh);
    return mesh;
  }

  Eigen::AlignedBox3d bounds() const override {
    const Eigen::AlignedBox3d box = tube_.bounds();
    return movedBox(box.min(), box.max(), pose_);
  }

  /// Returns its wall, as thick as the coarsest spacing that it allows.
  std::vector<Wall> walls() const override { return {{"tube", coarsest_m()}}; }

 private:
  DistanceField field() const {
    return movedField([this](const Vector3d& p) { return tube_.tissue(p); }, pose_);
  }

  double coarsest_m() const {
    const double of_wall_m = tube_.thinnestWall_m() / (moments_ ? kLeastWall : 1);
    return std::min(of_wall_m, 2 * tube_.narrowestLumen_m() / kLeastLumen);
  }

  void requireSpacing(double spacing_m) const {
    if (spacing_m <= (1 + kSpacingNoise) * coarsest_m()) return;
    throw LatticeError("cells of " + numberText(spacing_m, 4) + " m are too coarse for a wall of " +
                       numberText(tube_.thinnestWall_m(), 4) + " m around a lumen of " +
                       numberText(2 * tube_.narrowestLumen_m(), 4) +
                       " m: it would have holes, or opposite walls would share cells; spacing_m must be at most " +
                       numberText(coarsest_m(), 4));
  }

  HollowTube tube_;
  Pose pose_;
  bool moments_;
  double skin_spacing_m_;
  NodePlanes planes_;
};

}  // namespace

std::unique_ptr<Tissue> tubeTissue(const BodyConfig& config) {
  return std::make_unique<TubeTissue>(config);
}

}  // namespace viscera
