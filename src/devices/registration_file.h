// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/registration.h"

namespace viscera {

/// What `register_stylus` has found out: a fragment of a device's profile, with the keys `tip`, `base`, `residual_mm`.
struct RegistrationFile {
  std::optional<Vector3d> tip_m;  ///< offset of the tip in the frame of the device's pose
  std::optional<Pose> base;       ///< the frame of the device's poses, in the tissue frame
  double residual_m = 0;          ///< of what was found last
};

std::string registrationYaml(const RegistrationFile& registration);
/// @throws RegistrationError  it cannot be written, or is an unknown fragment: file, line, key
void saveRegistration(const RegistrationFile& registration, const std::string& path);
RegistrationFile loadRegistration(const std::string& path);
RegistrationFile parseRegistration(const std::string& yaml, const std::string& name);

/// The known points of a YAML file, `points: [{name: apex, position_m: [0, -0.03, 0.01]}, ...]`, in the order in which
/// they are touched.
/// @throws RegistrationError  file, line and key; fewer than kLeastPoints
std::vector<KnownPoint> loadKnownPoints(const std::string& path);
std::vector<KnownPoint> parseKnownPoints(const std::string& yaml, const std::string& name);

}  // namespace viscera
