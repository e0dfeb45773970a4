// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "solver/processes/suture/chain/chain_knots.h"
#include "solver/processes/suture/chain/chain_run.h"

namespace viscera {

/// A channel: a point of tissue through which the chain slides (docs/physics.md 14).
struct ChainSlide {
  double s = 0;               ///< kept: position of the point on the chain [links], 0 to nodes - 1
  double between_rest_m = 0;  ///< distance to the next channel of the chain in the tissue at rest; 0: it is the last
  Vector3d to_m = Vector3d::Zero();  ///< position of the tissue's point at the end of the substep, so far
  double mass_kg = kRigidMass_kg;    ///< effective mass of the tissue
  double friction = 0;               ///< coefficient of friction of the channel's wall, as of a rope on a drum
  double through_n = 0;              ///< friction of the length of suture in tissue, independent of the normal force
  double most_n = std::numeric_limits<double>::infinity();  ///< force at which the tissue tears
  /// Out: impulse of the substep so far on the tissue. In: initial guess, that of the last substep for few iterations,
  /// or 0; the first answer is requested before the first iteration and returns it.
  Vector3d impulse_ns = Vector3d::Zero();
  Vector3d torn_m = Vector3d::Zero();   ///< out: displacement by which the suture was torn through the tissue
  double rub_kg = 0;                    ///< kept from substep to substep: friction over the slip
  double stiffness_kg = kRigidMass_kg;  ///< kept: stiffness across
  bool out = false;                     ///< out: an end of the chain has passed it; it has no effect from then on
};

/// The channels of a chain in the current substep. Each holds the chain across by a stiffness that is kept between
/// substeps, moves along the chain by the slip, and has friction equal to its limit over the slip. A channel that does
/// not slide holds in all directions.
class ChainSlides {
 public:
  /// @param swaged  first and last end: nothing slides off there   @param knots  of the chain: channels do not pass
  /// them
  void begin(const ChainShape& shape, const std::array<bool, 2>& swaged, const std::vector<ChainKnot>& knots,
             std::vector<ChainSlide>& slides);
  /// Adds the channels to the system before it is solved.
  void set(const ChainShape& shape, const std::vector<ChainSlide>& slides, ChainMatrix& matrix,
           std::vector<ChainMatrix::Unknown>& rest);
  /// Updates the channels with the solution of the system. @returns whether it must be solved again
  /// @param frozen  none starts to hold, slide or tear   @param runs  sliding channels move along the chain
  bool update(const ChainShape& shape, bool frozen, bool runs, std::vector<ChainSlide>& slides);
  /// Returns the largest offset of a channel from its tissue, without slip and tearing.
  double farthestOff_m(const ChainShape& shape, const std::vector<ChainSlide>& slides) const;
  /// Finishes after the last iteration.
  void end(const ChainShape& shape, std::vector<ChainSlide>& slides) const;

 private:
  Vector3d impulse(const ChainSlide& slide, const ChainRun& run, const Vector3d& off_m, double dt_s) const;
  bool change(const ChainShape& shape, const Vector3d& off_m, ChainSlide& slide, const ChainRun& run) const;

  std::vector<ChainRun> runs_;
};

}  // namespace viscera
