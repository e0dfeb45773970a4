// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "solver/processes/pressure/cavities.h"
#include "solver/processes/pressure/surface_loads.h"
#include "solver/processes/process.h"
#include "viscera/model/model.h"

namespace viscera {

struct Scene;
class HeatField;

/// Pressure in cavities of bodies (docs/physics.md 18): it pushes on their walls, and falls where they are cut open or
/// clips part them from their supply.
class Pressures : public TissueProcess {
 public:
  /// Blood that leaves a vessel at a node.
  struct Leak {
    uint32_t slot = 0;  ///< in the solver's buffers
    double m3_per_s = 0;
  };

  /// @param model  must outlive it   @throws SceneError  as cavitiesOf()
  Pressures(const Scene& scene, const Model& model);

  RollBack rollBack() const override { return RollBack::kKeep; }
  bool readsCuts() const override { return true; }
  void cutsChanged(const CutSprings& cuts) override;
  void beginTick(const ProcessTick& tick) override;
  bool act(TissuePort& port, const ProcessTick& tick, const ProcessSubstep& substep) override;
  bool endTick(TissuePort& port, const ProcessTick& tick, const TissueProcesses& all) override;
  double work_j() const override { return work_j_; }
  void reset() override;
  void persist(Archive& archive) override;
  bool addTo(StateHash& hash) const override;
  FactGroup facts() const override;

  /// Returns whether blood of a slot's body flows as this process says.
  bool owns(uint32_t slot) const;
  /// Returns where bodies that bleed lose blood.
  const std::vector<Leak>& leaks() const { return leaks_; }
  /// Returns the number of stations where they do.
  size_t openStations() const { return open_; }
  const SurfaceLoads& loads() const { return loads_; }

 private:
  struct Vessel {
    std::string name;
    uint32_t body = 0;
    PressureConfig pressure;
    bool bleeds = false;
    std::vector<std::vector<uint32_t>> triangles;  ///< [stations] triangles, of all surfaces
    std::vector<double> rest_m3;                   ///< [stations] volume at rest, of the sectors around their middles
    double source_pa = 0;
    std::vector<double> share;      ///< [stations] pressure over that of the source
    std::vector<double> narrowing;  ///< [stations]
    LumenNetwork::Openings at;
    LumenNetwork::Flow flow;
    double cavity_m3 = 0;
  };
  double sector_m3(const Vessel& vessel, size_t station) const;
  void measure(Vessel& vessel, size_t number);
  void seal(Vessel& vessel, const HeatField& heat) const;
  void flow(Vessel& vessel, size_t number);
  void addLeaks(const Vessel& vessel);
  bool isCut(const TissuePoint& cell, const CutSprings& cuts) const;
  bool isGone(const TissuePoint& cell, const CutSprings& cuts) const;
  void setPressures();

  const Model& model_;
  const double tick_s_;
  std::vector<Cavities> surfaces_;  ///< [vessels]
  std::vector<RestElements> elements_;
  std::vector<TissuePoint> cells_;     ///< [vertices] points that carry them while nothing is cut; centres: none
  std::vector<TissuePoint> carriers_;  ///< [vertices] points that carry them now
  SurfaceLoads loads_;
  std::vector<Vessel> vessels_;
  std::vector<double> rest_area_m2_;               ///< [triangles]
  std::vector<uint8_t> vertex_is_cut_, is_cut_;    ///< [vertices], [triangles]
  std::vector<uint8_t> vertex_is_gone_, is_gone_;  ///< the same, whether the tissue at them is erased
  std::vector<layout::NodeBits> seen_;             ///< [slots] nodes when vertices were carried; empty: whole
  std::vector<Leak> leaks_;
  size_t open_ = 0;
  double time_s_ = 0, work_j_ = 0;
};

}  // namespace viscera
