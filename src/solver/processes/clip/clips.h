// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/processes/process.h"
#include "solver/processes/suture/thread_blades.h"
#include "solver/processes/tissue_points.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/solver/seen_clip.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// Clips (docs/lessons/clips.md): each holds two sides of tissue together, node by node, with impulses after each
/// substep that take no linear and no angular momentum. Blades that meet one take it off.
class Clips : public TissueProcess {
 public:
  static constexpr double kMostSqueezed = 0.4;  ///< of what two nodes of one body are apart at rest

  /// @param model  must outlive them
  Clips(const std::vector<StylusConfig>& styluses, const Model& model);

  RollBack rollBack() const override { return RollBack::kKeep; }
  void beginTick(const ProcessTick& tick) override;
  bool act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep) override;
  bool endTick(TissuePort& port, const ProcessTick& tick, const TissueProcesses& all) override;
  double work_j() const override { return work_j_; }
  void reset() override;
  void persist(Archive& archive) override;
  bool addTo(StateHash& hash) const override;
  FactGroup facts() const override;
  void draw(ProcessLook& look) const override;

  /// From side to side at rest, each in the frame of its body's rest, of all that clips hold together [m].
  std::vector<std::array<Vector3d, 2>> squeezed_m() const;
  SeenClips seen() const;

 private:
  void set(const TissuePort& port);
  void hold(double dt_s);
  std::vector<Vector3d> places_m(size_t clip) const;
  /// A node on each side.
  struct Pair {
    uint32_t body_a, a, body_b, b;  ///< slots of the bodies
    double least_m;                 ///< they come no nearer
    Vector3d set_a_m, set_b_m;      ///< where they were when it was set, and
    Vector3d now_a_m, now_b_m;      ///< are
  };
  struct Clip {
    uint32_t stylus = 0;
    std::array<Vector3d, 2> leg_m;        ///< both ends of its middle line when it was set, tissue frame
    Vector3d across = Vector3d::UnitX();  ///< from side to side, then
    double force_n = 0;                   ///< of the last substep
    std::vector<Pair> pairs;
    std::vector<std::array<TissuePoint, 2>> points;  ///< [pairs], follow from them
  };
  /// A node near jaws.
  struct Near {
    uint32_t body, slot;
    Vector3d at_m, in_jaws_m;
  };
  std::vector<Near> nodesIn(const TissuePort& port, const Pose& jaws, const ClipConfig& config) const;
  Pair pairOf(const Near& a, const Near& b, const ClipConfig& config) const;
  bool add(uint32_t stylus, const Pose& jaws, const ClipConfig& config, const std::vector<Near>& nodes);
  void findPoints(Clip& clip) const;

  const std::vector<StylusConfig> styluses_;
  const Model& model_;
  double spacing_m_;
  TissuePoints points_;
  ThreadBlades blades_;
  std::array<Pose, layout::kMaxStyluses> jaws_;
  std::array<bool, layout::kMaxStyluses> closed_{}, closes_{};  ///< before this tick; in it
  std::array<int, layout::kMaxStyluses> used_{};
  std::vector<Clip> clips_;
  uint64_t empty_ = 0, taken_off_ = 0;
  double work_j_ = 0;  ///< on the tissue, in the tick
};

}  // namespace viscera
