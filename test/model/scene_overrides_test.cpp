// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

using test::says;

constexpr const char* kSceneOverridesScene =
    "name: plain\n"
    "bodies:\n"
    "  - {name: a, spacing_m: 0.01}\n"
    "  - {name: b, fixed: [{shape: sphere}]}\n";

Scene overridden(const Overrides& overrides) {
  return parseScene(kSceneOverridesScene, "s.yaml", overrides);
}

std::string refusal(const std::string& override_text) {
  return test::messageOf<SceneError>([&] { overridden({override_text}); });
}

TEST(SceneOverride, ReplacesOneValueAndNothingElse) {
  const Scene scene = overridden({"bodies[1].fixed[0].radius_m=0.25", "solver.tick_hz=100"});
  EXPECT_EQ(scene.bodies[1].fixed[0].radius_m, 0.25);
  EXPECT_EQ(scene.bodies[1].fixed[0].shape, FixedShape::kSphere);
  EXPECT_EQ(scene.bodies[0].spacing_m, 0.01);
  EXPECT_EQ(scene.solver.tick_hz, 100);
  EXPECT_EQ(scene.solver.dt_fraction, SolverConfig{}.dt_fraction);
}

TEST(SceneOverride, AddsWhatTheFileDoesNotHave) {
  const Scene scene = overridden({"bodies[0].material.young_modulus_pa=5000", "bodies[0].position_m=[0, 0.1, 0]",
                                  "styluses=[{name: left}]", "styluses[0].idle=cut"});
  EXPECT_EQ(scene.bodies[0].material.young_modulus_pa, 5000);
  EXPECT_EQ(scene.bodies[0].position_m, Vector3d(0, 0.1, 0));
  ASSERT_EQ(scene.styluses.size(), 1u);
  EXPECT_EQ(scene.styluses[0].idle, ToolMode::kCut);
}

TEST(SceneOverride, TheLastOneOfAKeyCounts) {
  EXPECT_EQ(overridden({"name=first", "name=second"}).name, "second");
}

TEST(SceneOverride, ValueMayHoldAnEqualsSign) {
  EXPECT_EQ(overridden({"bodies[0].mesh_file=a=b.obj"}).bodies[0].mesh_file, "a=b.obj");
}

TEST(SceneOverride, BadValueIsRefusedAsAnOverrideWithKeyAndRange) {
  EXPECT_TRUE(says(refusal("bodies[0].spacing_m=-1"), {"override", "'bodies[0].spacing_m'", "1e-05 .. 10 m", "'-1'"}));
  EXPECT_TRUE(says(refusal("bodies[0].spacing_m=.nan"), {"override", "'bodies[0].spacing_m'", "1e-05 .. 10 m"}));
  EXPECT_TRUE(says(refusal("bodies[0].spacing_m=soft"), {"override", "'bodies[0].spacing_m'", "'soft'"}));
  EXPECT_TRUE(says(refusal("bodies[0].spacing_m="), {"override", "'bodies[0].spacing_m'", "found nothing"}));
  EXPECT_TRUE(says(refusal("bodies[0].position_m=[0, 0]"), {"override", "'bodies[0].position_m'", "3 numbers"}));
  EXPECT_TRUE(says(refusal("bodies[0].material={young: 1}"), {"override", "'bodies[0].material.young'"}));
  EXPECT_TRUE(says(refusal("bodies=3"), {"override", "'bodies'", "a list"}));
}

TEST(SceneOverride, UnknownKeyIsRefusedAsAnOverride) {
  EXPECT_TRUE(says(refusal("bodies[0].spacing=1"), {"override", "unknown key 'bodies[0].spacing'", "spacing_m"}));
  EXPECT_TRUE(says(refusal("spacing_m=1"), {"override", "unknown key 'spacing_m'"}));
  EXPECT_TRUE(says(refusal("body.spacing_m=1"), {"override", "unknown key 'body'", "bodies"}));
  EXPECT_TRUE(says(refusal("bodies[0].stuff.young_modulus_pa=1"), {"override", "unknown key 'bodies[0].stuff'"}));
}

TEST(SceneOverride, PositionThatTheSceneDoesNotHaveIsRefused) {
  EXPECT_TRUE(says(refusal("bodies[2].spacing_m=1"), {"override", "no bodies[2]"}));
  EXPECT_TRUE(says(refusal("cameras[0].rate_hz=1"), {"override", "no cameras[0]"}));
  EXPECT_TRUE(says(refusal("name[0]=1"), {"override", "no name[0]"}));
  EXPECT_TRUE(says(refusal("name.x=1"), {"override", "'name' has no keys below it"}));
  EXPECT_TRUE(says(refusal("bodies.spacing_m=1"), {"override", "'bodies' has no keys below it"}));
}

TEST(SceneOverride, TextThatIsNoOverrideIsRefusedAndShown) {
  for (const char* text : {"", "=1", "name", "bodies[0]", "bodies[].name=a", "bodies[x].name=a", "bodies[-1].name=a",
                           "bodies[0.name=a", "bodies[=1", "bodies[99999999999999999999].name=a", "[0].name=a",
                           ".name=a", "bodies[0]..name=a", "bodies[0].name=[a", "name={"}) {
    EXPECT_TRUE(says(refusal(text), {"override '" + std::string(text) + "'"}));
  }
}

TEST(SceneOverride, ErrorInTheFileStillNamesItsLine) {
  const std::string message = test::messageOf<SceneError>(
      [] { parseScene("bodies:\n  - {name: a, spacing: 1}\n", "s.yaml", {"bodies[0].spacing_m=0.01"}); });
  EXPECT_TRUE(says(message, {"s.yaml:2: ", "unknown key 'bodies[0].spacing'"}));
}

}  // namespace
}  // namespace viscera
