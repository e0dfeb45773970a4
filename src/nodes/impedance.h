// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/time.h>

#include <string>

#include "nodes/foreign/crtk_cartesian_impedance.h"
#include "viscera/haptics/haptic_servo.h"

namespace viscera::nodes {

/// The local model of a stylus for a device that closes the loop itself, tissue frame. z is the normal, out of the
/// tissue. Of a probe there is a force below the place where the model has none, and none above; across the normal it
/// has neither stiffness nor force. A grip is held both ways, with the diagonal of its stiffness in these axes.
foreign::CartesianImpedance toImpedance(const HapticServo& servo, const std::string& frame, const ros::Time& stamp);
/// Nothing is felt.
foreign::CartesianImpedance noImpedance(const std::string& frame, const ros::Time& stamp);

}  // namespace viscera::nodes
