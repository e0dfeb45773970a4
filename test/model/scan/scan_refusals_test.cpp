// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include "model/scan/labels.h"
#include "model/scan/scan_files.h"
#include "model/scan/scan_source.h"

// Corrupt files: one clear error each, which names the file, and no memory for data that is not there.
namespace viscera {
namespace {

using test::NiftiHeader;
using test::TestVolume;
using test::written;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void scanRefusalsExpectError(const std::string& path, const std::string& what, const ScanOptions& options = {}) {
  const std::string text = test::errorOf(path, options);
  EXPECT_NE(text.find(what), std::string::npos) << path << " says: " << text << "\n  and not: " << what;
}

/// Returns a NIfTI-1 file corrupted by an edit.
template <typename Edit>
std::string nifti(const std::string& name, Edit&& edit) {
  const TestVolume v;
  NiftiHeader header(v);
  edit(header);
  return written(name, header.bytes() + v.bytes());
}

TEST(ScanRefusals, FilesThatWereCut) {
  const TestVolume v;
  const std::string whole = NiftiHeader(v).bytes() + v.bytes();
  scanRefusalsExpectError(written("half.nii", whole.substr(0, whole.size() - 10)), "ends early");
  scanRefusalsExpectError(written("head.nii", whole.substr(0, 200)), "ends early");
  scanRefusalsExpectError(written("empty.nii", ""), "ends early");
  const std::string gz = test::packed(whole);
  scanRefusalsExpectError(written("cut.nii.gz", gz.substr(0, gz.size() * 6 / 10)), "ends early");
  scanRefusalsExpectError(written("no_sum.nii.gz", gz.substr(0, gz.size() - 4)), "ends early");
  std::string wrong_sum = gz;
  wrong_sum[gz.size() - 8] ^= 1;
  scanRefusalsExpectError(written("sum.nii.gz", wrong_sum), "corrupt");
  const std::string nrrd = test::nrrdHeader(v) + v.bytes();
  scanRefusalsExpectError(written("cut.nrrd", nrrd.substr(0, nrrd.size() - 1)), "ends early");
  const std::string mha = test::metaHeader(v) + v.bytes();
  scanRefusalsExpectError(written("cut.mha", mha.substr(0, mha.size() - 1)), "ends early");
  EXPECT_NE(test::errorOf("no_such.nii").find("no such file"), std::string::npos);
}

TEST(ScanRefusals, PackedDataThatGoOnBeyondTheHeader) {
  const TestVolume v;
  scanRefusalsExpectError(
      written("long.nii.gz", test::packed(NiftiHeader(v).bytes() + v.bytes() + std::string(3 << 20, '\0'))),
      "exceed the size in its header");
  test::allOf(written("two.nii.gz", test::packed(NiftiHeader(v).bytes()) + test::packed(v.bytes())));  // two members
}

TEST(ScanRefusals, OffsetBeyondTheEnd) {
  for (const float offset : {1e6F, 1e30F, -5.F, 100.F, kNan}) {
    const std::string path = nifti("offset.nii", [&](auto& h) { h.template put<float>(108, 0, offset); });
    const std::string text = test::errorOf(path);
    EXPECT_TRUE(text.find("ends early") != std::string::npos || text.find("vox_offset") != std::string::npos) << text;
  }
}

TEST(ScanRefusals, VolumesThatAreNotThereTakeNoMemory) {
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  TestVolume v;
  for (int& n : v.size) n = 800;
  v.voxels.assign(120, 0);
  const std::string raw = v.bytes();
  const auto nhdr = test::nrrdHeader(v), packed = test::nrrdHeader(v, "LPS", "encoding: gzip\n");
  for (const std::string& path :
       {written("a.nii", NiftiHeader(v).bytes() + raw), written("a.nii.gz", test::packed(NiftiHeader(v).bytes() + raw)),
        written("a.nrrd", nhdr + raw), written("b.nrrd", packed + test::packed(raw)),
        written("a.mha", test::metaHeader(v) + raw)})
    scanRefusalsExpectError(path, "ends early");
  for (int& n : v.size) n = 32767;
  scanRefusalsExpectError(written("huge.nii", NiftiHeader(v).bytes() + raw), "accepted: at most 2147483648");
  scanRefusalsExpectError(written("huge.nrrd", test::nrrdHeader(v) + raw), "accepted: at most 2147483648");
  scanRefusalsExpectError(written("huge.mha", test::metaHeader(v) + raw), "accepted: at most 2147483648");
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 50 << 10);  // [KiB]
}

TEST(ScanRefusals, NumbersThatAreNone) {
  scanRefusalsExpectError(nifti("s.nii", [](auto& h) { h.template put<float>(300, 0, kNan); }), "sform");
  for (const float bad : {0.F, kNan, -1.F, 1e-4F, 200.F})
    scanRefusalsExpectError(nifti("p.nii",
                                  [&](auto& h) {
                                    h.template put<float>(84, 0, bad);
                                    h.template put<int16_t>(254, 0, 0);  // only the qform, made of pixdim
                                    h.template put<int16_t>(252, 0, 1);
                                  }),
                            "accepted: 0.001 .. 100 mm");
  scanRefusalsExpectError(nifti("u.nii", [](auto& h) { h.template put<uint8_t>(123, 0, 1); }),
                          "in the unit of xyzt_units: voxels are 1000 mm apart");
  scanRefusalsExpectError(nifti("v.nii", [](auto& h) { h.template put<uint8_t>(123, 0, 5); }), "xyzt_units is 5");
  scanRefusalsExpectError(nifti("d0.nii", [](auto& h) { h.dim(0, 9); }), "accepted: 3 .. 7");
  scanRefusalsExpectError(nifti("d1.nii", [](auto& h) { h.dim(1, 0); }), "accepted: 1 .. 65535");
  scanRefusalsExpectError(nifti("d2.nii", [](auto& h) { h.dim(2, -3); }), "accepted: 1 .. 65535");
  scanRefusalsExpectError(nifti("flat.nii",
                                [](auto& h) {
                                  for (size_t n = 4; n < 8; ++n) h.real(280, 0, n, n == 4);
                                }),
                          "accepted:");
  const TestVolume v;
  const std::string nrrd = test::nrrdHeader(v), mha = test::metaHeader(v);
  scanRefusalsExpectError(written("d.nrrd", test::replaced(nrrd, "(1,0,0)", "(nan,0,0)") + v.bytes()),
                          "accepted: 12 finite");
  scanRefusalsExpectError(written("z.nrrd", test::replaced(nrrd, "(1,0,0)", "(0,0,0)") + v.bytes()),
                          "accepted: 0.001 .. 100 mm");
  scanRefusalsExpectError(written("p.nrrd", test::replaced(nrrd, "(1,0,0)", "(0,1,0)") + v.bytes()), "one plane");
  scanRefusalsExpectError(written("s.mha", test::replaced(mha, "ElementSpacing = 1", "ElementSpacing = 0") + v.bytes()),
                          "0.001 .. 100 mm");
  scanRefusalsExpectError(
      written("w.mha", test::replaced(mha, "ElementSpacing = 1", "ElementSpacing = one") + v.bytes()), "3 numbers");
}

TEST(ScanRefusals, WhatIsNotReadIsNamed) {
  const TestVolume v;
  const std::string list = test::nrrdHeader(v, "LPS", "encoding: raw\n");
  scanRefusalsExpectError(written("list.nhdr", list.substr(0, list.size() - 1) + "data file: LIST\na.raw\nb.raw\n"),
                          "'data file: LIST'; accepted: the name of one file");
  scanRefusalsExpectError(written("pair.hdr", ""), "pairs of .hdr and .img are not read");
  const std::string mha = test::replaced(test::metaHeader(v), "ElementDataFile = LOCAL\n", "");
  scanRefusalsExpectError(written("no_data.mha", mha + std::string(2000, 'x')), "has no ElementDataFile");
  scanRefusalsExpectError(written("what.xyz", "hello"), "accepted: .nii, .nii.gz");
}

TEST(ScanRefusals, SlopesAsTheStandardSays) {
  const TestVolume v;
  const std::vector<float> plain(v.voxels.begin(), v.voxels.end());
  for (const float slope : {0.F, kNan}) {
    const std::string path = nifti("slope.nii", [&](auto& h) {
      h.template put<float>(112, 0, slope);
      h.template put<float>(116, 0, 5);
    });
    EXPECT_EQ(test::allOf(path), plain);
  }
  const std::string path = nifti("slope.nii", [&](auto& h) {
    h.template put<float>(112, 0, 2);
    h.template put<float>(116, 0, 5);
  });
  EXPECT_EQ(test::allOf(path)[3], 2 * plain[3] + 5);
  scanRefusalsExpectError(nifti("inter.nii",
                                [](auto& h) {
                                  h.template put<float>(112, 0, 2);
                                  h.template put<float>(116, 0, kNan);
                                }),
                          "scl_inter");
}

TEST(ScanRefusals, ColoursAndKindsThatAreNotRead) {
  scanRefusalsExpectError(nifti("rgb.nii", [](auto& h) { h.template put<int16_t>(70, 0, 128); }), "colours");
  scanRefusalsExpectError(nifti("complex.nii", [](auto& h) { h.template put<int16_t>(70, 0, 32); }),
                          "accepted: one number per voxel");
  scanRefusalsExpectError(nifti("pair.nii", [](auto& h) { h.template put<uint8_t>(345, 0, 'i'); }),
                          "not a NIfTI file with its data inside");
  const TestVolume v;
  const std::string nrrd = test::nrrdHeader(v), mha = test::metaHeader(v);
  scanRefusalsExpectError(written("k.nrrd", test::replaced(nrrd, "kinds: domain", "kinds: RGB-color") + v.bytes()),
                          "accepted: domain");
  scanRefusalsExpectError(written("e.nrrd", test::replaced(nrrd, "encoding: raw", "encoding: bzip2") + v.bytes()),
                          "accepted: raw or gzip");
  scanRefusalsExpectError(
      written("u.nrrd", test::replaced(nrrd, "endian", "space units: \"m\" \"m\" \"m\"\nendian") + v.bytes()),
      "\"mm\"");
  scanRefusalsExpectError(written("n.nrrd", test::replaced(nrrd, "endian: little\n", "") + v.bytes()), "no 'endian'");
  scanRefusalsExpectError(written("t.mha", test::replaced(mha, "MET_SHORT", "MET_OTHER") + v.bytes()),
                          "accepted: MET_UCHAR");
  scanRefusalsExpectError(written("c.mha", "ElementNumberOfChannels = 3\n" + mha + v.bytes()), "one number per voxel");
  scanRefusalsExpectError(written("a.xyz", "x"), "accepted: .nii");
  scanRefusalsExpectError(written("text.nrrd", "hello\n\n"), "not a NRRD file");
  scanRefusalsExpectError(written("text.mha", "hello\n\n"), "not a MetaImage file");
  scanRefusalsExpectError(written("text.nii", std::string(400, 'x')), "not a NIfTI file");
}

TEST(ScanRefusals, DataFilesOutsideOfTheFolder) {
  const TestVolume v;
  const std::string raw = written("data.raw", v.bytes());
  std::filesystem::create_directories(test::temporaryPath("inner"));
  const std::string inside = test::temporaryPath("inner/link.raw");
  std::filesystem::remove(inside);
  std::filesystem::create_symlink(raw, inside);
  for (const std::string& name :
       {std::string("/etc/passwd"), std::string("../../etc/passwd"), std::string("../data.raw"), std::string(".."),
        std::string("link.raw"), std::string("not_there.raw")}) {
    scanRefusalsExpectError(
        written("inner/a.nhdr", test::nrrdHeader(v, "LPS", "encoding: raw\ndata file: " + name + "\n")),
        "accepted: the plain name");
    scanRefusalsExpectError(written("inner/a.mhd", test::metaHeader(v, "ElementDataFile = " + name + "\n")),
                            "accepted: the plain name");
  }
  for (const char* name : {"LIST", "slice%03d.raw 1 2 1"}) {
    scanRefusalsExpectError(
        written("l.nhdr", test::nrrdHeader(v, "LPS", std::string("encoding: raw\ndata file: ") + name + "\n")),
        "lists of slices");
    scanRefusalsExpectError(written("l.mhd", test::metaHeader(v, std::string("ElementDataFile = ") + name + "\n")),
                            "lists of slices");
  }
}

TEST(ScanRefusals, ValuesThatAreNoNumbersStayNone) {
  TestVolume v;
  std::string raw(v.voxels.size() * 4, '\0');
  std::memcpy(&raw[4 * 5], &kNan, 4);
  const std::string path = written("nan.nrrd", test::replaced(test::nrrdHeader(v), "short", "float") + raw);
  const std::vector<float> all = test::allOf(path);
  EXPECT_TRUE(std::isnan(all[5]));
  EXPECT_NE(test::errorOf(path, [&] { readLabels(path); }).find("not a label map"), std::string::npos);
}

/// Flips bits and cuts off ends, by seed: the result is an error that names the file, or values, within a short time.
TEST(ScanRefusals, SeededFuzzOfEveryReader) {
  const TestVolume v;
  const std::string raw = v.bytes(),
                    seg = "encoding: gzip\nSegment0_LabelValue:=7\nSegment0_Name:=liver\nSegment0_Layer:=0\n";
  const std::pair<const char*, std::string> good[] = {
      {"f.nii", NiftiHeader(v).bytes() + raw},
      {"two.nii", NiftiHeader(v, 2).bytes() + raw},
      {"f.nii.gz", test::packed(NiftiHeader(v).bytes() + raw)},
      {"f.nrrd", test::nrrdHeader(v) + raw},
      {"f.seg.nrrd", test::nrrdHeader(v, "LPS", seg) + test::packed(raw)},
      {"f.mha", test::metaHeader(v) + raw},
      {"z.mha", test::metaHeader(v, "CompressedData = True\nElementDataFile = LOCAL\n") + test::packed(raw, false)}};
  const char* given = std::getenv("VISCERA_FUZZ_CASES");
  const int cases = given ? std::atoi(given) : 400;
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  for (const auto& [name, bytes] : good) {
    std::mt19937 random(30);
    int refused = 0;
    for (int n = 0; n < cases; ++n) {
      std::string spoilt = bytes;
      const size_t header = std::min<size_t>(spoilt.size(), 600);
      for (unsigned edits = 1 + random() % 3; edits > 0; --edits) {
        const size_t at = random() % (random() % 4 ? header : spoilt.size());
        const unsigned kind = random() % 4;
        if (kind == 0) spoilt[at] = static_cast<char>(random());
        if (kind == 1) spoilt[at] = static_cast<char>(spoilt[at] ^ (1 << random() % 8));
        if (kind == 2) spoilt[at] = "0123456789-.,() \n:="[random() % 19];
        if (kind == 3 && random() % 3 == 0) spoilt.resize(std::max<size_t>(at, 1));
        if (spoilt.size() < header) break;
      }
      const std::string path = written(name, spoilt);
      refused += !test::errorOf(path).empty();
      test::errorOf(path, [&] { readLabels(path); });
    }
    EXPECT_GT(refused, cases / 8) << name;
  }
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 400 << 10);  // [KiB]; the address sanitizer keeps freed memory
}

}  // namespace
}  // namespace viscera
