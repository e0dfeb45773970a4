// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera {

/// Shape of one gallbladder and of the tissue around it, in millimetres for a gallbladder of 80 mm
/// (docs/user_guide.md).
struct GallbladderVariant {
  bool short_duct = false;
  bool artery_in_front = false;  ///< the right hepatic artery passes in front of the common hepatic duct
  bool two_arteries = false;
  bool inflamed = false;  ///< thick wall, and fat that covers the duct and the artery
  double width = 1;       ///< factor on the radii of the gallbladder
  double duct_radius = 1.75;
  double artery_radius = 1;
  double junction_z = -42;  ///< height of the junction of the ducts; the neck is at -25
};

/// Returns a variant: 0 is the usual anatomy, 1 to 4 are one feature each, in the order of the struct; larger seeds
/// draw features and sizes. One seed gives one variant on every machine.
GallbladderVariant gallbladderVariant(int seed);

}  // namespace viscera
