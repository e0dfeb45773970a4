// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <crtk_msgs/CartesianImpedance.h>
#include <ros/time.h>

#include <string>

#include "nodes/hands/stylus_mailbox.h"
#include "viscera/haptics/haptic_servo.h"

namespace viscera::nodes {

/// The local model of a stylus for a device that closes the loop itself, as its driver has places and axes: through
/// base, axes, tip and scales, as forces are. z is the normal, out of the tissue. Of a probe there is a force below the
/// place where the model has none, and none above; across the normal it has neither stiffness nor force. A grip is held
/// both ways, with the diagonal of its stiffness in these axes. Where the newest pose of the hand would be given more
/// than the stylus and its device may, all shrinks by one factor. Nothing is felt by a hand that is not there, or has
/// the clutch.
/// @param most_n  largest force on the tip
crtk_msgs::CartesianImpedance toImpedance(const HapticServo& servo, const StylusMailbox& mailbox, double most_n,
                                          SteadyTime now, const ros::Time& stamp);
/// Nothing is felt.
crtk_msgs::CartesianImpedance noImpedance(const std::string& frame, const ros::Time& stamp);

}  // namespace viscera::nodes
