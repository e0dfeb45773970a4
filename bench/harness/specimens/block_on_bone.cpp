// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/block_on_bone.h"

#include "bench/harness/specimens/clamp.h"

namespace viscera::bench {

BodyConfig blockOnBone(const Vector3d& size_m, double spacing_m, double young_modulus_pa) {
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = size_m;
  body.position_m = Vector3d(0, 0, size_m.z() / 2);
  body.spacing_m = spacing_m;
  body.material.young_modulus_pa = young_modulus_pa;
  body.fixed.push_back(clampBehind(Vector3d(0, 0, -size_m.z() / 2 + 0.1 * spacing_m), Vector3d::UnitZ()));
  return body;
}

}  // namespace viscera::bench
