// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// A scene written out with all its keys is the same scene.
#include "model/scene/scene_yaml.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "model/scene/scene_text.h"
#include "support/source_folder.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

void expectSame(const Scene& scene) {
  const std::string yaml = resolvedYaml(scene);
  const Scene again = parseScene(yaml, "resolved");
  EXPECT_EQ(sceneText(again), sceneText(scene));
  EXPECT_EQ(resolvedYaml(again), yaml) << "what the text of a scene leaves out";
}

TEST(SceneYaml, ShippedScenesComeBack) {
  size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::sourceFolder() + "/config/scenes")) {
    SCOPED_TRACE(entry.path());
    expectSame(loadScene(entry.path().string()));
    ++count;
  }
  EXPECT_GT(count, 5U);
}

TEST(SceneYaml, WhatHasNoDefaultComesBackToTheBit) {
  expectSame(
      parseScene("bodies:\n"
                 "  - name: a\n"
                 "    spacing_m: 0.1234567890123456\n"
                 "    material: {tissue: liver, density_kg_per_m3: 1071, cut: {toughness_j_per_m2: 30}}\n"
                 "    parts: [{part: 'true', tissue: kidney, poisson_ratio: 0.3, color: [0.1, 0.25, 0.3]}]\n"
                 "    fixed: [{shape: plane, normal: [0.1, 0.3, -1]}]\n"
                 "    layers: [{depth_m: 0.002, color: [0.1, 0.2, 0.7]}]\n"
                 "  - {name: b, source: labels, scan: {file: 'a: b # c', labels: ['1', liver]}}\n"
                 "cameras: [{name: eye, position_m: [0, -1, 0], overlays: [strain, wind]}]\n"
                 "sutures: [{name: suture, usp: 4-0, path: [{position_m: [0.03, 0, 0]}]}]\n"
                 "look: endoscope\nsolver: {tick_hz: 100}\n",
                 "test"));
}

}  // namespace
}  // namespace viscera
