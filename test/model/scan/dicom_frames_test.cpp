// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "model/scan/dicom_files.h"
#include "model/scan/labels.h"

// DICOM files of several frames: enhanced images and segments.
namespace viscera {
namespace {

using namespace test::dicom;
using test::TestVolume;

constexpr const char* kEnhancedCt = "1.2.840.10008.5.1.4.1.1.2.1";
constexpr const char* kSegmentation = "1.2.840.10008.5.1.4.1.1.66.4";

/// Returns a file of frames. @param groups  of each frame   @param bits  per voxel: 16, or 1 for segments
/// @param measures  elements in addition to PixelSpacing
std::string frames(const TestVolume& v, const std::string& kind, const std::string& segments,
                   const std::vector<std::string>& groups, unsigned bits, const std::string& pixels,
                   const std::string& measures = "") {
  const std::string shared = sequence(0x20, 0x9116, {orientation(v)}) + sequence(0x28, 0x9110, {measures + spacing(v)});
  const auto size = [&](int axis) { return us(static_cast<unsigned>(v.size[axis])); };
  return head() + element(8, 0x16, "UI", kind) + element(8, 0x60, "CS", "CT") + element(0x20, 0xe, "UI", "1.2.3") +
         element(0x28, 2, "US", us(1)) + element(0x28, 4, "CS", "MONOCHROME2") +
         element(0x28, 8, "IS", std::to_string(groups.size())) + element(0x28, 0x10, "US", size(1)) +
         element(0x28, 0x11, "US", size(0)) + element(0x28, 0x100, "US", us(bits)) +
         element(0x28, 0x101, "US", us(bits)) + element(0x28, 0x102, "US", us(bits - 1)) +
         element(0x28, 0x103, "US", us(bits > 1)) + segments + sequence(0x5200, 0x9229, {shared}) +
         sequence(0x5200, 0x9230, groups) + element(0x7fe0, 0x10, bits > 1 ? "OW" : "OB", pixels);
}

/// @param places  positions of the frames along the third axis
std::string enhanced(const TestVolume& v, const std::vector<double>& heights, const std::string& pixels) {
  std::vector<std::string> groups;
  for (const double height : heights)
    groups.push_back(sequence(0x20, 0x9113, {position(v, height)}) +
                     sequence(0x28, 0x9145, {element(0x28, 0x1052, "DS", "-3") + element(0x28, 0x1053, "DS", "2")}));
  return frames(v, kEnhancedCt, "", groups, 16, pixels);
}

TEST_F(Dicom, FramesOfOneFileAreSortedByPosition) {
  TestVolume v;
  v.size[2] = 4;
  v.fill();
  const size_t bytes = 2 * static_cast<size_t>(v.size[0] * v.size[1]);
  std::string backwards;
  for (size_t k = 4; k-- > 0;) backwards += v.bytes().substr(k * bytes, bytes);
  const std::string path = test::written("enhanced.dcm", enhanced(v, {3, 2, 1, 0}, backwards));
  const auto source = openScan(path);
  EXPECT_EQ(source->frame().size, Vector3i(4, 3, 4));
  EXPECT_LT((source->frame().origin - Vector3d(.020, -.010, .030)).norm(), 1e-9);
  const std::vector<float> all = test::allOf(*source);
  ASSERT_EQ(all.size(), v.voxels.size());
  for (size_t n = 0; n < all.size(); ++n) ASSERT_EQ(all[n], 2 * v.voxels[n] - 3) << n;
  const std::string missing = test::written("missing.dcm", enhanced(v, {4, 2, 1, 0}, backwards));
  EXPECT_NE(test::errorOf(missing).find("slices are missing"), std::string::npos);
  const std::string cut = test::written("cut.dcm", enhanced(v, {3, 2, 1, 0}, backwards.substr(bytes)));
  EXPECT_NE(test::errorOf(cut).find("ends early"), std::string::npos);
}

TEST_F(Dicom, SegmentsOfBitsMayOverlap) {
  TestVolume v;                                                                         // 4 x 3 x 2
  const std::string red = element(0x62, 0xd, "US", us(35579) + us(53662) + us(50857));  // L* 54.29, a* 80.8, b* 69.9
  const auto segment = [&](unsigned value, const std::string& name) {
    return element(0x62, 4, "US", us(value)) + element(0x62, 5, "LO", name) + (value == 1 ? red : "");
  };
  const auto group = [&](double height, unsigned value) {
    return sequence(0x20, 0x9113, {position(v, height)}) + sequence(0x62, 0xa, {element(0x62, 0xb, "US", us(value))});
  };
  // Label 1: voxels 0 to 5 of the first slice. Label 7: voxels 4 to 7 of it, and voxel 0 of the second slice.
  const std::vector<std::string> groups = {group(0, 1), group(0, 7), group(1, 7)};
  const uint64_t bits = 0x3f | uint64_t{0xf0} << 12 | uint64_t{1} << 24;
  const std::string names =
      element(0x62, 1, "CS", "BINARY") + sequence(0x62, 2, {segment(1, "liver"), segment(7, "duct")});
  const std::string path = test::written("segments.dcm", frames(v, kSegmentation, names, groups, 1, number(bits, 6)));
  LabelOptions options;
  std::vector<std::string> notes;
  options.notes = &notes;
  const LabelVolume map = readLabels(path, options);
  ASSERT_EQ(map.names.size(), 3U);
  EXPECT_EQ(map.names[1].name, "liver");
  EXPECT_EQ(map.names[2].name, "duct");
  constexpr double kByte = 1.5 / 255;  // [-] a byte of sRGB, and Lab to four digits
  ASSERT_TRUE(map.names[1].color.has_value());
  EXPECT_LT((*map.names[1].color - Vector3d(1, 0, 0)).cwiseAbs().maxCoeff(), kByte) << map.names[1].color->transpose();
  EXPECT_FALSE(map.names[2].color.has_value());
  EXPECT_EQ(map.frame.size, Vector3i(4, 3, 2));
  std::vector<uint8_t> expected(24, 0);
  std::fill_n(expected.begin(), 6, 1);
  std::fill_n(expected.begin() + 6, 2, 2);
  expected[12] = 2;
  EXPECT_EQ(map.labels, expected);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("2 voxels have several labels"), std::string::npos) << notes[0];
  options.labels = {"duct"};
  const LabelVolume duct = readLabels(path, options);
  EXPECT_EQ(std::count(duct.labels.begin(), duct.labels.end(), 1), 5);
}

/// Returns a file of one segment with frames at these heights, in steps of the volume's third axis.
std::string segmentAt(const TestVolume& v, const std::vector<double>& heights, const std::string& measures) {
  std::vector<std::string> groups;
  for (const double height : heights)
    groups.push_back(sequence(0x20, 0x9113, {position(v, height)}) +
                     sequence(0x62, 0xa, {element(0x62, 0xb, "US", us(1))}));
  const std::string names = element(0x62, 1, "CS", "BINARY") +
                            sequence(0x62, 2, {element(0x62, 4, "US", us(1)) + element(0x62, 5, "LO", "liver")});
  const size_t bytes = (12 * heights.size() + 7) / 8;
  return frames(v, kSegmentation, names, groups, 1, std::string(bytes + bytes % 2, '\xff'), measures);
}

TEST_F(Dicom, PositionsOfSegmentsGoBeforeWhatIsSaidOfTheirStep) {
  TestVolume v;
  v.lps.col(2) = Eigen::Vector3d(0, 0, 1.25);
  const std::string thick = element(0x18, 0x50, "DS", "2.0"), thin = element(0x18, 0x50, "DS", "0.625"),
                    between = element(0x18, 0x88, "DS", "0.625");
  for (const std::string& measures : {std::string(), thick, thin, between, thick + between}) {
    const auto source = openScan(test::written("even.dcm", segmentAt(v, {0, 1, 2, 3}, measures)));
    EXPECT_EQ(source->frame().size.z(), 4);
    EXPECT_NEAR(source->frame().axes.col(2).norm(), 1.25e-3, 1e-9);
  }
  const auto slices = [&](const std::vector<double>& heights, const std::string& measures) {
    const auto source = openScan(test::written("gaps.dcm", segmentAt(v, heights, measures)));
    return source->frame().size.z();
  };
  EXPECT_EQ(slices({0, 1, 4, 5}, thick), 6) << "two slices without the segment";
  EXPECT_EQ(slices({0, 2, 5}, thin), 6) << "no two frames are neighbours";
  EXPECT_EQ(slices({0, 5, 9}, element(0x18, 0x88, "DS", "1.25")), 10) << "positions leave it open";
  const std::string uneven = test::written("uneven.dcm", segmentAt(v, {0, 1, 2.3, 3}, thin));
  EXPECT_NE(test::errorOf(uneven).find("uneven.dcm: uneven slices"), std::string::npos) << test::errorOf(uneven);
}

}  // namespace
}  // namespace viscera
