// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "viscera/api.h"
#include "viscera/tools/stylus.h"

namespace viscera {  // internal
class Archive;
struct Jaws;
}  // namespace viscera

namespace VISCERA_PUBLIC viscera {

/// Tissue between two jaws.
struct Between {
  double meets_rad;  ///< opening of the jaws at which both meet it [rad]
  double press_nm;   ///< moment about the pivot with which it would resist being pressed flat [N m]
};
/// Looks for tissue between the jaws of a stylus. @param motion  its mode, and its pose `from`
/// @param mouth_rad  opening of the jaws   @returns nothing where there is no tissue
using FeelTissue = std::function<std::optional<Between>(size_t stylus, const StylusMotion& motion, double mouth_rad)>;

/// Jaws of one stylus, tick by tick: how far the user or a button has closed them, what keeps them apart, and how far
/// the held tissue has slid (docs/lessons/instruments.md).
class VISCERA_PUBLIC Gripper {
 public:
  /// Advances by a tick. Sets the openings of the motion and, for jaws that grip, its hold_begins and hold_ended. In a
  /// mode that has just begun, jaws move from open to the opening of the device no faster than a button would close
  /// them.
  /// @param angle_rad  StylusSample::jaw_rad   @param appears  the stylus was not present before
  /// @param grips  the jaws hold what they have met
  /// @param feel  finds tissue between them in this tick by their opening [rad]; none: they have always met tissue
  void advance(const Jaws& jaws, bool grips, float angle_rad, bool appears, double tick_s,
               const std::function<std::optional<Between>(double)>& feel, StylusMotion& motion);
  /// Applies the force of this tick: above the rated force the held tissue slides, until the force equals it.
  /// @param force_n  of the tissue on the tool, tissue frame
  void pulled(const StylusMotion& motion, const Vector3d& force_n, double rated_n);
  bool holds() const { return holds_; }
  /// Returns how far the held tissue has slid by the end of the tick [m], tissue frame.
  Vector3d slid_m(const StylusMotion& motion) const { return motion.to.orientation * slid_m_; }
  /// Returns the motion of the held tissue.
  StylusMotion ofHeld(const StylusMotion& motion) const;
  /// Returns the moment with which the tissue keeps the jaws from closing as far as the user would [N m].
  double moment_nm(const Jaws& jaws) const;
  void persist(Archive& archive);

 private:
  void letGo();
  double openingNow(const Jaws& jaws) const;

  double closed_ = 0;  ///< share of their opening by which the user has closed them, 0 .. 1
  bool follows_ = false, closing_ = false, holds_ = false;
  double mouth_rad_ = 0;  ///< opening when this closing began [rad]
  double met_rad_ = 0, press_nm_ = 0;
  Vector3d taken_at_m_ = Vector3d::Zero();  ///< position of the tip when they took hold, tissue frame [m]
  /// Distance that the held tissue has slid by the start and the end of the tick [m], in the stylus's frame.
  Vector3d slid_before_m_ = Vector3d::Zero(), slid_m_ = Vector3d::Zero();
};

}  // namespace viscera
