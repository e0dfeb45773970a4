// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/registration.h"

namespace viscera {

/// The result of `register_stylus`: a fragment of a device's profile, with the keys `tip`, `base`, `residual_mm`.
struct RegistrationFile {
  std::optional<Vector3d> tip_m;  ///< offset of the tip in the frame of the device's pose
  std::optional<Pose> base;       ///< pose of the frame of the device's poses, in the tissue frame
  double residual_m = 0;          ///< residual of the last result [m]
};

std::string registrationYaml(const RegistrationFile& registration);
/// Writes a registration; loadRegistration() reads one.
/// @throws RegistrationError  it cannot be written, or the fragment is invalid: names file, line and key
void saveRegistration(const RegistrationFile& registration, const std::string& path);
RegistrationFile loadRegistration(const std::string& path);
RegistrationFile parseRegistration(const std::string& yaml, const std::string& name);

/// Reads the known points of a YAML file, `points: [{name: apex, position_m: [0, -0.03, 0.01]}, ...]`, in the order of
/// touching.
/// @throws RegistrationError  names file, line and key; fewer than kLeastPoints
std::vector<KnownPoint> loadKnownPoints(const std::string& path);
std::vector<KnownPoint> parseKnownPoints(const std::string& yaml, const std::string& name);

}  // namespace viscera
