// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/processes/process.h"
#include "solver/processes/suture/suture_blades.h"
#include "solver/processes/tissue_points.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/solver/clip_state.h"
#include "viscera/tools/stylus.h"

namespace viscera {

/// Clips (docs/lessons/instruments.md): each holds two sides of tissue together, node by node, with impulses after each
/// substep that conserve linear and angular momentum. Blades that touch one remove it.
class Clips : public TissueProcess {
 public:
  static constexpr double kMostSqueezed = 0.4;  ///< least share of the rest distance of two nodes of one body

  /// @param model  must outlive them   @param hollow  [bodies] vessels with a lumen, which clips press flat; empty:
  /// none
  Clips(const std::vector<StylusConfig>& styluses, const Model& model, std::vector<uint8_t> hollow = {});

  RollBack rollBack() const override { return RollBack::kKeep; }
  void beginTick(const ProcessTick& tick) override;
  bool act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep) override;
  bool endTick(TissuePort& port, const ProcessTick& tick, const TissueProcesses& all) override;
  double work_j() const override { return work_j_; }
  void reset() override;
  void persist(Archive& archive) override;
  bool addTo(StateHash& hash) const override;
  FactGroup facts() const override;
  void draw(ProcessVisuals& visuals) const override;

  /// Returns the vectors from side to side at rest, each in the rest frame of its body, of everything that clips hold
  /// together [m].
  std::vector<std::array<Vector3d, 2>> squeezed_m() const;
  /// What a clip holds together: as squeezed_m(), with where it is.
  struct Squeezed {
    uint32_t clip = 0;  ///< number of the clip
    std::array<uint32_t, 2> bodies{};
    std::array<Vector3d, 2> ends_m;
  };
  std::vector<Squeezed> squeezed() const;
  ClipStates seen() const;

 private:
  void set(const TissuePort& port);
  void hold(double dt_s);
  std::vector<Vector3d> positions_m(size_t clip) const;
  /// A node on each side.
  struct Pair {
    uint32_t body_a, a, body_b, b;  ///< slots in the bodies
    double least_m;                 ///< least distance
    Vector3d set_a_m, set_b_m;      ///< positions when it was set, and
    Vector3d now_a_m, now_b_m;      ///< now
  };
  struct Clip {
    uint32_t stylus = 0;
    std::array<Vector3d, 2> leg_m;        ///< both ends of its middle line when it was set, tissue frame
    Vector3d across = Vector3d::UnitX();  ///< direction from side to side when it was set
    double force_n = 0;                   ///< force of the last substep
    std::vector<Pair> pairs;
    std::vector<std::array<TissuePoint, 2>> points;  ///< [pairs], derived from them
  };
  /// A node near jaws.
  struct Near {
    uint32_t body, slot;
    Vector3d at_m, in_jaws_m;
  };
  std::vector<Near> nodesIn(const TissuePort& port, const Pose& jaws, const ClipConfig& config) const;
  double tissueBetween_m(const Body& body, uint32_t a, uint32_t b) const;
  Pair pairOf(const Near& a, const Near& b, const ClipConfig& config) const;
  bool add(uint32_t stylus, const Pose& jaws, const ClipConfig& config, const std::vector<Near>& nodes);
  void findPoints(Clip& clip) const;

  const std::vector<StylusConfig> styluses_;
  const Model& model_;
  const std::vector<uint8_t> hollow_;  ///< [bodies]; empty: none is
  double spacing_m_;
  TissuePoints points_;
  SutureBlades blades_;
  std::array<Pose, layout::kMaxStyluses> jaws_;
  std::array<bool, layout::kMaxStyluses> closed_{}, closes_{};  ///< jaws closed before this tick; jaws that close in it
  std::array<int, layout::kMaxStyluses> used_{};
  std::vector<Clip> clips_;
  uint64_t empty_ = 0, taken_off_ = 0;
  double work_j_ = 0;  ///< work on the tissue in the tick
};

}  // namespace viscera
