// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

/// An organ as a map of coordinates to places: s along it, up to 1 where it is held, f around it [radians], t across
/// its wall from the inside at 0 to the outside at 1. bench/references/walls.py has the same maps.
struct Organ {
  const char* name;
  const char* what;  ///< for a table's title
  double wall_m;
  Vector3d load;  ///< direction of gravity
  FixedConfig clamp;
  std::function<Vector3d(double s, double f, double t)> place;  ///< [m]; none: the block of two materials
  double s_low = 0, f_low = -M_PI, f_high = M_PI;               ///< ranges; f goes all round or has two ends
  bool pole = true;                                             ///< at s_low all f are one place; else an open end
};

/// Returns the organs, bowl first.
const std::vector<Organ>& organs();
constexpr size_t kOrgans = 7;

/// An OBJ file that is there as long as this is.
class OrganFile {
 public:
  /// Writes the organ's closed surface in triangles with edges of about 1.5 mm; parts `soft` and `stiff` of the block.
  /// @throws Error  it cannot be written
  explicit OrganFile(const Organ& organ);
  ~OrganFile();
  OrganFile(const OrganFile&) = delete;
  OrganFile& operator=(const OrganFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace viscera::bench
