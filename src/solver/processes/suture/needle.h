// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include "solver/processes/stylus_pull.h"
#include "solver/processes/suture/needle_shape.h"
#include "solver/processes/tissue_points.h"
#include "viscera/model/scene/suture_config.h"

namespace viscera {

class Archive;

/// Resistance of tissue to a needle at a point (docs/physics.md 16).
struct NeedleLaw {
  double puncture_n = 0;         ///< force to puncture its surface
  double cutting_n = 0;          ///< force on the tip that cuts
  double friction_n_per_m = 0;   ///< friction along the shaft
  double stiffness_n_per_m = 1;  ///< stiffness of the tissue around the shaft, which the nodes do not resolve
};

/// A point of tissue that the tail has left.
struct NeedlePassed {
  TissuePoint point;
  double beyond_m = 0;  ///< distance behind the tail
  bool enters = false;  ///< the needle entered through the surface here: the suture behind it is outside
};

/// A needle in tissue. The tip holds the surface point in front of it until that gives way, drags a point of the tissue
/// inside, and leaves points on the shaft. Points that the tail has passed become the suture's. A stylus leads the
/// needle, or it is free: a rigid body moved by gravity, tissue and its suture.
class Needle {
 public:
  /// @param model  must outlive it
  Needle(const NeedleConfig& config, const Model& model, const Vector3d& tail_m);

  /// @name Steps of a substep, in this order
  /// @{
  void lead(const Pose& to, double dt_s);                                 ///< moves it to a pose, led by a stylus
  void fall(const Vector3d& gravity_m_per_s2, double dt_s);               ///< or moves it as a free body
  void keepOut(const layout::ObstacleMotion* obstacles, uint32_t count);  ///< moves it out of obstacles
  /// Reads the tissue, applies impulses, writes them, and advances through the tissue.
  /// @param passed  out: appends the points that the tail has left
  void act(TissuePort& target, TissuePoints& tissue, std::vector<NeedlePassed>& passed);
  /// Applies the suture's impulse on the tail in the substep; moves only a free needle.
  void pull(const Vector3d& impulse_ns);
  /// @}

  const NeedleShape& shape() const { return shape_; }
  std::vector<Vector3d> positions_m() const { return shape_.positions(end_); }
  const Pose& pose() const { return end_; }  ///< pose at the end of the substep
  Vector3d tail_m() const { return tailAt_m(1); }
  Vector3d tailAt_m(double share) const;  ///< tail at a share of its displacement in the substep
  double tailMass_kg() const;             ///< effective mass at the tail, as seen by its suture
  bool isInTissue() const { return tip_.state >= kInside || !crossings_.empty(); }
  size_t crossings() const { return crossings_.size(); }
  /// Returns the force on the tissue in the last substep; the torque is about the origin of the tissue frame.
  const Vector3d& force_n() const { return force_n_; }
  const Vector3d& torque_nm() const { return torque_nm_; }
  double work_j() const { return work_j_; }          ///< work on the tissue in the last substep
  const NeedleHold& hold() const { return hold_; }   ///< forces of the tissue on it in the last substep
  double alongTip_n() const { return tip_n_; }       ///< force on the tissue by the tip, along the tip
  double farthest_m() const { return farthest_m_; }  ///< largest distance of a tissue point on the shaft from the shaft
  /// Finds the points on the shaft again after springs were cut.
  void embedAgain(const TissuePoints& tissue);
  void reset();
  void persist(Archive& archive);

 private:
  enum State : uint32_t {
    kClear,    ///< outside, and may touch
    kBlocked,  ///< came out or slid off: may touch again after it was outside all tissue
    kTouches,
    kInside,
    kLeaves,  ///< inside, before the opposite surface
  };
  struct Tip {
    State state = kClear;
    TissuePoint point;
    Vector3d impulse_ns = Vector3d::Zero();
    NeedleLaw law;
    double path_m = 0;  ///< path through tissue at rest since the surface
    /// Position of the last search for tissue while outside, and the number of substeps since.
    Vector3d looked_m = Vector3d::Constant(std::numeric_limits<double>::infinity());
    uint32_t looked_ago = 0;
  };
  /// A point of tissue that the shaft passes through.
  struct Crossing {
    TissuePoint point;
    Vector3d impulse_ns = Vector3d::Zero();
    NeedleLaw law;
    double path_m = 0, length_m = 0;  ///< path of the tip when it left the point; length of shaft that it represents
    uint32_t skin = 0, enters = 0;
  };
  struct Row {
    const TissuePoint* point;
    Vector3d* impulse_ns;
    Vector3d at_m, along;    ///< point on the needle, and its tangent
    double low_n, high_n;    ///< limits along
    double softness_per_kg;  ///< softness across
    bool holds;              ///< holds the position along, too, and not only the speed
  };
  NeedleLaw lawAt(const TissuePoint& point) const;
  void move();
  Vector3d velocityAt(const Vector3d& position_m) const;
  double mobilityAt(const Vector3d& position_m) const;
  void push(const Vector3d& position_m, const Vector3d& impulse_ns);
  void touch(TissuePort& target, const TissuePoints& tissue);
  void read(TissuePort& target, TissuePoints& tissue) const;
  void sweep(TissuePoints& tissue);
  void solve(TissuePoints& tissue, const Row& row);
  void solveTip(TissuePoints& tissue);
  void sum(const TissuePoints& tissue);
  void addToHold(const TissuePoint& point, const NeedleLaw& law, double length_m, double behind_m);
  void settle(TissuePort& target, const TissuePoints& tissue);
  void goOn(TissuePort& target, const TissuePoints& tissue, double slip_m);
  void standAt(const TissuePoint& point);
  void leaveCrossing(bool skin);
  void sortOut(const TissuePoints& tissue, std::vector<NeedlePassed>& passed);

  NeedleConfig config_;
  NeedleShape shape_;
  const Model& model_;
  std::vector<std::vector<double>> young_pa_;  ///< [bodies][labels]
  Eigen::AlignedBox3d around_;                 ///< region that tissue may reach
  Pose start_;                                 ///< initial pose
  Tip tip_;
  std::vector<Crossing> crossings_;
  Vector3d last_passed_m_;                                             ///< rest position of the last point passed
  Vector3d velocity_ = Vector3d::Zero(), turning_ = Vector3d::Zero();  ///< velocity of the centre; angular velocity
  Pose from_, end_;
  double dt_s_ = 0;
  bool led_ = false;
  Vector3d force_n_ = Vector3d::Zero(), torque_nm_ = Vector3d::Zero();
  double work_j_ = 0, tip_n_ = 0, farthest_m_ = 0;
  NeedleHold hold_;
};

}  // namespace viscera
