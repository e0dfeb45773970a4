// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Colours of a strain, dark for none and bright for the end of the scale: evenly spaced to the eye, and in grey too.

/// @param share  of the scale, 0..1; beyond it the ends. sRGB.
vec3 strainColor(float share) {
  const vec3 stops[5] = vec3[5](vec3(0.267, 0.005, 0.329), vec3(0.229, 0.322, 0.546), vec3(0.128, 0.567, 0.551),
                                vec3(0.369, 0.789, 0.383), vec3(0.993, 0.906, 0.144));
  float at = 4.0 * clamp(share, 0.0, 1.0);
  int low = min(int(at), 3);
  return mix(stops[low], stops[low + 1], at - float(low));
}
