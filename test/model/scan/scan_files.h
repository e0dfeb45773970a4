// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zlib.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "model/mesh_samples.h"
#include "model/scan/scan_source.h"
#include "viscera/math/error.h"

// Small writers of scan formats, independent of the readers.
namespace viscera::test {

using Affine = Eigen::Matrix<double, 3, 4>;

/// Signed 16-bit voxels, i fastest, and their positions in LPS [mm].
struct TestVolume {
  int size[3] = {4, 3, 2};
  Affine lps = (Affine() << 1, 0, 0, -10, 0, 2, 0, -20, 0, 0, 3, 30).finished();
  std::vector<int16_t> voxels;

  TestVolume() { fill(); }
  void fill() {
    voxels.resize(static_cast<size_t>(size[0]) * static_cast<size_t>(size[1]) * static_cast<size_t>(size[2]));
    for (size_t n = 0; n < voxels.size(); ++n) voxels[n] = static_cast<int16_t>(n * 7 % 1000);
  }
  int16_t& at(int i, int j, int k) {
    return voxels[static_cast<size_t>(i) + static_cast<size_t>(size[0]) * static_cast<size_t>(j + size[1] * k)];
  }
  std::string bytes(bool big_endian = false) const {
    std::string text;
    for (const int16_t v : voxels) {
      const auto u = static_cast<uint16_t>(v);
      const char low = static_cast<char>(u & 255), high = static_cast<char>(u >> 8);
      text += big_endian ? std::string{high, low} : std::string{low, high};
    }
    return text;
  }
  Affine ras() const { return Vector3d(-1, -1, 1).asDiagonal() * lps; }
};

inline std::string written(const std::string& name, const std::string& bytes) {
  const std::string path = temporaryPath(name);
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return path;
}

/// Compresses bytes as gzip, or as zlib without a gzip header.
inline std::string packed(const std::string& bytes, bool gzip = true) {
  z_stream z{};
  deflateInit2(&z, 6, Z_DEFLATED, gzip ? 31 : 15, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&z, bytes.size()) + 64, '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = static_cast<uInt>(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = static_cast<uInt>(out.size());
  deflate(&z, Z_FINISH);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

/// NIfTI header with fields that tests may corrupt.
class NiftiHeader {
 public:
  explicit NiftiHeader(const TestVolume& v, int version = 1, bool big = false) : second_(version == 2), big_(big) {
    bytes_.assign(second_ ? 544 : 352, '\0');
    put<int32_t>(0, 0, second_ ? 540 : 348);
    const char* magic = second_ ? "n+2\0\r\n\032\n" : "n+1\0";
    std::memcpy(&bytes_[second_ ? 4 : 344], magic, second_ ? 8 : 4);
    dim(0, 3);
    for (size_t a = 0; a < 3; ++a) dim(a + 1, v.size[a]);
    for (size_t a = 4; a < 8; ++a) dim(a, 1);
    put<int16_t>(70, 12, 4);
    put<int16_t>(72, 14, 16);
    real(76, 104, 0, 1);
    const Affine ras = v.ras();
    for (int a = 0; a < 3; ++a) real(76, 104, static_cast<size_t>(a) + 1, ras.col(a).norm());
    second_ ? put<int64_t>(168, 168, 544) : put<float>(108, 108, 352);
    second_ ? put<int32_t>(0, 500, 2) : put<uint8_t>(123, 0, 2);
    second_ ? put<int32_t>(0, 348, 1) : put<int16_t>(254, 0, 1);
    for (int n = 0; n < 12; ++n) real(280, 400, static_cast<size_t>(n), ras(n / 4, n % 4));
  }
  void dim(size_t n, int64_t value) {
    second_ ? put<int64_t>(0, 16 + 8 * n, value) : put<int16_t>(40 + 2 * n, 0, static_cast<int16_t>(value));
  }
  void real(size_t position1, size_t position2, size_t n, double value) {
    second_ ? put<double>(0, position2 + 8 * n, value) : put<float>(position1 + 4 * n, 0, static_cast<float>(value));
  }
  template <typename T>
  void put(size_t position1, size_t position2, T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    for (size_t b = 0; b < sizeof(T); ++b)
      bytes_[(second_ ? position2 : position1) + b] = raw[big_ ? sizeof(T) - 1 - b : b];
  }
  const std::string& bytes() const { return bytes_; }

 private:
  bool second_, big_;
  std::string bytes_;
};

inline std::string row(const Affine& m, int column) {
  std::ostringstream text;
  text.precision(17);
  text << '(' << m(0, column) << ',' << m(1, column) << ',' << m(2, column) << ')';
  return text.str();
}

/// Returns a NRRD header. @param lines  more lines, such as keys of segments or `data file`; the volume is in the named
/// space
inline std::string nrrdHeader(const TestVolume& v, const std::string& space = "left-posterior-superior",
                              const std::string& lines = "encoding: raw\n") {
  const double sign_x = space[0] == 'r' ? -1 : 1, sign_y = space.find("anterior") != std::string::npos ? -1 : 1;
  const Affine m = Vector3d(sign_x, sign_y, 1).asDiagonal() * v.lps;
  std::ostringstream text;
  text << "NRRD0005\n# of a test\ntype: short\ndimension: 3\nspace: " << space << "\nsizes: " << v.size[0] << ' '
       << v.size[1] << ' ' << v.size[2] << "\nspace directions: " << row(m, 0) << ' ' << row(m, 1) << ' ' << row(m, 2)
       << "\nkinds: domain domain domain\nendian: little\nspace origin: " << row(m, 3) << '\n'
       << lines << '\n';
  return text.str();
}

inline std::string metaHeader(const TestVolume& v, const std::string& lines = "ElementDataFile = LOCAL\n") {
  std::ostringstream text;
  text.precision(17);
  text << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nTransformMatrix =";
  for (int a = 0; a < 3; ++a)
    for (int c = 0; c < 3; ++c) text << ' ' << v.lps(c, a) / v.lps.col(a).norm();
  text << "\nOffset = " << v.lps(0, 3) << ' ' << v.lps(1, 3) << ' ' << v.lps(2, 3) << "\nElementSpacing =";
  for (int a = 0; a < 3; ++a) text << ' ' << v.lps.col(a).norm();
  text << "\nDimSize = " << v.size[0] << ' ' << v.size[1] << ' ' << v.size[2] << "\nElementType = MET_SHORT\n" << lines;
  return text.str();
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// Returns all voxels, slice by slice.
inline std::vector<float> allOf(SliceSource& source) {
  std::vector<float> all, slice;
  for (int k = 0; k < source.frame().size.z(); ++k) {
    source.next(slice);
    all.insert(all.end(), slice.begin(), slice.end());
  }
  return all;
}
inline std::vector<float> allOf(const std::string& path, const ScanOptions& options = {}) {
  return allOf(*openScan(path, options));
}

/// Returns the message of an error, which must name the file; empty: there was none.
inline std::string errorOf(const std::string& path, const std::function<void()>& act) {
  try {
    act();
  } catch (const SceneError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find(path), std::string::npos) << text;
    return text;
  }
  return "";
}
inline std::string errorOf(const std::string& path, const ScanOptions& options = {}) {
  return errorOf(path, [&] { allOf(path, options); });
}

}  // namespace viscera::test
