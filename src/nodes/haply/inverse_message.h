// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>

#include "viscera/math/error.h"
#include "viscera/math/types.h"

namespace viscera::nodes {

// Messages of the Haply Inverse Service 3.5 on its simulation channel, and of 3.1, as docs.haply.co/inverseSDK
// describes them (Simulation Channel, WebSocket Protocol, Basis Permutation). The service begins with an inventory of
// its devices, and answers each message of a client with one state of all devices. Metres, newtons, x right, y forward,
// z up. Service 3.5 sends a session_id; a force is then a `vector`, otherwise `values`.

/// Error for a message of the service that cannot be used. Names the field and what is accepted.
struct InverseError : Error {
  using Error::Error;
};

/// Devices that a connection uses, from the inventory.
struct InverseDevices {
  std::string device, grip;       ///< identifiers; empty grip: none
  std::string description;        ///< of the device, for the user
  bool has_session = false;       ///< whether the service is 3.5 or later
  bool watches_for_grip = false;  ///< whether a grip that comes later is to be used
};

/// State of a device and its grip.
struct InverseState {
  Vector3d position_m = Vector3d::Zero(), velocity_m_per_s = Vector3d::Zero();
  std::optional<Quaterniond> grip;  ///< orientation of the grip: its +y points away from the user
  std::array<bool, 3> buttons{};    ///< a, b, c
  std::string grip_came;            ///< identifier of a grip that has come, which the inventory did not have
  bool calibrated = true;
};

/// Chooses the devices of a connection.
/// @param inventory  first message of the service
/// @param device     `any`, `left` or `right` for the handedness, or an identifier
/// @param grip       `any`, `none`, or an identifier
/// @throws InverseError  no JSON, or no such device or grip; lists those that are there
InverseDevices chooseDevices(const std::string& inventory, const std::string& device, const std::string& grip);

/// Reads a state. @throws InverseError  no JSON, the device or its grip is missing, or a number is missing or not
/// finite
InverseState readState(const std::string& message, const InverseDevices& devices);

/// Returns the message that sets the force, to which the service answers.
/// @param first  first message of a connection, which also names the client
std::string forceCommand(const InverseDevices& devices, const Vector3d& force_n, bool first);

}  // namespace viscera::nodes
