// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The energy of a cell's volume (physics.md 1): what makes Poisson's ratio other than 1/4.

/// Shape of a cell from its mean edges (four along each axis): rows of the cofactors b x c, c x a, a x b over h^2, and e = V/V0 - 1.
struct CellShape {
  vec3 bc, ca, ab;
  float e;
};

/// @param da, db, dc  mean edges less their rest value, over h.   e without cancellation: tr D + minors of D + det D.
CellShape cellShape(vec3 da, vec3 db, vec3 dc) {
  vec3 a = vec3(1.0f, 0.0f, 0.0f) + da, b = vec3(0.0f, 1.0f, 0.0f) + db, c = vec3(0.0f, 0.0f, 1.0f) + dc;
  float minors = (da.x * db.y - da.y * db.x) + (da.x * dc.z - da.z * dc.x) + (db.y * dc.z - db.z * dc.y);
  float e = (da.x + db.y + dc.z) + (minors + dot(da, cross(db, dc)));
  CellShape shape = {cross(b, c), cross(c, a), cross(a, b), e};
  return shape;
}

/// dW/de of the energy W(e) [J]: bulk/2 e^2, linear beyond |e| = 1; for bulk < 0 bulk/2 g^2 with g = (e + e^2)/(1 + e^2),
/// which is bounded and, for a cell turned inside out, nothing.
float volumePressure(float bulk, float e) {
  if (bulk > 0.0f) return bulk * clamp(e, -1.0f, 1.0f);
  float q = 1.0f + e * e;
  return e > -1.0f ? bulk * ((e + e * e) / q) * ((1.0f + 2.0f * e - e * e) / (q * q)) : 0.0f;
}

float volumeEnergy(float bulk, float e) {
  float size = abs(e);
  if (bulk > 0.0f) return size <= 1.0f ? 0.5f * bulk * e * e : bulk * (size - 0.5f);
  float g = e > -1.0f ? (e + e * e) / (1.0f + e * e) : 0.0f;
  return 0.5f * bulk * g * g;
}
