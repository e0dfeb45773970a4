// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/dicom.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "model/scan/dicom_files.h"
#include "model/scan/labels.h"
#include "model/scan/scan_files.h"

// DICOM by the program viscera-dicom, which is built where GDCM is available.
namespace viscera {
namespace {

using namespace test::dicom;
using test::TestVolume;

/// Returns one slice at the volume's position with a coordinate of its own along the third axis.
std::string slice(const TestVolume& v, int k, double height, const std::string& series = "1.2.3") {
  const size_t bytes = 2 * static_cast<size_t>(v.size[0] * v.size[1]);
  return head() + element(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2") + element(8, 0x60, "CS", "CT") +
         element(8, 0x103e, "LO", "made " + series) + element(0x20, 0xe, "UI", series) + position(v, height) +
         orientation(v) + element(0x28, 2, "US", us(1)) + element(0x28, 4, "CS", "MONOCHROME2") +
         element(0x28, 0x10, "US", us(static_cast<unsigned>(v.size[1]))) +
         element(0x28, 0x11, "US", us(static_cast<unsigned>(v.size[0]))) + spacing(v) +
         element(0x28, 0x100, "US", us(16)) + element(0x28, 0x101, "US", us(16)) + element(0x28, 0x102, "US", us(15)) +
         element(0x28, 0x103, "US", us(1)) + element(0x28, 0x1052, "DS", "-3") + element(0x28, 0x1053, "DS", "2") +
         element(0x7fe0, 0x10, "OW", v.bytes().substr(bytes * static_cast<size_t>(k), bytes));
}

/// Writes a folder of slices at their positions; file names have the reverse order.
std::string series(const TestVolume& v, const std::vector<double>& heights) {
  const std::string folder = test::temporaryPath("series");
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  for (size_t n = 0; n < heights.size(); ++n)
    test::written("series/" + std::to_string(100 - n) + ".dcm", slice(v, static_cast<int>(n) % v.size[2], heights[n]));
  return folder;
}

void expectError(const std::string& path, const std::string& what, const ScanOptions& options = {}) {
  const std::string text = test::errorOf(path, options);
  EXPECT_NE(text.find(what), std::string::npos) << text;
}

TEST_F(Dicom, SlicesAreSortedByPositionAndTiltStays) {
  TestVolume v;
  v.size[2] = 5;
  v.fill();
  v.lps << .5, 0, .5, -10, 0, .5, 0, -20, 0, 0, 2, 30;  // the gantry's tilt: 14.04 degrees
  const auto source = openScan(series(v, {0, 1, 2, 3, 4}));
  Eigen::Matrix3d steps;
  steps << 0, -.0005, 0, .0005, 0, .0005, 0, 0, .002;
  EXPECT_LT((source->frame().axes - steps).norm(), 1e-9) << source->frame().axes;
  EXPECT_LT((source->frame().origin - Vector3d(.020, -.010, .030)).norm(), 1e-9);
  const std::vector<float> all = test::allOf(*source);
  ASSERT_EQ(all.size(), v.voxels.size());
  for (size_t n = 0; n < all.size(); ++n) ASSERT_EQ(all[n], 2 * v.voxels[n] - 3) << n;
}

TEST_F(Dicom, MissingDoubledAndUnevenSlicesAreRefusedWithThePosition) {
  TestVolume v;
  v.size[2] = 5;
  v.fill();
  expectError(series(v, {0, 1, 2, 4, 5}), "slices are missing, 1, between 36.00 and 42.00 mm");
  expectError(series(v, {0, 1, 2, 2, 3}), "two slices have the same position, 36.00 mm");
  expectError(series(v, {0, 1, 2, 3.3, 4}), "uneven slices");
  expectError(series(v, {0}), "SliceThickness");
}

TEST_F(Dicom, SeveralSeriesAreListedAndChosen) {
  TestVolume v;
  const std::string folder = series(v, {0, 1});
  for (int k = 0; k < 2; ++k) test::written("series/b" + std::to_string(k) + ".dcm", slice(v, k, k, "1.2.4"));
  const std::vector<DicomSeries> list = listDicom(folder);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[1].uid, "1.2.4");
  EXPECT_EQ(list[1].description, "made 1.2.4");
  EXPECT_EQ(list[1].files, 2);
  expectError(folder,
              "accepted: all, which joins them, or the number or UID of one: 0: 1.2.3, CT, 2 files, made 1.2.3; 1: ");
  ScanOptions options;
  for (const char* chosen : {"1", "1.2.4"}) {
    options.series = chosen;
    EXPECT_EQ(test::allOf(folder, options).size(), v.voxels.size());
  }
  options.series = "7";
  expectError(folder, "has no series '7'", options);
}

TEST_F(Dicom, SeriesOfASliceEachAreJoined) {
  TestVolume v;
  v.size[2] = 4;
  v.fill();
  const std::string folder = series(v, {0});
  for (int k = 1; k < 4; ++k)
    test::written("series/b" + std::to_string(k) + ".dcm", slice(v, k, k, "1.2.4." + std::to_string(k)));
  ScanOptions options;
  options.series = "all";
  const std::vector<float> all = test::allOf(folder, options);
  ASSERT_EQ(all.size(), v.voxels.size());
  for (size_t n = 0; n < all.size(); ++n) ASSERT_EQ(all[n], 2 * v.voxels[n] - 3) << n;
}

TEST_F(Dicom, MissingSlicesAreFilledWhereThatIsAsked) {
  TestVolume v;
  v.size[2] = 5;
  v.fill();
  std::vector<std::string> notes;
  ScanOptions options;
  options.fill_slices = true;
  options.notes = &notes;
  const std::vector<float> all = test::allOf(series(v, {0, 1, 2, 5, 6}), options);
  const size_t pixels = 12;
  ASSERT_EQ(all.size(), 7 * pixels);
  const int from[] = {0, 1, 2, 2, 3, 3, 4};  // index of the source slice of each
  for (size_t n = 0; n < all.size(); ++n)
    ASSERT_EQ(all[n], 2 * v.voxels[static_cast<size_t>(from[n / pixels]) * pixels + n % pixels] - 3) << n;
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("2 missing slices, of 7, repeat the nearest slice"), std::string::npos) << notes[0];
}

TEST_F(Dicom, MosaicsAreNamed) {
  TestVolume v;
  const std::string folder = series(v, {0, 1});
  std::string mosaic = slice(v, 0, 0);
  mosaic.insert(head().size(), element(8, 8, "CS", "ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC"));
  test::written("series/100.dcm", mosaic);
  expectError(folder, "100.dcm: is a mosaic of slices in one image");
}

TEST_F(Dicom, ValuesInTheUpperBitsAreShifted) {
  TestVolume v;
  const std::string folder = series(v, {0, 1});
  for (int k = 0; k < 2; ++k) {
    TestVolume shifted = v;
    for (int16_t& value : shifted.voxels) value = static_cast<int16_t>(16 * (value - 5));
    const std::string file = slice(shifted, k, k);
    test::written("series/" + std::to_string(100 - k) + ".dcm",
                  test::replaced(file, element(0x28, 0x101, "US", us(16)), element(0x28, 0x101, "US", us(12))));
  }
  const std::vector<float> all = test::allOf(folder);
  for (size_t n = 0; n < all.size(); ++n) ASSERT_EQ(all[n], 2 * (v.voxels[n] - 5) - 3) << n;
}

TEST_F(Dicom, FilesWithoutAnEndingAreKnownByTheirBytes) {
  TestVolume v;
  v.size[2] = 1;
  v.fill();
  std::string one = slice(v, 0, 0);
  one.insert(one.find(us(0x20) + us(0xe)), element(0x18, 0x50, "DS", "3"));
  EXPECT_EQ(test::allOf(test::written("I10", one)).size(), v.voxels.size());
}

TEST_F(Dicom, WhatAFolderHasInsteadOfPicturesIsSaid) {
  const std::string folder = test::temporaryPath("disc");
  std::filesystem::create_directories(folder + "/ST0/SE1");
  test::written("disc/ST0/SE1/I0", slice(TestVolume(), 0, 0));
  const std::string syntax = "1.2.840.10008.1.2.1";
  test::written("disc/DICOMDIR", std::string(128, '\0') + "DICM" + element(2, 2, "UI", "1.2.840.10008.1.3.10") +
                                     element(2, 0x10, "UI", syntax) + element(4, 0x1130, "CS", "DISC"));
  expectError(folder, "DICOMDIR is the index of a medium");
  expectError(folder, "subfolders are not read; name " + folder + "/ST0/SE1");
  const std::string deflated = test::replaced(slice(TestVolume(), 0, 0), syntax + std::string(1, '\0'), syntax + ".99");
  expectError(test::written("deflated.dcm", deflated), "deflated.dcm is a deflated file");
}

TEST_F(Dicom, AFileThatEndsInItsHeaderIsNamed) {
  const std::string whole = slice(TestVolume(), 0, 0);
  for (size_t bytes = 132; bytes < whole.size(); bytes += 9) {
    const std::string folder = series(TestVolume(), {0, 1});
    test::written("series/cut_short.dcm", whole.substr(0, bytes));
    const std::string text = test::errorOf(folder);
    EXPECT_TRUE(text.empty() || text.find("cut_short.dcm") != std::string::npos) << bytes << ": " << text;
  }
}

TEST_F(Dicom, SpoiltFilesEndInOneError) {
  TestVolume v;
  const std::string whole = slice(v, 0, 0);
  const std::string folder = series(v, {0, 1});
  test::written("series/100.dcm", whole.substr(0, whole.size() - 10));
  expectError(folder, "ends early");
  std::filesystem::create_directories(test::temporaryPath("nothing"));
  expectError(test::temporaryPath("nothing"), "no DICOM file");
  expectError(test::written("text.dcm", "hello"), "no DICOM file");
  std::mt19937 random(30);
  for (int n = 0; n < 30; ++n) {
    std::string spoilt = whole;
    for (int edits = 0; edits < 4; ++edits)
      spoilt[132 + random() % (spoilt.size() - 132)] = static_cast<char>(random());
    if (n % 3 == 0) spoilt.resize(132 + random() % (spoilt.size() - 132));
    test::written("series/100.dcm", spoilt);
    test::errorOf("", [&] { test::allOf(folder); });
  }
}

TEST_F(Dicom, AProgramThatIsMissingOrSilentIsSaid) {
  const std::string folder = series(TestVolume(), {0, 1});
  setenv("VISCERA_DICOM", "/no/such/program", 1);
  expectError(folder, "the program viscera-dicom");
  const std::string sleeper = test::written("sleeper", "#!/bin/sh\nexec sleep 100\n");
  std::filesystem::permissions(sleeper, std::filesystem::perms::owner_all);
  setenv("VISCERA_DICOM", sleeper.c_str(), 1);
  DicomLimits limits;
  limits.silence_s = 1;
  EXPECT_NE(test::errorOf(folder, [&] { listDicom(folder, limits); }).find("1 s, which is the limit"),
            std::string::npos);
  const std::string killer = test::written("killer", "#!/bin/sh\nkill -ABRT $$\n");
  std::filesystem::permissions(killer, std::filesystem::perms::owner_all);
  setenv("VISCERA_DICOM", killer.c_str(), 1);
  EXPECT_NE(test::errorOf(folder, [&] { listDicom(folder, limits); }).find("crashed on it"), std::string::npos);
}

TEST_F(Dicom, RealSeriesOfJpeg2000) {
  const std::string folder = test::realData("ct/dicom"), labels = test::realData("ct/example_seg_dicom.nii.gz");
  if (folder.empty() || labels.empty()) GTEST_SKIP() << "ct/ not found; set VISCERA_TEST_DATA";
  const auto source = openScan(folder);
  EXPECT_EQ(source->frame().size, Vector3i(512, 512, 20));
  EXPECT_NEAR(source->frame().axes(2, 2), .002, 1e-9);  // 3 mm thick, 2 mm apart
  const std::vector<float> all = test::allOf(*source);
  EXPECT_LT(*std::min_element(all.begin(), all.end()), -1000);
  // The map of organs of the same series has the same box.
  const VolumeFrame frame = source->frame(), map = openScan(labels)->frame();
  const auto middle = [](const VolumeFrame& f) -> Vector3d {
    return f.axes * (f.size.array() - 1).matrix().cast<double>() / 2 + f.origin;
  };
  EXPECT_LT((middle(frame) - middle(map)).norm(), 1e-3);
}

TEST_F(Dicom, RealSegmentsOverlap) {
  const std::string path = test::realData("dicom_seg/partial_overlaps.dcm"),
                    liver = test::realData("dicom_seg/liver.dcm");
  if (path.empty()) GTEST_SKIP() << "dicom_seg/ not found; set VISCERA_TEST_DATA";
  LabelOptions options;
  std::vector<std::string> notes;
  options.notes = &notes;
  const LabelVolume volume = readLabels(path, options);
  EXPECT_EQ(volume.names.size(), 6U);
  EXPECT_EQ(volume.names[1].name, "GREEN");
  ASSERT_EQ(notes.size(), 1U);  // voxels with several labels
  const LabelVolume one = readLabels(liver), same = readLabels(test::realData("dicom_seg/liver_seg.nrrd"));
  EXPECT_LT((one.frame.origin - same.frame.origin).norm(), 1e-6);
  EXPECT_LT((one.frame.axes - same.frame.axes).norm(), 1e-6);
  EXPECT_EQ(one.labels, same.labels);
}

}  // namespace
}  // namespace viscera
