// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "devices/device_profile.h"
#include "nodes/ros/parameters.h"

namespace viscera::nodes {

/// `polhemus:2`: a profile and, after a colon, the driver's name.
void setProfile(DeviceChoice& choice, const std::string& text);

/// Which device each stylus has, as the parameters say:
/// * `~devices`: `left=polhemus:2`, a profile and, after a colon, the driver's name; by default every stylus has `crtk`
/// * `~device_options`: `left.scale=0.5`, a key of the profile
/// * `~registrations`: `left=/path/to/file.yaml`
class DeviceChoices {
 public:
  /// @throws ParameterError  not as above
  static DeviceChoices read(Parameters& parameters);

  /// @param package_folder  where config/devices/<profile>.yaml are looked up
  /// @returns [styluses]
  /// @throws ParameterError, DeviceError, RegistrationError
  std::vector<DeviceProfile> load(const std::vector<StylusConfig>& styluses, const std::string& package_folder) const;
  /// @throws ParameterError  a stylus was named that is none of these
  void requireKnown(const std::vector<StylusConfig>& styluses) const;

 private:
  DeviceChoice& of(const std::string& stylus, const std::string& parameter);
  struct Named {
    DeviceChoice choice;
    std::string parameter;  ///< that named it first
  };
  std::vector<Named> named_;
};

}  // namespace viscera::nodes
