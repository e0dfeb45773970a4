// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "solver/processes/suture/chain/chain_knots.h"
#include "solver/processes/suture/chain/chain_run.h"

namespace viscera {

/// A channel: a point of tissue through which the chain slides (docs/thread.md 4).
struct ChainSlide {
  double s = 0;                      ///< kept: where on the chain the point is [links], 0 to nodes - 1
  double between_rest_m = 0;         ///< to the next channel of the chain in the tissue at rest; 0: it is the last
  Vector3d to_m = Vector3d::Zero();  ///< where the tissue's point is at the end of the substep, by all impulses so far
  double mass_kg = kRigidMass_kg;    ///< that the tissue shows
  double friction = 0;               ///< of the channel's wall, as of a rope on a drum
  double through_n = 0;              ///< friction of the length of thread that is in tissue, whatever presses
  double most_n = std::numeric_limits<double>::infinity();  ///< the tissue tears at more
  /// Out: of the substep so far, on the tissue. In: with what it begins, the last substep's for few iterations, or 0;
  /// the first answer is asked for before the first iteration and gives it.
  Vector3d impulse_ns = Vector3d::Zero();
  Vector3d torn_m = Vector3d::Zero();   ///< out: by which the thread was torn through the tissue
  double rub_kg = 0;                    ///< kept from substep to substep: friction over what slid along
  double stiffness_kg = kRigidMass_kg;  ///< kept: across
  bool out = false;                     ///< out: an end of the chain has passed it; from then on it does nothing
};

/// The channels of a chain in a substep under way. Each is held across with a memory of what it needed, is moved along
/// the chain by what it slid, and rubs by its limit over that; one that does not slide is held all round.
class ChainSlides {
 public:
  /// @param swaged  first and last end: nothing slides off there   @param knots  of the chain: nothing passes them
  void begin(const ChainShape& shape, const std::array<bool, 2>& swaged, const std::vector<ChainKnot>& knots,
             std::vector<ChainSlide>& slides);
  /// Into a system that is to be solved.
  void set(const ChainShape& shape, const std::vector<ChainSlide>& slides, ChainMatrix& matrix,
           std::vector<ChainMatrix::Unknown>& rest);
  /// What the system that was just solved gave, and how it goes on. @returns whether it must be solved again
  /// @param frozen  none begins to hold, slide or tear   @param runs  those that slide go on along the chain
  bool heed(const ChainShape& shape, bool frozen, bool runs, std::vector<ChainSlide>& slides);
  /// Of all channels from where their tissue is, but for what slides and tears.
  double farthestOff_m(const ChainShape& shape, const std::vector<ChainSlide>& slides) const;
  /// After the last iteration.
  void end(const ChainShape& shape, std::vector<ChainSlide>& slides) const;

 private:
  Vector3d impulse(const ChainSlide& slide, const ChainRun& run, const Vector3d& off_m, double dt_s) const;
  bool change(const ChainShape& shape, const Vector3d& off_m, ChainSlide& slide, const ChainRun& run) const;

  std::vector<ChainRun> runs_;
};

}  // namespace viscera
