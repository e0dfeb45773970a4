// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/scene_fields.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

// The sections of a scene file; their keys are in scene_fields.h and body_fields.h.

template <class V>
void visitFields(V& v, Scene& c) {
  v.text("name", c.name, "name, for reports");
  v.list("bodies", c.bodies, layout::kMaxBodies, "pieces of tissue, at least one");
  v.list("styluses", c.styluses, layout::kMaxStyluses, "tools");
  v.list("cameras", c.cameras, 8, "views");
  v.list("obstacles", c.obstacles, layout::kMaxObstacles, "rigid things that nodes do not enter");
  v.group("collision", c.collision, "bodies against themselves and each other; costs nothing while it is off");
  v.group("environment", c.environment, "gravity and frames");
  v.group("solver", c.solver, "time stepping");
  v.list("threads", c.threads, 8, "threads that do not stretch, on obstacles, in hands that grab and through tissue");
}

}  // namespace viscera
