// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Colours of a strain, from blue for none to yellow for the end of the scale: perceptually even, and in grey too.
// Tissue without strain stays brighter than a dark background.

/// Returns the colour of a strain, sRGB. @param share  of the scale, clamped to 0..1
vec3 strainColor(float share) {
  const vec3 stops[5] = vec3[5](vec3(0.300, 0.420, 0.720), vec3(0.190, 0.580, 0.730), vec3(0.250, 0.735, 0.600),
                                vec3(0.580, 0.840, 0.400), vec3(0.993, 0.906, 0.144));
  float at = 4.0 * clamp(share, 0.0, 1.0);
  int low = min(int(at), 3);
  return mix(stops[low], stops[low + 1], at - float(low));
}
