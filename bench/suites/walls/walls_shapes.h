// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "viscera/math/types.h"
#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

/// An organ as a map from coordinates to positions: s along it, up to 1 at its fixed end, f around it [radians], t
/// across its wall from 0 at the inside to 1 at the outside. bench/references/walls.py has the same maps.
struct Organ {
  const char* name;
  const char* what;  ///< title of a table
  double wall_m;
  Vector3d load;  ///< direction of gravity
  FixedConfig clamp;
  std::function<Vector3d(double s, double f, double t)> position;  ///< [m]; empty: the block of two materials
  double s_low = 0, f_low = -M_PI, f_high = M_PI;                  ///< ranges; f is periodic or has two ends
  bool pole = true;  ///< whether all f coincide at s_low; else an open end
};

/// Returns the organs, bowl first.
const std::vector<Organ>& organs();
constexpr size_t kOrgans = 7;

/// A temporary OBJ file, removed with this object.
class OrganFile {
 public:
  /// Writes the organ's closed surface as triangles with edges of about 1.5 mm; parts `soft` and `stiff` for the block.
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
