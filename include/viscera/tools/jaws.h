// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "viscera/tools/stylus.h"

namespace viscera {

class Archive;
struct Jaws;

/// Tissue between two fingers.
struct Between {
  double meets_rad;  ///< their opening at which both meet it
  double press_nm;   ///< the moment about the pivot with which it would resist if it were pressed flat
};
/// Looks for tissue between the fingers of a stylus. @param motion  its mode and where it is, `from`
/// @param mouth_rad  their opening   @returns nothing: there is none
using FeelTissue = std::function<std::optional<Between>(size_t stylus, const StylusMotion& motion, double mouth_rad)>;

/// The fingers of one stylus, tick by tick: how far a hand or a button has closed them, what keeps them apart, and how
/// far what they hold has slid in them (docs/lessons/clips.md).
class Fingers {
 public:
  /// Goes on by a tick. Sets the openings of the motion, and for fingers that grip its hold_begins and hold_ended.
  /// Those of a mode that has begun come from open to where a hand has them no faster than a button would close them.
  /// @param told_rad  StylusSample::jaw_rad   @param appears  the hand was not there before
  /// @param grips  they hold what they have met
  /// @param feel  tissue between them in this tick [mouth]; none: whatever there is, they have met it
  void advance(const Jaws& jaws, bool grips, float told_rad, bool appears, double tick_s,
               const std::function<std::optional<Between>(double)>& feel, StylusMotion& motion);
  /// What was measured of this tick: above the rated force what is held slides, so that the force is this.
  /// @param force_n  of the tissue on the tool, tissue frame
  void pulled(const StylusMotion& motion, const Vector3d& force_n, double rated_n);
  bool holds() const { return holds_; }
  /// Where what they hold is, as if it were held by a tool that has gone so far: by the end of the tick.
  Vector3d slid_m(const StylusMotion& motion) const { return motion.to.orientation * slid_m_; }
  /// The same motion of what they hold.
  StylusMotion ofHeld(const StylusMotion& motion) const;
  /// With which what is between them keeps them from closing as far as the hand would [N m].
  double moment_nm(const Jaws& jaws) const;
  void persist(Archive& archive);

 private:
  void letGo();
  double openingNow(const Jaws& jaws) const;

  double closed_ = 0;  ///< by how much of their opening a hand has closed them, 0 .. 1
  bool follows_ = false, closing_ = false, holds_ = false;
  double mouth_rad_ = 0;  ///< when this closing began
  double met_rad_ = 0, press_nm_ = 0;
  Vector3d taken_at_m_ = Vector3d::Zero();  ///< the tip when they took hold, tissue frame
  /// How far what they hold has slid, by the start and the end of the tick, in the stylus's frame.
  Vector3d slid_before_m_ = Vector3d::Zero(), slid_m_ = Vector3d::Zero();
};

}  // namespace viscera
