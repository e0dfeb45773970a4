// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "devices/device_profile.h"
#include "nodes/ros/parameters.h"

namespace viscera::nodes {

/// Sets profile and driver name from a text such as `polhemus:2`, separated by a colon.
void setProfile(DeviceChoice& choice, const std::string& text);

/// The device of each stylus, as the parameters choose it:
/// * `~devices`: `left=polhemus:2`, a profile and, after a colon, the driver's name; `crtk` by default
/// * `~device_options`: `left.scale=0.5`, a key of the profile
/// * `~registrations`: `left=/path/to/file.yaml`
class DeviceChoices {
 public:
  /// Reads the parameters. @throws ParameterError  the format differs from the one above
  static DeviceChoices read(Parameters& parameters);

  /// Loads the profiles. @param package_folder  folder with config/devices/<profile>.yaml
  /// @returns [styluses]
  /// @throws ParameterError, DeviceError, RegistrationError
  std::vector<DeviceProfile> load(const std::vector<StylusConfig>& styluses, const std::string& package_folder) const;
  /// Checks the names of styluses. @throws ParameterError  a named stylus is not among these
  void requireKnown(const std::vector<StylusConfig>& styluses) const;

 private:
  DeviceChoice& of(const std::string& stylus, const std::string& parameter);
  struct Named {
    DeviceChoice choice;
    std::string parameter;  ///< parameter that named the stylus first
  };
  std::vector<Named> named_;
};

}  // namespace viscera::nodes
