// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/processes/suture/chain/chain.h"
#include "solver/processes/tissue_points.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/suture_config.h"

namespace viscera {

class Archive;

/// How tissue holds a suture that passes through it (docs/physics.md 15).
struct TrackLaw {
  double friction = 0, through_n_per_m = 0, pull_out_n = 0;
};
TrackLaw trackLawOf(const SutureConfig& config, const Body& body);

/// The channels of one suture, in the same order as its ChainAround::slides: points of tissue, and the suture's
/// impulses on them in a substep.
class SutureTracks {
 public:
  /// Makes the channels that a scene specifies at the start. @throws SceneError  names the channel
  void lay(const SutureConfig& config, const Chain& chain, const Model& model, const TissuePoints& points,
           std::vector<ChainSlide>& slides);
  /// Inserts a channel before all others, at a point that a needle at the chain's start has passed.
  /// @param goes_on  it came there through tissue, not across a wound   @param s  position on the chain
  void take(const TissuePoint& point, bool goes_on, const TrackLaw& law, double s, const TissuePoints& points,
            std::vector<ChainSlide>& slides);
  bool empty() const { return tracks_.empty(); }
  /// Returns whether the chain is in tissue there. @param s  position on the chain
  bool hides(double s, const std::vector<ChainSlide>& slides) const;
  void addPoints(std::vector<const TissuePoint*>& points) const;
  std::vector<const TissuePoint*> outer() const;  ///< the first and the last
  /// Prepares a substep of the chain.
  void begin(const TissuePoints& points, std::vector<ChainSlide>& slides);
  /// Implements ChainAround::answer in it.
  void answer(TissuePoints& points, double dt_s, std::vector<ChainSlide>& slides);
  /// Records the result after a substep of the chain.
  void record(const std::vector<ChainSlide>& slides);
  /// Finishes a substep of the tissue: rest points move where tissue has torn, and springs are cut behind them.
  /// @param can_cut  the target supports cuts   @param link_m  link length of the chain   @returns whether springs were
  /// cut
  bool end(const TissuePoints& points, TissuePort& target, bool can_cut, double link_m,
           std::vector<ChainSlide>& slides);
  /// Finds the points again after springs were cut.
  void embedAgain(const TissuePoints& points, std::vector<ChainSlide>& slides);
  void clear() { tracks_.clear(); }
  /// Splits the channels where the chain is cut, behind the given number. @returns the channels behind
  SutureTracks part(size_t before);
  void persist(Archive& archive);

 private:
  struct Track {
    TissuePoint point;
    Vector3d cut_m = Vector3d::Zero();     ///< position at rest up to which springs are cut
    Vector3d given_ns = Vector3d::Zero();  ///< impulse in the substep of the chain
    Vector3d torn_m = Vector3d::Zero();    ///< displacement torn in the tissue's substep
    double mass_kg = 0;                    ///< effective mass of the tissue
    uint32_t through = 0;                  ///< 1: there is tissue between it and the next one
  };
  void renew(const TissuePoints& points, std::vector<ChainSlide>& slides);
  /// Tears a channel through the tissue. @returns whether the channel is still in tissue
  bool tear(Track& track, const TissuePoints& points, const TissuePort& target);
  void cutBehind(size_t k, const Vector3d& to_m, TissuePort& target);
  void erase(size_t k, std::vector<ChainSlide>& slides);
  /// Joins two channels that are next to each other on the chain and closer than it can resolve.
  void joinTorn(size_t k, double link_m, std::vector<ChainSlide>& slides);

  std::vector<Track> tracks_;
  bool changed_ = true;  ///< since masses were computed
};

}  // namespace viscera
