// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/scan/scan_files.h"

namespace viscera {
namespace {

using test::TestVolume;
using test::written;

/// Returns labels 0, 10, 20, 30, 40 in order of i.
TestVolume organs() {
  TestVolume v;
  v.size[0] = 5;
  v.fill();
  for (size_t n = 0; n < v.voxels.size(); ++n) v.voxels[n] = static_cast<int16_t>(10 * (n % 5));
  return v;
}

std::string said(const std::string& path, const LabelOptions& options) {
  return test::errorOf(path, [&] { readLabels(path, options); });
}

size_t count(const LabelVolume& volume, int label) {
  return static_cast<size_t>(std::count(volume.labels.begin(), volume.labels.end(), label));
}

TEST(Labels, AreRenumberedInTheOrderAskedFor) {
  const TestVolume v = organs();
  const std::string path = written("a.nii.gz", test::packed(test::NiftiHeader(v).bytes() + v.bytes()));
  LabelOptions options;
  options.labels = {"30", "10"};
  const LabelVolume volume = readLabels(path, options);
  EXPECT_EQ(std::vector<uint8_t>(volume.labels.begin(), volume.labels.begin() + 5),
            (std::vector<uint8_t>{0, 2, 0, 1, 0}));
  ASSERT_EQ(volume.names.size(), 3U);
  EXPECT_EQ(volume.names[1].value, 30);
  const LabelVolume all = readLabels(path);
  EXPECT_EQ(std::vector<uint8_t>(all.labels.begin(), all.labels.begin() + 5), (std::vector<uint8_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(all.names[4].value, 40);
  options.labels = {"50"};
  EXPECT_NE(said(path, options).find("no voxel has label 50; accepted: 10, 20, 30, 40"), std::string::npos);
  options.labels = {"liver"};
  EXPECT_NE(said(path, options).find("there is no label 'liver'; accepted: 10, 20, 30, 40"), std::string::npos);
  options.labels = {"10", "10"};
  EXPECT_NE(said(path, options).find("requested twice; accepted: 10, 20"), std::string::npos);
  options.labels = {"0"};
  EXPECT_NE(said(path, options).find("is the background; accepted: 10, 20"), std::string::npos);
  options.labels = {"10", " 20 "};  // split like "10, 20 " on a command line
  EXPECT_EQ(readLabels(path, options).names[2].value, 20);
}

TEST(Labels, NamesFromTablesBesideAndGiven) {
  const TestVolume v = organs();
  const std::string path = written("organs.nii", test::NiftiHeader(v).bytes() + v.bytes());
  written("organs.label",
          "# ITK-SnAP\n    0     0    0    0        0  0  0    \"Clear Label\"\n   10   255    0    0        1  1  1   "
          " \"liver\"\n"
          "   20     0  255    0      0.5  1  1    \"left kidney\"\n");
  LabelOptions options;
  options.labels = {"left kidney", "liver"};
  const LabelVolume volume = readLabels(path, options);
  EXPECT_EQ(volume.labels[1], 2);
  EXPECT_EQ(volume.labels[2], 1);
  EXPECT_EQ(volume.names[1].name, "left kidney");
  options.names_file = written("names.yaml", "liver: 40\n30: spleen\n");
  options.labels = {"spleen", "liver"};
  EXPECT_EQ(readLabels(path, options).names[2].value, 40);
  options.names_file = written("wrong.yaml", "liver: spleen\n");
  EXPECT_NE(test::errorOf(options.names_file, [&] { readLabels(path, options); }).find("accepted: a map"),
            std::string::npos);
  options.names_file = written("broken.yaml", "a: [1, 2\n");
  EXPECT_FALSE(test::errorOf(options.names_file, [&] { readLabels(path, options); }).empty());
  options.names_file = written("wrong.txt", "10 liver\n");
  EXPECT_NE(test::errorOf(options.names_file + ":1", [&] { readLabels(path, options); }).find("ITK-SNAP"),
            std::string::npos);
  options.names_file = written("names.csv", "");
  EXPECT_FALSE(test::errorOf(options.names_file, [&] { readLabels(path, options); }).empty());
}

TEST(Labels, SegmentsOfSeveralLayersOverlap) {
  TestVolume v = organs();
  const std::string header = test::nrrdHeader(
      v, "LPS",
      "encoding: raw\nSegment0_ID:=Segment_1\nSegment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Name:=liver\n"
      "Segment0_Color:=0.5 0.68 0.25\n"
      "Segment1_ID:=Segment_2\nSegment1_LabelValue:=1\nSegment1_Layer:=1\nSegment1_Name:=tumour\n");
  std::string four =
      test::replaced(test::replaced(header, "dimension: 3", "dimension: 4"), "kinds: domain", "kinds: list domain");
  four = test::replaced(four, "sizes: 5", "sizes: 2 5");
  four = test::replaced(four, "space directions: ", "space directions: none ");
  TestVolume both;  // two layers: liver where i > 0, tumour where i > 2
  both.size[0] = 10;
  both.fill();
  for (size_t n = 0; n < both.voxels.size(); ++n) both.voxels[n] = n / 2 % 5 > (n % 2 ? 2 : 0);
  const std::string path = written("a.seg.nrrd", four + both.bytes());
  LabelOptions options;
  std::vector<std::string> notes;
  options.notes = &notes;
  options.labels = {"tumour", "liver"};
  LabelVolume volume = readLabels(path, options);
  EXPECT_EQ(std::vector<uint8_t>(volume.labels.begin(), volume.labels.begin() + 5),
            (std::vector<uint8_t>{0, 2, 2, 1, 1}));
  EXPECT_EQ(volume.names[2].color, Vector3d(0.5, 0.68, 0.25));
  EXPECT_FALSE(volume.names[1].color.has_value());
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("12 voxels have several labels"), std::string::npos) << notes[0];
  options.labels = {"liver", "tumour"};
  EXPECT_EQ(count(readLabels(path, options), 2), 0U);
  options.labels = {"1"};
  EXPECT_NE(said(path, options).find("several labels"), std::string::npos);
  const std::string one_layer = written("b.seg.nrrd", test::replaced(header, "Layer:=1", "Layer:=0") + v.bytes());
  options.labels = {"liver"};
  EXPECT_FALSE(said(one_layer, options).empty());  // no voxel has 1
}

TEST(Labels, ThatAreNearlyWholeAreRoundedWithANote) {
  const TestVolume v = organs();
  test::NiftiHeader header(v);
  header.put<float>(112, 0, 0.29999F);  // labels 2.9999, 5.9998, 8.9997 and 11.9996
  std::vector<std::string> notes;
  LabelOptions options;
  options.notes = &notes;
  const LabelVolume map = readLabels(written("near.nii", header.bytes() + v.bytes()), options);
  ASSERT_EQ(map.names.size(), 5U);
  EXPECT_EQ(map.names[1].value, 3);
  EXPECT_EQ(map.names[4].value, 12);
  EXPECT_EQ(count(map, 1), 6U);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("near.nii: values were rounded to labels, by up to 0.000"), std::string::npos) << notes[0];
  header.put<float>(112, 0, 0.2999F);
  const std::string far = said(written("far.nii", header.bytes() + v.bytes()), {});
  EXPECT_NE(far.find("a voxel has the value 11.996, 0.00"), std::string::npos) << far;
  EXPECT_NE(far.find("--window"), std::string::npos) << far;
}

TEST(Labels, WhatIsNoLabelMapIsRefused) {
  TestVolume v = organs();
  test::NiftiHeader header(v);
  header.put<float>(112, 0, 0.25F);
  const std::string half = written("half.nii", header.bytes() + v.bytes());
  EXPECT_NE(said(half, {}).find("accepted: whole numbers"), std::string::npos);
  TestVolume many;
  many.size[0] = 400;
  many.fill();
  for (size_t n = 0; n < many.voxels.size(); ++n) many.voxels[n] = static_cast<int16_t>(n % 400);
  const std::string path = written("many.nii", test::NiftiHeader(many).bytes() + many.bytes());
  EXPECT_NE(said(path, {}).find("at most 255"), std::string::npos);
  LabelOptions some;
  some.labels = {"399", "2"};
  EXPECT_EQ(count(readLabels(path, some), 1), 6U);
}

TEST(Labels, TheRealLiver) {
  const std::string path = test::realData("ct/example_seg.nii.gz");
  if (path.empty()) GTEST_SKIP() << "ct/ not found; set VISCERA_TEST_DATA";
  LabelOptions options;
  options.labels = {"5"};
  const LabelVolume liver = readLabels(path, options);
  EXPECT_EQ(count(liver, 1), 38634U);
  EXPECT_NEAR(std::abs(liver.frame.axes.determinant()) * 1e9, 27, 0.01);  // [mm3]
  EXPECT_EQ(readLabels(path).names.size(), 42U);                          // 41 labels, and the outside
}

}  // namespace
}  // namespace viscera
