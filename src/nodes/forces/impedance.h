// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crtk_msgs/CartesianImpedance.h>
#include <ros/time.h>

#include <string>

#include "nodes/input/stylus_mailbox.h"
#include "viscera/haptics/haptic_servo.h"

namespace viscera::nodes {

/// Returns the local contact model of a stylus as an impedance, for a device that closes the loop itself. The impedance
/// is in the units and axes of the driver: base, axes, tip and scales are applied as they are to forces. z is the
/// normal, out of the tissue.
/// A probe feels a force only below the position where the model's force is zero, and none across the normal. A grip is
/// held in both directions, with the diagonal of its stiffness in these axes. If the newest pose would give more force
/// than the limit of the stylus and its device, one factor scales everything down. The impedance is zero if the stylus
/// is not tracked or its clutch is pressed.
/// @param most_n  largest force on the tip [N]
crtk_msgs::CartesianImpedance toImpedance(const HapticServo& servo, const StylusMailbox& mailbox, double most_n,
                                          SteadyTime now, const ros::Time& stamp);
/// Returns an impedance that exerts no force.
crtk_msgs::CartesianImpedance noImpedance(const std::string& frame, const ros::Time& stamp);

}  // namespace viscera::nodes
