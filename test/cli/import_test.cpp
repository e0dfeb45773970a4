// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "cli/small_scene.h"
#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/layout/picture_labels.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"
#include "viscera/model/shape/mesh_import.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {
namespace {

using namespace test;

constexpr int kSide = 24;                          // [voxels]
constexpr double kVoxelMm = 2;                     // size of a voxel
constexpr int kLow = 4, kHigh = 20, kBorder = 12;  // block of labels 3 (right, k below the border) and 7

/// A PNG file as RGB, rows from the top.
struct Picture {
  explicit Picture(const std::string& path) {
    image.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&image, path.c_str())) return;
    image.format = PNG_FORMAT_RGB;
    rgb.resize(PNG_IMAGE_SIZE(image));
    png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr);
  }
  /// Returns the mean x and y of coloured pixels (neither grey nor black), relative to the image.
  Eigen::Vector2d colouredMiddle() const {
    Eigen::Vector2d sum(0, 0);
    double count = 0;
    for (uint32_t y = 0; y < image.height; ++y)
      for (uint32_t x = 0; x < image.width; ++x) {
        const uint8_t* p = &rgb[3 * (size_t{y} * image.width + x)];
        if (p[0] <= p[2] + 20) continue;
        sum += Eigen::Vector2d(x, y);
        ++count;
      }
    return (sum / std::max(1.0, count)).cwiseQuotient(Eigen::Vector2d(image.width, image.height));
  }
  png_image image{};
  std::vector<uint8_t> rgb;
};

class ImportCommand : public ::testing::Test {
 protected:
  /// Returns a block of 16 x 16 x 16 voxels in two halves, as NRRD in LPS.
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
  /// Returns real numbers of 24 x 24 x 24 voxels as NRRD in LPS.
  std::string realScan(const std::string& name, const std::function<float(int, int, int)>& value) const {
    std::string voxels;
    for (int k = 0; k < kSide; ++k)
      for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
          const float v = value(i, j, k);
          voxels.append(reinterpret_cast<const char*>(&v), sizeof v);
        }
    return folder_.write(name,
                         "NRRD0004\ntype: float\ndimension: 3\nsizes: 24 24 24\nendian: little\n"
                         "space: left-posterior-superior\nspace directions: (2,0,0) (0,2,0) (0,0,2)\n"
                         "space origin: (0,0,0)\nencoding: raw\n\n" +
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
  EXPECT_TRUE(says(ending.out, {"format: NRRD", "24 x 24 x 24", "2, 2, 2 mm", "directions of i, j, k: LPS", "0 to 7",
                                "3, -, 2048", "7, -, 2048"}))
      << ending.out;
}

TEST_F(ImportCommand, ScenePlaysAndMeshesHaveTheLabelsVolume) {
  const std::string out = folder_.file("organs");
  const Ending ending = import({scan(), "--spacing", "0.004", "--out", out});
  ASSERT_EQ(ending.status, 0) << ending.err;
  constexpr double kVolumeM3 = 2048 * kVoxelMm * kVoxelMm * kVoxelMm * 1e-9;
  constexpr double kSame = 0.01;  // surfaces are rounded, and keep the voxels' volume to this accuracy
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
  constexpr double kSkinMm = kVoxelMm;  // a surface mesh follows its lattice within half a spacing, which is two voxels
  const Vector3d low = kVoxelMm * Vector3d(kLow - 0.5, kLow - 0.5, kBorder - 0.5);
  EXPECT_LT((box.min() - low).cwiseAbs().maxCoeff(), kSkinMm) << box.min().transpose();
  EXPECT_LT((box.max() - Vector3d::Constant(kVoxelMm * (kHigh - 0.5))).cwiseAbs().maxCoeff(), kSkinMm);
}

TEST_F(ImportCommand, StrokesTouchAndCut) {
  const std::string out = folder_.file("organs");
  const Ending ending = import({scan(), "--spacing", "0.003", "--out", out});
  ASSERT_EQ(ending.status, 0) << ending.err;
  EXPECT_TRUE(says(ending.out, {"reading", "surfaces", "previews", "run it: viscera run", "/strokes.yaml"}))
      << ending.out;
  const Ending run = viscera({"run", out + "/scene.yaml", "--strokes", out + "/strokes.yaml", "--no-view"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out.find("\"springs_cut\":0,"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("\"peak_force_n\":0.0,"), std::string::npos) << run.out;
}

TEST_F(ImportCommand, SmallOrgansAreNotHiddenByTheToolThatDentsThem) {
  constexpr double kTissue = 0.1, kTools = 0.05;  // shares of the image: at least, at most; a shaft of 12 cm has 0.06
  for (const double radius : {5.0, 10.0}) {       // voxels: 2 and 4 cm across
    SCOPED_TRACE(radius);
    const std::string ball = realScan("ball.nrrd", [&](int i, int j, int k) {
      return (Vector3d(i, j, k) - Vector3d::Constant(11.5)).norm() < radius ? 1.0F : 0.0F;
    });
    const std::string organ = folder_.file("ball" + std::to_string(radius)), out = organ + "/played";
    ASSERT_EQ(import({ball, "--no-previews", "--out", organ}).status, 0);
    const Ending run = viscera({"run", organ + "/scene.yaml", "--strokes", organ + "/strokes.yaml", "--seconds", "1.02",
                                "--labels", "--live", "--out", out, "--set", "cameras[0].width_px=160", "--set",
                                "cameras[0].height_px=120", "--set", "bodies[0].target_nodes=1500"});
    ASSERT_EQ(run.status, 0) << run.err;
    const Picture picture(out + "/dented_camera_labels.png");
    ASSERT_FALSE(picture.rgb.empty());
    double tissue = 0, tools = 0;
    for (size_t i = 0; i < picture.rgb.size(); i += 3) {
      const uint8_t label = picture.rgb[i];
      tissue += label >= layout::kFirstBodyLabel && label < layout::kFirstToolLabel ? 1 : 0;
      tools += label >= layout::kFirstToolLabel ? 1 : 0;
    }
    const double pixels = static_cast<double>(picture.rgb.size()) / 3;
    EXPECT_GT(tissue / pixels, kTissue);
    EXPECT_GT(tools, 0);
    EXPECT_LT(tools / pixels, kTools);
  }
}

TEST_F(ImportCommand, StrokesTouchWhatIsNotHeld) {
  // A bowl, open to the front: its visible middle is the inner side of its rear, which is fixed.
  const std::string bowl = realScan("bowl.nrrd", [](int i, int j, int k) {
    const double away = (Vector3d(i, j, k) - Vector3d::Constant(11.5)).norm();
    return j >= 8 && away > 8 && away < 10.5 ? 1.0F : 0.0F;
  });
  const std::string out = folder_.file("bowl");
  ASSERT_EQ(import({bowl, "--no-previews", "--spacing", "0.003", "--out", out}).status, 0);
  const Ending run =
      viscera({"run", out + "/scene.yaml", "--strokes", out + "/strokes.yaml", "--no-view", "--seconds", "1.1"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out.find("only fixed tissue"), std::string::npos) << run.out;
  const std::string key = "\"peak_force_n\":";  // of all tools together, before those of each tool
  EXPECT_NE(run.out.substr(run.out.find(key) + key.size(), 4), "0.0,") << run.out;
}

TEST_F(ImportCommand, PreviewsHaveLeftWhereTheirLettersSay) {
  // A block in the left, anterior, upper corner: x of LPS grows to the left, y to the back.
  const auto corner = [](int i, int j, int k) {
    return i >= 14 && i < 21 && j >= 3 && j < 10 && k >= 14 && k < 21 ? 1.0F : 0.0F;
  };
  const std::string labels = realScan("labels.nrrd", corner);
  const std::string grey = realScan("grey.nrrd", [](int i, int, int) { return static_cast<float>(i); });
  ASSERT_EQ(import({labels, "--grey", grey, "--out", folder_.file("a")}).status, 0);
  ASSERT_EQ(import({labels, "--no-previews", "--out", folder_.file("b")}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_.file("b/preview")));
  constexpr double kNear = 0.02;                    // relative to the image: lines are pixels wide
  const double far = 17.5 / kSide, near = 1 - far;  // centre of the block
  const std::vector<std::pair<std::string, Eigen::Vector2d>> slices = {
      {"axial", {far, near}}, {"coronal", {far, near}}, {"sagittal", {near, near}}};
  for (const auto& [name, expected] : slices) {
    const Picture picture(folder_.file("a/preview/slice_" + name + ".png"));
    ASSERT_FALSE(picture.rgb.empty()) << name;
    EXPECT_LT((picture.colouredMiddle() - expected).cwiseAbs().maxCoeff(), kNear) << name << picture.colouredMiddle();
  }
  for (const char* side : {"front", "left", "above"})
    EXPECT_LT(
        (Picture(folder_.file(std::string("a/preview/") + side + ".png")).colouredMiddle() - Eigen::Vector2d(0.5, 0.5))
            .cwiseAbs()
            .maxCoeff(),
        kNear);
  EXPECT_TRUE(says(import({labels, "--grey", folder_.file("none.nii"), "--out", folder_.file("c")}).err, {"none.nii"}));
}

TEST_F(ImportCommand, AWindowsSurfaceIsWhereValuesCrossIt) {
  const double kRadius = 7.3, kMiddle = 11.4;  // [voxels]
  const auto inside = [&](int i, int j, int k) {
    return kRadius - (Eigen::Vector3d(i, j, k) - Eigen::Vector3d::Constant(kMiddle)).norm();
  };
  const std::string ball = realScan("ball.nrrd", [&](int i, int j, int k) {
    return static_cast<float>(100 * std::clamp(inside(i, j, k), -2.0, 2.0));
  });
  const std::string mask =
      realScan("mask.nrrd", [&](int i, int j, int k) { return inside(i, j, k) >= 0 ? 1.0F : 0.0F; });
  ASSERT_EQ(import({ball, "--window", "0,1000", "--no-previews", "--out", folder_.file("values")}).status, 0);
  ASSERT_EQ(import({mask, "--no-previews", "--out", folder_.file("mask")}).status, 0);
  const auto error = [&](const std::string& file) {  // RMS [voxels]
    const TriangleMesh mesh = importMesh(folder_.file(file), 1);
    const Vector3d middle = kMiddle * kVoxelMm * 1e-3 * Vector3d(-1, 1, 1);  // from LPS to anterior, left, up
    double sum = 0;
    for (const Vector3f& p : mesh.positions_m) {
      const Vector3d offset = p.cast<double>() - middle;
      sum += std::pow(offset.norm() / (kVoxelMm * 1e-3) - kRadius, 2);
    }
    return std::sqrt(sum / static_cast<double>(mesh.positions_m.size()));
  };
  constexpr double kMost = 0.05;  // docs/volumes.md
  EXPECT_LT(error("values/window.ply"), kMost);
  EXPECT_GT(error("mask/label_1.ply"), 2 * error("values/window.ply"));
}

TEST_F(ImportCommand, ALabelWhoseVoxelsOthersHaveIsLeftOut) {
  std::string layer;
  for (int n = 0; n < 512; ++n) layer += static_cast<char>(n % 8 > 1 && n % 8 < 6 && n / 64 > 1 && n / 64 < 6);
  std::string voxels;
  for (const char c : layer) voxels += std::string(2, c);
  const std::string two = folder_.write(
      "two.seg.nrrd",
      "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 8 8 8\nspace: left-posterior-superior\n"
      "space directions: none (2,0,0) (0,2,0) (0,0,2)\nspace origin: (0,0,0)\nkinds: list domain domain domain\n"
      "Segment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Name:=one\nSegment1_LabelValue:=1\n"
      "Segment1_Layer:=1\nSegment1_Name:=two\nencoding: raw\n\n" +
          voxels);
  const Ending ending = import({two, "--out", folder_.file("out")});
  EXPECT_EQ(ending.status, 0) << ending.err;
  EXPECT_TRUE(says(ending.out, {"left out: all its voxels belong to other labels"})) << ending.out;
}

TEST_F(ImportCommand, VolumeThatASmoothSurfaceLosesIsNoted) {
  const std::string dust =
      realScan("dust.nrrd", [](int i, int j, int k) { return i % 4 == 2 && j % 4 == 2 && k % 4 == 2 ? 1.0F : 0.0F; });
  const auto imported = [&](const std::string& file, const std::string& out) {
    return import({file, "--no-previews", "--spacing", "0.01", "--out", folder_.file(out)});
  };
  const Ending lost = imported(dust, "specks");
  EXPECT_EQ(lost.status, 0) << lost.err;
  EXPECT_TRUE(says(lost.out, {"note: label_1: its surface encloses 1.06 of the 1.73 cm3 of its voxels"})) << lost.out;
  EXPECT_EQ(imported(scan(), "block").out.find("its surface encloses"), std::string::npos);
}

TEST_F(ImportCommand, TakesALabelOrAWindow) {
  const Ending seven = import({scan(), "--labels", "7", "--spacing", "0.0015", "--out", folder_.file("seven")});
  EXPECT_EQ(seven.status, 0) << seven.err;
  EXPECT_TRUE(says(seven.out, {"0.0015", "finer than its voxels, of up to 0.002"})) << seven.out;
  EXPECT_FALSE(std::filesystem::exists(folder_.file("seven/label_3.ply")));
  const Ending window = import({scan(), "--window", "2,8", "--out", folder_.file("all")});
  EXPECT_EQ(window.status, 0) << window.err;
  EXPECT_TRUE(says(window.out, {"4096 voxels in the window", "not a segmentation"})) << window.out;
  EXPECT_TRUE(std::filesystem::exists(folder_.file("all/window.ply")));
}

TEST_F(ImportCommand, TakesTheTissueThatALabelIsNamedAfter) {
  const std::string names = folder_.write("names.yaml", "3: left_kidney\n7: liver_vessels\n"),
                    out = folder_.file("named");
  const Ending ending = import({scan(), "--names", names, "--spacing", "0.004", "--out", out});
  ASSERT_EQ(ending.status, 0) << ending.err;
  EXPECT_TRUE(says(ending.out, {"m, tissue kidney\n", "m, no known tissue of this name"})) << ending.out;
  EXPECT_TRUE(says(readFile(out + "/scene.yaml"),
                   {"material: {tissue: kidney, poisson_ratio: 0.45}", "{young_modulus_pa: 10000,"}));
  const Ending run = viscera({"run", out + "/scene.yaml", "--no-view", "--seconds", "0.05"});
  EXPECT_TRUE(says(run.out, {"left_kidney: tissue kidney: E 5000 Pa", "nu 0.45 from the scene instead of 0.49"}))
      << run.err;
}

TEST_F(ImportCommand, LabelsBecomePartsOfOneBodySomeOfThemHeld) {
  const std::string out = folder_.file("one"), scene = out + "/scene.yaml";
  const Ending ending = import({scan(), "--spacing", "0.004", "--one-body", "--rigid", "3", "--out", out});
  ASSERT_EQ(ending.status, 0) << ending.err;
  EXPECT_FALSE(std::filesystem::exists(out + "/label_3.ply"));
  EXPECT_TRUE(says(readFile(scene), {"source: labels", "part: \"label 7\"", "{shape: part, part: \"label 3\"}"}));
  const Ending run = viscera({"run", scene, "--no-view", "--seconds", "0.05"});
  EXPECT_EQ(run.status, 0) << run.err;
}

TEST_F(ImportCommand, ARigidLabelIsHeldAllOver) {
  const std::string out = folder_.file("held");
  ASSERT_EQ(import({scan(), "--spacing", "0.004", "--rigid", "3", "--out", out}).status, 0);
  const Model model = buildModel(loadScene(out + "/scene.yaml"));
  for (const uint32_t slot : model.bodies.at(0).lattice.active_slots)
    EXPECT_TRUE(isFixed(model.bodies[0].lattice.nodes[slot]));
  const Lattice& soft = model.bodies.at(1).lattice;
  EXPECT_FALSE(std::all_of(soft.active_slots.begin(), soft.active_slots.end(),
                           [&](uint32_t slot) { return isFixed(soft.nodes[slot]); }));
}

TEST_F(ImportCommand, RefusesWithOneLineAndWritesNothing) {
  const std::string good = scan(), out = folder_.file("out");
  const std::vector<std::vector<std::string>> bad = {{good, "--labels", "9", "--out", out},
                                                     {good, "--window", "20,30", "--out", out},
                                                     {good, "--window", "2", "--out", out},
                                                     {good, "--rigid", "9", "--out", out},
                                                     {good, "--one-body", "--window", "2,8", "--out", out},
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
