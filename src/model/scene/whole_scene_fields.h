// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/mark_fields.h"
#include "model/scene/scene_fields.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

// The sections of a scene file; their keys are in scene_fields.h, body_fields.h, mark_fields.h and suture_fields.h.

// Values of look endoscope, chosen by eye on the scenes of config/.
constexpr double kEndoscopeShadows = 0.7;  // contact_shadows
constexpr double kEndoscopeWetness = 0.5;  // specular_wetness

/// Returns a camera with the values of a look, for what a scene does not give. Its supersampling stays 0: two samples
/// on a GPU, and on a software renderer as many as it affords; 2 would take it up to twice the time of an image.
inline CameraConfig cameraOf(Look look) {
  CameraConfig camera;
  if (look == Look::kPlain) return camera;
  camera.light = CameraLight::kLens;
  camera.contact_shadows = kEndoscopeShadows;
  return camera;
}

/// Returns a body with the values of a look, for what a scene does not give.
inline BodyConfig bodyOf(Look look) {
  BodyConfig body;
  if (look == Look::kEndoscope) body.specular_wetness = kEndoscopeWetness;
  return body;
}

template <class V>
void visitFields(V& v, Scene& c) {
  v.text("name", c.name, "name of the scene, for reports");
  v.choice("look", c.look, {{"plain", Look::kPlain}, {"endoscope", Look::kEndoscope}},
           "preset of the appearance, for what the scene does not give itself; plain: the defaults of the keys; "
           "endoscope: light: lens and contact_shadows: 0.7 of cameras, and specular_wetness: 0.5 of bodies");
  v.list("bodies", c.bodies, layout::kMaxBodies, "bodies: pieces of tissue, at least one", bodyOf(c.look));
  v.list("styluses", c.styluses, layout::kMaxStyluses, "styluses that users move, with their tools");
  v.list("cameras", c.cameras, 8, "cameras that render the scene", cameraOf(c.look));
  v.list("obstacles", c.obstacles, layout::kMaxObstacles, "obstacles: rigid shapes that nodes do not enter");
  v.group("collision", c.collision, "collisions of bodies with themselves and each other; no cost while disabled");
  v.group("environment", c.environment, "gravity, frames and wind");
  v.group("solver", c.solver, "time stepping");
  v.list("sutures", c.sutures, 8,
         "sutures, of constant length; they pass through tissue and touch obstacles, and styluses grip them");
  v.list("attachments", c.attachments, kMostAttachments,
         "attachments: connective tissue between two bodies, in fibres that tear and can be cut (docs/physics.md 17)");
  v.list("marks", c.marks, kMostMarks,
         "marks on the surface of tissue, which move with it; images of depths and labels do not show them");
}

}  // namespace viscera
