// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Labels of a scan as one body (source: labels).
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "model/body_samples.h"
#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/model/body/elasticity.h"

namespace viscera::test {
namespace {

constexpr int kSide = 24;                          // voxels
constexpr double kVoxel_m = 0.002;                 // of 2 mm
constexpr int kLow = 4, kHigh = 20, kBorder = 12;  // of a block with label 3 below the border and 7 above
constexpr double kHalf_m3 = 16 * 16 * 8 * kVoxel_m * kVoxel_m * kVoxel_m;
// Of a volume: borders of a net are smooth, and keep the voxels' volume to this accuracy.
constexpr double kRounded = 0.01;

class LabelBody : public ::testing::Test {
 protected:
  LabelBody() {
    std::string voxels;
    for (int k = 0; k < kSide; ++k)
      for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
          const int least = std::min({i, j, k}), most = std::max({i, j, k});
          voxels += static_cast<char>(least < kLow || most >= kHigh ? 0 : k < kBorder ? 3 : 7);
        }
    folder_.write("scan.nrrd",
                  "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 24 24\nspace: left-posterior-superior\n"
                  "space directions: (2,0,0) (0,2,0) (0,0,2)\nspace origin: (0,0,0)\nencoding: raw\n\n" +
                      voxels);
    folder_.write("scan.label", "3 255 0 0 1 1 1 \"bone\"\n7 0 255 0 1 1 1 \"liver\"\n");
  }
  Model model(const std::string& keys) const {
    return buildModel(loadScene(folder_.write(
        "scene.yaml",
        "bodies: [{name: organs, source: labels, spacing_m: 0.005, scan: {file: scan.nrrd}, " + keys + "}]")));
  }
  std::string refusal(const std::string& keys) const {
    return messageOf<SceneError>([&] {
      (void)buildModel(loadScene(
          folder_.write("scene.yaml", "bodies: [{name: organs, source: labels, spacing_m: 0.005, " + keys + "}]")));
    });
  }
  TemporaryFolder folder_;
};

double massOf(const Body& body) {
  double kg = 0;
  for (const float m : strengths(body).mass_kg) kg += static_cast<double>(m);
  return kg;
}

/// Returns the colour of a part of the surface mesh, linear; none: it has no own colour.
std::optional<Eigen::Vector3f> colorOf(const Body& body, const std::string& part) {
  const TriangleMesh& mesh = body.skin.mesh;
  const auto at =
      static_cast<size_t>(std::find(mesh.part_names.begin(), mesh.part_names.end(), part) - mesh.part_names.begin());
  if (!mesh.detail || mesh.detail->part_materials.at(at) == kNoChart) return {};
  return mesh.detail->materials.at(mesh.detail->part_materials[at]).color;
}

TEST_F(LabelBody, LabelsHaveTheColorsOfTheirTableUnlessTheSceneGivesOthers) {
  const Eigen::Vector3f red(1, 0, 0), green(0, 1, 0), blue(0, 0, 1);
  const Body plain = model("fill: parts").bodies.at(0);
  EXPECT_EQ(colorOf(plain, "bone"), red);
  EXPECT_EQ(colorOf(plain, "liver"), green);
  const Body painted = model("parts: [{part: liver, color: [0, 0, 1]}]").bodies.at(0);
  EXPECT_EQ(colorOf(painted, "bone"), red);
  EXPECT_EQ(colorOf(painted, "liver"), blue);
  EXPECT_FALSE(model("textures: false").bodies.at(0).skin.mesh.detail);
  EXPECT_NE(refusal("scan: {file: scan.nrrd}, parts: [{part: liver, color: [0, 0, 2]}]").find("parts[0].color"),
            std::string::npos);
}

TEST_F(LabelBody, LabelsThatTouchAreOneBodyInOneSkin) {
  const Body body = model("fill: parts").bodies.at(0);
  EXPECT_EQ(body.lattice.part_names, (std::vector<std::string>{"bone", "liver"}));
  EXPECT_EQ(openEdges(body.skin.mesh), 0u);
  EXPECT_NEAR(signedVolume(body.skin.mesh), 2 * kHalf_m3, kRounded * 2 * kHalf_m3);
  // The border between them is not part of the surface mesh: no vertex is inside the block.
  const Vector3d middle(-12 * kVoxel_m, 12 * kVoxel_m, (kBorder - 0.5) * kVoxel_m);
  for (const Vector3f& p : body.skin.mesh.positions_m)
    EXPECT_GT((p.cast<double>() - middle).cwiseAbs().maxCoeff(), 6 * kVoxel_m) << p.transpose();
  EXPECT_NEAR(massOf(body), 1060 * 2 * kHalf_m3, kRounded * 1060 * 2 * kHalf_m3);
}

TEST_F(LabelBody, ALabelHasItsMaterialAndCellsOnTheBorderBoth) {
  const Body body = model("parts: [{part: bone, density_kg_per_m3: 2120}]").bodies.at(0);
  EXPECT_NEAR(massOf(body), 1060 * 3 * kHalf_m3, kRounded * 1060 * 3 * kHalf_m3);
  ASSERT_FALSE(body.lattice.shared.empty());
  for (size_t i = 0; i + 1 < body.lattice.shared.size(); i += 2) {
    const PartFill &a = body.lattice.shared[i], &b = body.lattice.shared[i + 1];
    ASSERT_EQ(a.cell, b.cell);
    constexpr double kFull = 1e-3;  // a full cell may lack this share
    EXPECT_NEAR(a.fill.share + b.fill.share, fillOf(body.lattice, static_cast<uint32_t>(a.cell)).share, kFull);
  }
}

TEST_F(LabelBody, ALabelIsHeldAndSomeAreChosen) {
  const Body held = model("fixed: [{shape: part, part: bone}]").bodies.at(0);
  for (const uint32_t slot : held.lattice.active_slots) {
    const double above_m = held.lattice.restPosition(slot).z() - (kBorder - 0.5) * kVoxel_m;
    if (std::abs(above_m) < 0.005) continue;
    EXPECT_EQ(isFixed(held.lattice.nodes[slot]), above_m < 0) << above_m;
  }
  for (const char* label : {"7", "liver"}) {
    const Body one = model("centered: true").bodies.at(0);
    const Body liver =
        buildModel(loadScene(folder_.file("scene.yaml"), {std::string("bodies[0].scan.labels=[") + label + "]"}))
            .bodies.at(0);
    EXPECT_EQ(liver.lattice.part_names, std::vector<std::string>{"liver"});
    EXPECT_NEAR(massOf(liver), massOf(one) / 2, kRounded * massOf(one));
  }
}

TEST_F(LabelBody, CellsOfSpringsTakeThemToo) {
  const Body body = model("material: {law: springs}").bodies.at(0);
  EXPECT_TRUE(body.lattice.shared.empty());
  EXPECT_EQ(openEdges(body.skin.mesh), 0u);
}

TEST_F(LabelBody, ErrorsNameBodyFileAndWhatIsAccepted) {
  EXPECT_TRUE(says(refusal("scan: {labels: [3]}"), {"scene.yaml", "'organs'", "scan.file"}));
  EXPECT_TRUE(
      says(refusal("scan: {file: scan.nrrd, labels: [9]}"), {"'organs'", "scan: ", "scan.nrrd", "9", "3 (bone)"}));
  EXPECT_TRUE(says(refusal("scan: {file: none.nii}"), {"'organs'", "none.nii"}));
  EXPECT_TRUE(says(refusal("scan: {file: scan.nrrd, labels: [[3]]}"), {"labels", "list of strings"}));
  EXPECT_TRUE(says(refusal("scan: {file: scan.nrrd}, parts: [{part: lung}]"),
                   {"scene.yaml:1", "bodies[0].parts[0]", "'lung'", "bone, liver"}));
}

}  // namespace
}  // namespace viscera::test
