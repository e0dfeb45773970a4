// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "model/scan/scan_files.h"
#include "model/scan/scan_source.h"

// Left stays left: one volume has the same frame in every format.
namespace viscera {
namespace {

using test::Affine;
using test::TestVolume;

constexpr double kSameFrameM = 1e-6;  ///< NIfTI-1 has float32: 24 bits of 0.1 m

/// Writes one volume in every format. Returns the paths.
std::vector<std::string> inAllFormats(const TestVolume& v) {
  using namespace test;
  const std::string raw = v.bytes();
  std::vector<std::string> paths = {
      written("a.nii", NiftiHeader(v).bytes() + raw),
      written("a.nii.gz", packed(NiftiHeader(v).bytes() + raw)),
      written("two.nii", NiftiHeader(v, 2).bytes() + raw),
      written("big.nii", NiftiHeader(v, 1, true).bytes() + v.bytes(true)),
      written("big_two.nii.gz", packed(NiftiHeader(v, 2, true).bytes() + v.bytes(true))),
      written("gzip.nrrd", nrrdHeader(v, "LPS", "encoding: gzip\n") + packed(raw)),
      written("a.mha", metaHeader(v) + raw),
      written("packed.mha", metaHeader(v, "CompressedData = True\nElementDataFile = LOCAL\n") + packed(raw, false))};
  for (const char* space : {"left-posterior-superior", "right-anterior-superior", "left-anterior-superior"})
    paths.push_back(written(std::string(space) + ".nrrd", nrrdHeader(v, space) + raw));
  written("data.raw", raw);
  paths.push_back(written("apart.nhdr", nrrdHeader(v, "LPS", "encoding: raw\ndata file: data.raw\n")));
  paths.push_back(written("apart.mhd", metaHeader(v, "ElementDataFile = data.raw\n")));
  written("data.zraw", packed(raw, false));
  paths.push_back(written("packed.mhd", metaHeader(v, "CompressedData = True\nElementDataFile = data.zraw\n")));
  return paths;
}

void expectFrame(const TestVolume& v, const Eigen::Matrix3d& steps, const Vector3d& first) {
  const std::vector<float> values(v.voxels.begin(), v.voxels.end());
  for (const std::string& path : inAllFormats(v)) {
    const auto source = openScan(path);
    EXPECT_LT((source->frame().axes - steps).norm(), kSameFrameM) << path << '\n' << source->frame().axes;
    EXPECT_LT((source->frame().origin - first).norm(), kSameFrameM) << path << '\n' << source->frame().origin;
    EXPECT_EQ(test::allOf(*source), values) << path;
  }
}

Eigen::Matrix3d columns(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  Eigen::Matrix3d m;
  m << a, b, c;
  return m;
}

TEST(ScanFrame, StepsOfOneTwoThreeMillimetres) {
  TestVolume v;  // RAS 10 20 30, steps along R, A, S
  v.lps << -1, 0, 0, -10, 0, -2, 0, -20, 0, 0, 3, 30;
  expectFrame(v, columns({0, -.001, 0}, {.002, 0, 0}, {0, 0, .003}), {.020, -.010, .030});
}

TEST(ScanFrame, MirroredStaysMirrored) {
  TestVolume v;
  v.lps << 1, 0, 0, -10, 0, -2, 0, -20, 0, 0, 3, 30;
  expectFrame(v, columns({0, .001, 0}, {.002, 0, 0}, {0, 0, .003}), {.020, -.010, .030});
  const auto source = openScan(test::written("m.nii", test::NiftiHeader(v).bytes() + v.bytes()));
  EXPECT_LT(source->frame().axes.determinant(), 0);
}

TEST(ScanFrame, ObliqueByThirtyDegrees) {
  TestVolume v;
  const double c = std::cos(M_PI / 6), s = 0.5;
  v.lps << 0, .8 * c, -2 * s, 1, -.5, 0, 0, -2, 0, .8 * s, 2 * c, 3;
  expectFrame(v, columns({.0005, 0, 0}, {0, .000693, .0004}, {0, -.001, .001732}), {.002, .001, .003});
}

TEST(ScanFrame, TiltOfTheGantryStaysAShear) {
  TestVolume v;
  v.lps << .5, 0, 0, 0, 0, .5, 0, 0, 0, 0, 2, 0;
  v.lps(0, 2) = 0.5;  // atan(0.5 / 2) = 14.04 degrees
  expectFrame(v, columns({0, .0005, 0}, {-.0005, 0, 0}, {0, .0005, .002}), {0, 0, 0});
}

TEST(ScanFrame, WhatIsAtThePatientsLeftHasPositiveY) {
  TestVolume v;
  v.size[0] = 8;
  v.fill();
  v.lps << -1, 0, 0, 3.5, 0, 1, 0, 0, 0, 0, 1, 0;  // i = 0 is farthest left
  for (int16_t& x : v.voxels) x = 0;
  v.at(0, 1, 1) = v.at(1, 1, 1) = 500;
  for (const std::string& path : inAllFormats(v)) {
    const auto source = openScan(path);
    const std::vector<float> all = test::allOf(*source);
    for (size_t n = 0; n < all.size(); ++n) {
      if (all[n] != 500) continue;
      EXPECT_GT((source->frame().axes * Vector3d(double(n % 8), 1, 1) + source->frame().origin).y(), 0) << path;
    }
  }
}

TEST(ScanFrame, QformIsTakenWithoutSform) {
  TestVolume v;
  v.lps << -1, 0, 0, -10, 0, -2, 0, -20, 0, 0, 3, 30;
  for (const int version : {1, 2}) {
    test::NiftiHeader header(v, version);
    const auto code = [&](bool q, int value) {
      version == 2 ? header.put<int32_t>(0, q ? 344 : 348, value)
                   : header.put<int16_t>(q ? 252 : 254, 0, int16_t(value));
    };
    code(false, 0);
    code(true, 1);
    for (size_t a = 0; a < 3; ++a) header.real(268, 376, a, 10.0 * double(a + 1));
    header.real(76, 104, 0, -1);  // qfac: the third axis is reversed
    const auto source = openScan(test::written("q.nii", header.bytes() + v.bytes()));
    EXPECT_LT((source->frame().axes - columns({0, -.001, 0}, {.002, 0, 0}, {0, 0, -.003})).norm(), kSameFrameM);
    EXPECT_LT((source->frame().origin - Vector3d(.020, -.010, .030)).norm(), kSameFrameM);
    code(false, 1);  // both are present, and they differ
    const std::string path = test::written("both.nii", header.bytes() + v.bytes());
    EXPECT_NE(test::errorOf(path).find("set transform to sform or qform"), std::string::npos);
    ScanOptions given;
    given.transform = "qform";
    EXPECT_LT(openScan(path, given)->frame().axes.determinant(), 0);
    given.transform = "sform";
    EXPECT_GT(openScan(path, given)->frame().axes.determinant(), 0);
    given.transform = "best";
    EXPECT_NE(test::errorOf(path, given).find("accepted: sform or qform"), std::string::npos);
  }
}

TEST(ScanFrame, SformGoesBeforePixdimWithANote) {
  const TestVolume v;
  for (const float said : {0.F, -2.F, 5.F, 1e9F}) {
    for (const int16_t q_code : {0, 1}) {
      test::NiftiHeader header(v);
      for (size_t a = 0; a < 3; ++a) header.real(268, 376, a, v.ras()(static_cast<int>(a), 3));
      header.put<float>(84, 0, said);  // pixdim[2]
      if (said != 5) header.put<int16_t>(252, 0, q_code);
      std::vector<std::string> notes;
      ScanOptions options;
      options.notes = &notes;
      const auto source = openScan(test::written("pixdim.nii", header.bytes() + v.bytes()), options);
      EXPECT_LT((source->frame().axes - columns({0, .001, 0}, {-.002, 0, 0}, {0, 0, .003})).norm(), kSameFrameM);
      ASSERT_EQ(notes.size(), 1U);
      EXPECT_NE(notes[0].find("sform has 1 x 2 x 3 mm; sform is used"), std::string::npos) << notes[0];
    }
  }
}

TEST(ScanFrame, LengthsHaveTheUnitOfTheHeader) {
  for (const auto& [code, per_mm] : {std::pair(1, 1e-3), {3, 1e3}}) {
    TestVolume v;
    v.lps *= per_mm;
    for (const bool with_sform : {true, false}) {
      test::NiftiHeader header(v);
      header.put<uint8_t>(123, 0, static_cast<uint8_t>(code));
      header.put<int16_t>(with_sform ? 254 : 252, 0, 1);
      if (!with_sform) header.put<int16_t>(254, 0, 0);
      const VolumeFrame frame = openScan(test::written("unit.nii", header.bytes() + v.bytes()))->frame();
      EXPECT_LT((frame.spacing_m() - Vector3d(.001, .002, .003)).norm(), kSameFrameM) << code;
      const double off = (frame.origin - Vector3d(.020, -.010, .030)).norm();
      EXPECT_LT(with_sform ? off : 0, kSameFrameM) << code;
    }
  }
}

TEST(ScanFrame, DataOfNrrdBehindLinesAndNamedWithItsFolder) {
  const TestVolume v;
  const std::vector<float> wanted(v.voxels.begin(), v.voxels.end());
  test::written("lines.raw", "one\ntwo\n" + v.bytes());
  const std::string beside = test::nrrdHeader(v, "LPS", "encoding: raw\nline skip: 2\ndata file: ./lines.raw\n");
  EXPECT_EQ(test::allOf(test::written("beside.nhdr", beside)), wanted);
  test::written("packed.nii.gz", test::packed(test::NiftiHeader(v).bytes() + v.bytes()));
  const std::string nifti = test::nrrdHeader(v, "LPS", "encoding: gzip\nbyte skip: 352\ndata file: packed.nii.gz\n");
  EXPECT_EQ(test::allOf(test::written("nifti.nhdr", nifti)), wanted);
}

TEST(ScanFrame, SegmentsWithoutValuesAreNumberedInOneLayer) {
  TestVolume v;
  for (size_t n = 0; n < v.voxels.size(); ++n) v.voxels[n] = static_cast<int16_t>(n % 3);
  const std::string lines = "encoding: raw\nSegment0_Name:=liver\nSegment1_Name:=spleen\n";
  const std::vector<Segment> segments =
      openScan(test::written("other.seg.nrrd", test::nrrdHeader(v, "LPS", lines) + v.bytes()))->segments();
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[0].label.value, 1);
  EXPECT_EQ(segments[1].label.value, 2);
  EXPECT_EQ(segments[1].layer, 0);
}

TEST(ScanFrame, AVolumeOfSeveralKeepsItsDirections) {
  TestVolume v;
  v.lps << 1, 0, 0, -10, 0, -2, 0, -20, 0, 0, 3, 30;  // RAS steps -1 +2 +3
  test::NiftiHeader header(v);
  header.dim(0, 4);
  header.dim(4, 3);
  TestVolume other = v;
  for (int16_t& x : other.voxels) x = static_cast<int16_t>(x + 1000);
  const std::string path =
      test::written("four.nii.gz", test::packed(header.bytes() + v.bytes() + other.bytes() + v.bytes()));
  EXPECT_NE(test::errorOf(path).find("accepted: volume 0 .. 2"), std::string::npos);
  ScanOptions second;
  second.volume = 1;
  EXPECT_EQ(test::allOf(path, second), std::vector<float>(other.voxels.begin(), other.voxels.end()));
  EXPECT_LT((openScan(path, second)->frame().axes - columns({0, .001, 0}, {.002, 0, 0}, {0, 0, .003})).norm(),
            kSameFrameM);
  second.volume = 3;
  EXPECT_NE(test::errorOf(path, second).find("accepted: volume 0 .. 2"), std::string::npos);
}

TEST(ScanFrame, FileWithoutAxesNeedsThemOrIsRefused) {
  const TestVolume v;
  test::NiftiHeader header(v);
  header.put<int16_t>(254, 0, 0);
  ScanOptions given;
  given.axes = "RPS";
  const std::vector<std::string> paths = {
      test::written("none.nii", header.bytes() + v.bytes()),
      test::written("none.nrrd",
                    test::replaced(test::nrrdHeader(v), "space: left-posterior-superior\n", "") + v.bytes()),
      test::written("scanner.nrrd",
                    test::replaced(test::nrrdHeader(v), "left-posterior-superior", "scanner-xyz") + v.bytes())};
  for (const std::string& path : paths) {
    EXPECT_NE(test::errorOf(path).find("set axes"), std::string::npos);
    EXPECT_LT((openScan(path, given)->frame().axes - columns({0, -.001, 0}, {-.002, 0, 0}, {0, 0, .003})).norm(),
              kSameFrameM)
        << path;
    for (const char* wrong : {"RLS", "RA", "XYZ", "ras"}) {
      ScanOptions bad;
      bad.axes = wrong;
      EXPECT_NE(test::errorOf(path, bad).find("accepted: three letters"), std::string::npos);
    }
  }
  const std::string says = test::written("says.nrrd", test::nrrdHeader(v) + v.bytes());
  EXPECT_NE(test::errorOf(says, given).find("remove the key axes"), std::string::npos);
}

TEST(ScanFrame, RealVolumes) {
  const std::string ct = test::realData("ct/example_ct_sm.nii.gz"), nrrd = test::realData("dicom_seg/liver_seg.nrrd");
  if (ct.empty() || nrrd.empty()) GTEST_SKIP() << "ct/ and dicom_seg/ not found; set VISCERA_TEST_DATA";
  const auto source = openScan(ct);
  EXPECT_EQ(source->frame().size, Vector3i(122, 101, 30));
  EXPECT_EQ(test::allOf(*source).size(), 122U * 101 * 30);
  const VolumeFrame liver = openScan(nrrd)->frame();
  EXPECT_LT((liver.origin - Vector3d(.2268, -.2352, -.12869)).norm(), kSameFrameM);
}

}  // namespace
}  // namespace viscera
