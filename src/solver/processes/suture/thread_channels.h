// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/processes/suture/chain/chain.h"
#include "solver/processes/tissue_points.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/thread_config.h"

namespace viscera {

class Archive;

/// How tissue holds a thread that goes through it (docs/thread.md 5).
struct ChannelLaw {
  double friction = 0, through_n_per_m = 0, pull_out_n = 0;
};
ChannelLaw channelLawOf(const ThreadConfig& config, const Body& body);

/// The channels of one thread, beside its ChainAround::slides, which are in the same order: points of tissue, and what
/// the thread gives them in a substep.
class ThreadChannels {
 public:
  /// Those that a scene has at the start. @throws SceneError  names the channel
  void lay(const ThreadConfig& config, const Chain& chain, const Model& model, const TissuePoints& points,
           std::vector<ChainSlide>& slides);
  /// One more before all others: what a needle on the chain's start has come through.
  /// @param goes_on  it came there in tissue, unless a wound lies between   @param s  on the chain
  void take(const TissuePoint& point, bool goes_on, const ChannelLaw& law, double s, const TissuePoints& points,
            std::vector<ChainSlide>& slides);
  bool empty() const { return channels_.empty(); }
  /// Is the chain in tissue there? @param s  on the chain
  bool hides(double s, const std::vector<ChainSlide>& slides) const;
  void addPoints(std::vector<const TissuePoint*>& points) const;
  std::vector<const TissuePoint*> outer() const;  ///< the first and the last
  /// Before a substep of the chain.
  void begin(const TissuePoints& points, std::vector<ChainSlide>& slides);
  /// ChainAround::answer in it.
  void answer(TissuePoints& points, double dt_s, std::vector<ChainSlide>& slides);
  /// After a substep of the chain.
  void note(const std::vector<ChainSlide>& slides);
  /// After a substep of the tissue: rest points move where tissue has torn, and springs are cut behind them.
  /// @param can_cut  the target has what it takes   @param link_m  of the chain   @returns whether some were
  bool end(const TissuePoints& points, TissuePort& target, bool can_cut, double link_m,
           std::vector<ChainSlide>& slides);
  /// Springs were cut.
  void embedAgain(const TissuePoints& points, std::vector<ChainSlide>& slides);
  void clear() { channels_.clear(); }
  /// The chain is parted behind the first so many. @returns those behind
  ThreadChannels part(size_t before);
  void persist(Archive& archive);

 private:
  struct Channel {
    TissuePoint point;
    Vector3d cut_m = Vector3d::Zero();     ///< up to where, at rest, springs are cut
    Vector3d given_ns = Vector3d::Zero();  ///< of the substep
    Vector3d torn_m = Vector3d::Zero();    ///< of the tissue's substep
    double mass_kg = 0;                    ///< that the tissue shows
    uint32_t through = 0;                  ///< between it and the next one there is tissue
  };
  void renew(const TissuePoints& points, std::vector<ChainSlide>& slides);
  /// @returns whether the channel is still in tissue
  bool tear(Channel& channel, const TissuePoints& points, const TissuePort& target);
  void cutBehind(size_t k, const Vector3d& to_m, TissuePort& target);
  void erase(size_t k, std::vector<ChainSlide>& slides);
  /// Two that are side by side on the chain and nearer than it can tell apart are one.
  void joinTorn(size_t k, double link_m, std::vector<ChainSlide>& slides);

  std::vector<Channel> channels_;
  bool changed_ = true;  ///< since masses were found
};

}  // namespace viscera
