// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The preset of a scene's appearance (key look).
#include <gtest/gtest.h>

#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

TEST(SceneLook, EndoscopeGivesWhatTheSceneDoesNotGive) {
  const Scene scene = parseScene(
      "{look: endoscope, bodies: [{name: a}, {name: b, specular_wetness: 0.1}],"
      " cameras: [{name: a}, {name: b, light: lamp, contact_shadows: 0.2, supersampling: 1}]}",
      "look");
  EXPECT_EQ(scene.look, Look::kEndoscope);
  EXPECT_EQ(scene.bodies[0].specular_wetness, 0.5);
  EXPECT_EQ(scene.bodies[1].specular_wetness, 0.1);
  EXPECT_EQ(scene.cameras[0].light, CameraLight::kLens);
  EXPECT_EQ(scene.cameras[0].contact_shadows, 0.7);
  EXPECT_EQ(scene.cameras[0].supersampling, 0) << "two on a GPU";
  EXPECT_EQ(scene.cameras[1].light, CameraLight::kLamp);
  EXPECT_EQ(scene.cameras[1].contact_shadows, 0.2);
  EXPECT_EQ(scene.cameras[1].supersampling, 1);
}

TEST(SceneLook, PlainGivesTheDefaults) {
  const Scene scene = parseScene("{look: plain, bodies: [{name: a}], cameras: [{name: a}]}", "look");
  EXPECT_EQ(scene.bodies[0].specular_wetness, BodyConfig().specular_wetness);
  EXPECT_EQ(scene.cameras[0].light, CameraLight::kLamp);
  EXPECT_EQ(scene.cameras[0].supersampling, CameraConfig().supersampling);
}

TEST(SceneLook, OverrideChoosesIt) {
  const Scene scene = parseScene("{bodies: [{name: a}], cameras: [{name: a}]}", "look", {"look=endoscope"});
  EXPECT_EQ(scene.cameras[0].light, CameraLight::kLens);
  EXPECT_NE(test::messageOf<SceneError>([] {
              (void)parseScene("{look: theatre, bodies: [{name: a}]}", "look");
            }).find("plain"),
            std::string::npos);
}

}  // namespace
}  // namespace viscera
