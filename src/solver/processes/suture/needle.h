// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include "solver/processes/stylus_pull.h"
#include "solver/processes/suture/needle_shape.h"
#include "solver/processes/tissue_points.h"
#include "viscera/model/scene/thread_config.h"

namespace viscera {

class Archive;

/// What tissue does to a needle at one place of it (docs/thread.md 6).
struct NeedleLaw {
  double puncture_n = 0;         ///< of its skin
  double cutting_n = 0;          ///< before the tip
  double friction_n_per_m = 0;   ///< along the shaft
  double stiffness_n_per_m = 1;  ///< of the tissue around the shaft, which the nodes do not resolve
};

/// A place of tissue that the tail has left.
struct NeedlePassed {
  TissuePoint point;
  double beyond_m = 0;  ///< behind the tail
  bool enters = false;  ///< the skin where it went in: what of its thread lies behind is outside
};

/// A needle in tissue: the tip holds the skin's point before it until that gives way, drags a point of the tissue
/// inside, and leaves points on the shaft; those that the tail has passed are the thread's. A hand leads it, or it is
/// free: a rigid body that gravity, tissue and its thread move.
class Needle {
 public:
  /// @param model  must outlive it
  Needle(const NeedleConfig& config, const Model& model, const Vector3d& tail_m);

  /// @name A substep, in this order
  /// @{
  void lead(const Pose& to, double dt_s);                                 ///< by a hand, to there
  void fall(const Vector3d& gravity_m_per_s2, double dt_s);               ///< or by itself
  void keepOut(const layout::ObstacleMotion* obstacles, uint32_t count);  ///< of obstacles
  /// Reads the tissue, gives it its impulses and writes them, and goes on through it.
  /// @param passed  out: places that the tail has left, behind those there
  void act(TissuePort& target, TissuePoints& tissue, std::vector<NeedlePassed>& passed);
  /// What its thread gave the tail in the substep; moves it only where it is free.
  void pull(const Vector3d& impulse_ns);
  /// @}

  const NeedleShape& shape() const { return shape_; }
  std::vector<Vector3d> places_m() const { return shape_.places(end_); }
  const Pose& pose() const { return end_; }  ///< at the end of the substep
  Vector3d tail_m() const { return tailAt_m(1); }
  Vector3d tailAt_m(double share) const;  ///< of its way in the substep
  double tailMass_kg() const;             ///< that it shows its thread
  bool isInTissue() const { return tip_.state >= kInside || !crossings_.empty(); }
  size_t crossings() const { return crossings_.size(); }
  /// On the tissue, in the last substep; about the origin of the tissue frame.
  const Vector3d& force_n() const { return force_n_; }
  const Vector3d& torque_nm() const { return torque_nm_; }
  double work_j() const { return work_j_; }          ///< on the tissue, then
  const NeedleHold& hold() const { return hold_; }   ///< of the tissue on it, then
  double alongTip_n() const { return tip_n_; }       ///< of it, by the tip and along it
  double farthest_m() const { return farthest_m_; }  ///< of tissue on the shaft from it, then
  /// Springs were cut.
  void embedAgain(const TissuePoints& tissue);
  void reset();
  void persist(Archive& archive);

 private:
  enum State : uint32_t {
    kClear,    ///< outside, and may touch
    kBlocked,  ///< came out or slid off: may touch again when it has been outside of all tissue
    kTouches,
    kInside,
    kLeaves,  ///< is inside, before the far skin
  };
  struct Tip {
    State state = kClear;
    TissuePoint point;
    Vector3d impulse_ns = Vector3d::Zero();
    NeedleLaw law;
    double path_m = 0;  ///< through tissue at rest, since the skin
    /// Where it looked for tissue last, outside; and how many substeps ago.
    Vector3d looked_m = Vector3d::Constant(std::numeric_limits<double>::infinity());
    uint32_t looked_ago = 0;
  };
  /// A point of tissue that the shaft goes through.
  struct Crossing {
    TissuePoint point;
    Vector3d impulse_ns = Vector3d::Zero();
    NeedleLaw law;
    double path_m = 0, length_m = 0;  ///< of the tip when it left it; of the shaft that it stands for
    uint32_t skin = 0, enters = 0;
  };
  struct Row {
    const TissuePoint* point;
    Vector3d* impulse_ns;
    Vector3d at_m, along;    ///< on the needle
    double low_n, high_n;    ///< along
    double softness_per_kg;  ///< across
    bool holds;              ///< the place along, too, and not the speed alone
  };
  NeedleLaw lawAt(const TissuePoint& point) const;
  void move();
  Vector3d velocityAt(const Vector3d& place_m) const;
  double mobilityAt(const Vector3d& place_m) const;
  void push(const Vector3d& place_m, const Vector3d& impulse_ns);
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
  Eigen::AlignedBox3d around_;                 ///< where tissue may come
  Pose start_;                                 ///< of the scene
  Tip tip_;
  std::vector<Crossing> crossings_;
  Vector3d last_passed_m_;                                             ///< at rest
  Vector3d velocity_ = Vector3d::Zero(), turning_ = Vector3d::Zero();  ///< of the middle, about it
  Pose from_, end_;
  double dt_s_ = 0;
  bool led_ = false;
  Vector3d force_n_ = Vector3d::Zero(), torque_nm_ = Vector3d::Zero();
  double work_j_ = 0, tip_n_ = 0, farthest_m_ = 0;
  NeedleHold hold_;
};

}  // namespace viscera
