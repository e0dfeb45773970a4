// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// A program with a locale that has a decimal comma reads, writes and steps the same.
#include <gtest/gtest.h>

#include "math/number_text.h"
#include "model/scene/scene_text.h"
#include "model/scene/scene_yaml.h"
#include "session/on_backends.h"
#include "support/comma_locale.h"
#include "support/temporary_folder.h"
#include "viscera/math/state_hash.h"
#include "viscera/model/shape/mesh_import.h"
#include "viscera/tools/strokes.h"

namespace viscera {
namespace {

using namespace test;

/// Expects the same with a decimal comma and without. @param make  returns the text of everything that may differ
template <class Make>
void expectSame(const Make& make) {
  const std::string plain = make();
  std::string with_comma;
  {
    const CommaLocale comma;
    with_comma = make();
  }
  EXPECT_EQ(with_comma, plain);
}

std::string cornersOf(const std::string& path) {
  try {
    std::string out;
    const auto add = [&out](const auto& p) {
      for (int axis = 0; axis < 3; ++axis) out += exactText(p[axis]) + ' ';
    };
    for (const Vector3f& p : importMesh(path, 1).positions_m) add(p);
    return out;
  } catch (const std::exception& error) {
    return error.what();
  }
}

TEST(InACommaLocale, MeshesAreRead) {
  const TemporaryFolder folder;
  const std::string ply = folder.write("a.ply",
                                       "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                                       "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
                                       "end_header\n0 0 0\n0.125 0 0\n0 0.5 0\n0 0 1.25e-1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n"
                                       "3 1 2 3\n");
  const std::string msh = folder.write("a.msh",
                                       "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 0.125 0 0\n"
                                       "3 0 0.5 0\n4 0 0 1.25e-1\n$EndNodes\n$Elements\n1\n1 4 2 0 1 1 2 3 4\n"
                                       "$EndElements\n");
  const std::string obj = folder.write("a.obj",
                                       "v 0 0 0\nv 0.125 0 0\nv 0 0.5 0\nv 0 0 0.125\nf 1 3 2\nf 1 2 4\nf 1 4 3\n"
                                       "f 2 3 4\n");
  std::string facets = "solid a\n";
  for (const char* corners : {"0 0 0\nvertex 0 0.5 0\nvertex 0.125 0 0", "0 0 0\nvertex 0.125 0 0\nvertex 0 0 0.125",
                              "0 0 0\nvertex 0 0 0.125\nvertex 0 0.5 0", "0.125 0 0\nvertex 0 0.5 0\nvertex 0 0 0.125"})
    facets += std::string("facet normal 0 0 1\nouter loop\nvertex ") + corners + "\nendloop\nendfacet\n";
  const std::string stl = folder.write("a.stl", facets + "endsolid a\n");
  for (const std::string& file : {ply, msh, obj, stl}) {
    expectSame([&] { return cornersOf(file); });
    EXPECT_NE(cornersOf(file).find("0.125"), std::string::npos) << cornersOf(file);
  }
}

TEST(InACommaLocale, ScenesAndStrokesAreReadAndWritten) {
  const std::string yaml =
      "name: a\nbodies:\n  - {name: b, source: box, box_size_m: [0.04, 0.0425, 0.04], spacing_m: 0.0105,\n"
      "     material: {young_modulus_pa: 12345.5}}\nsolver: {tick_hz: 1000, max_substeps: 12000}\n";
  const std::string strokes =
      "strokes:\n  - stylus: left\n    keys:\n      - {t_s: 0.25, position_m: [0.5, -0.125, 0], rotation_deg: [0, 0, "
      "0]}\n      - {t_s: 1234.5, position_m: [0.5, 0, 0], rotation_deg: [0, 0, 12.5]}\nmarks: [{name: a, t_s: 0.5}]\n";
  expectSame([&] {
    const Scene scene = parseScene(yaml, "scene.yaml", {"environment.gravity_m_per_s2=[0.5,0,-9.81]"});
    return sceneText(scene) + resolvedYaml(scene) + strokesYaml(parseStrokes(strokes, "strokes.yaml"));
  });
  expectSame([&] {
    try {
      parseScene("bodies: [{name: a, spacing_m: 12345.5}]\n", "scene.yaml", {});
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  });
}

class SessionInACommaLocale : public OnSceneBackend {};
VISCERA_ON_EVERY_BACKEND(SessionInACommaLocale);

TEST_P(SessionInACommaLocale, StepsAndShowsTheSame) {
  expectSame([this] {
    Session session(scene(), context_);
    play(session, cut, 10);
    const ImageFrame image = picture(session);
    StateHash pixels;
    for (const uint8_t value : image.rgb) pixels.add(uint32_t{value});
    return StateHash::text(session.stateHash()) + " " + StateHash::text(pixels.value());
  });
}

}  // namespace
}  // namespace viscera
