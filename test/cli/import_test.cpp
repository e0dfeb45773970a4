// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "cli/small_scene.h"
#include "support/text.h"
#include "viscera/model/shape/mesh_import.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {
namespace {

using namespace test;

constexpr int kSide = 24;                          // voxels
constexpr double kVoxelMm = 2;                     // of 2 mm
constexpr int kLow = 4, kHigh = 20, kBorder = 12;  // of a block of labels 3 (right, k below the border) and 7

class ImportCommand : public ::testing::Test {
 protected:
  /// A block of 16 x 16 x 16 voxels in two halves, as NRRD in LPS.
  std::string scan(const std::string& space = "space: left-posterior-superior\n") const {
    std::string voxels;
    for (int k = 0; k < kSide; ++k)
      for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
          const int least = std::min({i, j, k}), most = std::max({i, j, k});
          voxels += static_cast<char>(least < kLow || most >= kHigh ? 0 : k < kBorder ? 3 : 7);
        }
    return folder_.write("scan.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 24 24\n" + space +
                                          "space directions: (2,0,0) (0,2,0) (0,0,2)\nspace origin: (0,0,0)\n"
                                          "encoding: raw\n\n" +
                                          voxels);
  }
  Ending import(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "import");
    return viscera(arguments);
  }
  size_t entries() const {
    size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) count += !entry.path().empty();
    return count;
  }
  TemporaryFolder folder_;
};

TEST_F(ImportCommand, ListsLabelsAndRange) {
  const Ending ending = import({scan(), "--list"});
  EXPECT_EQ(ending.status, 0) << ending.err;
  EXPECT_TRUE(says(ending.out,
                   {"format: NRRD", "24 x 24 x 24", "2, 2, 2 mm", "lead to LPS", "0 to 7", "3, -, 2048", "7, -, 2048"}))
      << ending.out;
}

TEST_F(ImportCommand, ScenePlaysAndMeshesHaveTheLabelsVolume) {
  const std::string out = folder_.file("organs");
  const Ending ending = import({scan(), "--spacing", "0.004", "--out", out});
  ASSERT_EQ(ending.status, 0) << ending.err;
  constexpr double kVolumeM3 = 2048 * kVoxelMm * kVoxelMm * kVoxelMm * 1e-9;
  constexpr double kSame = 0.01;  // surfaces are rounded, and keep the voxels' volume within
  for (const char* file : {"/label_3.ply", "/label_7.ply"})
    EXPECT_NEAR(signedVolume(importMesh(out + file, 1)), kVolumeM3, kSame * kVolumeM3);
  const Ending run = viscera({"run", out + "/scene.yaml", "--no-view", "--seconds", "0.05"});
  EXPECT_EQ(run.status, 0) << run.err;
}

TEST_F(ImportCommand, WhatIsExportedLiesOverTheScan) {
  ASSERT_EQ(import({scan(), "--labels", "7", "--spacing", "0.004", "--out", folder_.file("organ")}).status, 0);
  const std::string out = folder_.file("run");
  const Ending run = viscera({"run", folder_.file("organ/scene.yaml"), "--out", out, "--seconds", "0.05", "--export",
                              "skin", "--every", "0.05", "--format", "ply", "--export-frame", "lps_mm"});
  ASSERT_EQ(run.status, 0) << run.err;
  const std::filesystem::directory_iterator files(out + "/export");
  Eigen::AlignedBox3d box;
  for (const Vector3f& p : importMesh(files->path(), 1).positions_m) box.extend(p.cast<double>());
  constexpr double kSkinMm = kVoxelMm;  // a skin follows its lattice within half a spacing, which is two voxels
  const Vector3d low = kVoxelMm * Vector3d(kLow - 0.5, kLow - 0.5, kBorder - 0.5);
  EXPECT_LT((box.min() - low).cwiseAbs().maxCoeff(), kSkinMm) << box.min().transpose();
  EXPECT_LT((box.max() - Vector3d::Constant(kVoxelMm * (kHigh - 0.5))).cwiseAbs().maxCoeff(), kSkinMm);
}

TEST_F(ImportCommand, TakesALabelOrAWindow) {
  EXPECT_EQ(import({scan(), "--labels", "7", "--out", folder_.file("seven")}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_.file("seven/label_3.ply")));
  const Ending window = import({scan(), "--window", "2,8", "--out", folder_.file("all")});
  EXPECT_EQ(window.status, 0) << window.err;
  EXPECT_TRUE(says(window.out, {"4096 voxels in the window", "no segmentation"})) << window.out;
  EXPECT_TRUE(std::filesystem::exists(folder_.file("all/window.ply")));
}

TEST_F(ImportCommand, TakesTheTissueThatALabelIsNamedAfter) {
  const std::string names = folder_.write("names.yaml", "3: left_kidney\n7: liver_vessels\n"),
                    out = folder_.file("named");
  const Ending ending = import({scan(), "--names", names, "--spacing", "0.004", "--out", out});
  ASSERT_EQ(ending.status, 0) << ending.err;
  EXPECT_TRUE(says(ending.out, {"m, tissue kidney\n", "m, no tissue of its name"})) << ending.out;
  EXPECT_TRUE(says(readFile(out + "/scene.yaml"),
                   {"material: {tissue: kidney, poisson_ratio: 0.45}  # 0.49", "{young_modulus_pa: 10000,"}));
  const Ending run = viscera({"run", out + "/scene.yaml", "--no-view", "--seconds", "0.05"});
  EXPECT_TRUE(says(run.out, {"left_kidney: tissue kidney: E 5000 Pa", "nu 0.45 of the scene instead of 0.49"}))
      << run.err;
}

TEST_F(ImportCommand, RefusesWithOneLineAndWritesNothing) {
  const std::string good = scan(), out = folder_.file("out");
  const std::vector<std::vector<std::string>> bad = {{good, "--labels", "9", "--out", out},
                                                     {good, "--window", "20,30", "--out", out},
                                                     {good, "--window", "2", "--out", out},
                                                     {good},
                                                     {good, "--out", folder_.file("none/out")},
                                                     {folder_.file("none.nii"), "--out", out},
                                                     {good, "--out", good},
                                                     {good, "--axes", "XYZ", "--spacing", "-1", "--out", out}};
  const size_t before = entries();
  for (const std::vector<std::string>& arguments : bad) {
    const Ending ending = import(arguments);
    EXPECT_NE(ending.status, 0) << ending.out;
    EXPECT_EQ(complaints(ending).size(), 1U) << ending.err;
    EXPECT_EQ(entries(), before);
  }
}

TEST_F(ImportCommand, AnUnknownFrameNeedsAxes) {
  const std::string unknown = scan("space dimension: 3\n");
  const Ending ending = import({unknown, "--out", folder_.file("a")});
  EXPECT_TRUE(says(ending.err, {"axes"})) << ending.err;
  EXPECT_EQ(import({unknown, "--axes", "RAS", "--out", folder_.file("a")}).status, 0);
}

}  // namespace
}  // namespace viscera
