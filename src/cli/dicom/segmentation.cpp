// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gdcmReader.h>

#include <algorithm>
#include <map>

#include "cli/dicom/frames.h"
#include "cli/dicom/tags.h"
#include "math/srgb.h"

namespace viscera::dicom {
namespace {

using gdcm::Tag;

/// Bits or bytes of all frames, consecutive and without gaps.
struct Planes {
  std::vector<char> bytes;
  size_t pixels = 0;
  bool bits = true;
  int half = 1;  ///< least byte value that belongs to the segment

  bool at(size_t frame, size_t pixel) const {
    const size_t n = frame * pixels + pixel;
    return bits ? bytes[n / 8] >> (n % 8) & 1 : static_cast<unsigned char>(bytes[n]) >= half;
  }
};

Planes planesOf(const std::string& file, const gdcm::File& read, const std::vector<Frame>& frames) {
  const gdcm::DataSet& data = read.GetDataSet();
  Planes planes;
  planes.bits = shortOf(data, Tag(0x0028, 0x0100)) == 1;
  planes.pixels = static_cast<size_t>(frames[0].rows) * static_cast<size_t>(frames[0].columns);
  const int most = shortOf(data, Tag(0x0062, 0x000e));  // MaximumFractionalValue
  if (!planes.bits) planes.half = std::max(1, (most + 1) / 2);
  const gdcm::TransferSyntax& syntax = read.GetHeader().GetDataSetTransferSyntax();
  const gdcm::ByteValue* bytes =
      data.FindDataElement(Tag(0x7fe0, 0x0010)) ? data.GetDataElement(Tag(0x7fe0, 0x0010)).GetByteValue() : nullptr;
  if (syntax.IsEncapsulated() || !bytes)
    throw SceneError(file + ": segments of transfer syntax " + syntax.GetString() +
                     "; accepted: uncompressed segments");
  const size_t needed = planes.bits ? (planes.pixels * frames.size() + 7) / 8 : planes.pixels * frames.size();
  if (bytes->GetLength() < needed)
    throw SceneError(file + ": ends early: " + std::to_string(needed) + " bytes of pixels are announced, and it has " +
                     std::to_string(bytes->GetLength()));
  planes.bytes.assign(bytes->GetPointer(), bytes->GetPointer() + bytes->GetLength());
  return planes;
}

/// Returns a segment's RecommendedDisplayCIELabValue as "red green blue", bytes in sRGB; "-1 -1 -1" without one.
std::string colorOf(const gdcm::DataSet& segment) {
  constexpr double kMost = 65535, kLStar = 100, kABStar = 255, kABZero = 128;  // PS3.3 C.10.7.1.1
  const std::vector<int> lab = shortsOf(segment, Tag(0x0062, 0x000d));
  if (lab.size() != 3) return "-1 -1 -1";
  const double y = (lab[0] / kMost * kLStar + 16) / 116;
  const Vector3d f(y + (lab[1] / kMost * kABStar - kABZero) / 500, y, y - (lab[2] / kMost * kABStar - kABZero) / 200);
  const auto linear = [](double t) { return t > 6.0 / 29 ? t * t * t : 3 * (6.0 / 29) * (6.0 / 29) * (t - 4.0 / 29); };
  const Vector3d xyz = Vector3d(0.9642, 1, 0.8249).cwiseProduct(f.unaryExpr(linear));  // D50, the white of ICC profiles
  Matrix3d to_rgb;                                                                     // linear sRGB, adapted to D50
  to_rgb << 3.1339, -1.6169, -0.4906, -0.9788, 1.9161, 0.0335, 0.0719, -0.2290, 1.4052;
  std::string out;
  for (const double channel : Vector3d(to_rgb * xyz))
    out += (out.empty() ? "" : " ") + std::to_string(srgbByte(channel));
  return out;
}

}  // namespace

void writeSegmentation(const std::string& file, int layer) {
  requireWhole(file);
  gdcm::Reader reader;
  reader.SetFileName(file.c_str());
  if (!reader.Read()) throw SceneError(file + ": not a DICOM file");
  std::vector<gdcm::SmartPointer<gdcm::SequenceOfItems>> kept;
  std::vector<std::string> lines;
  std::vector<int> numbers;
  for (const gdcm::DataSet* item : itemsOf(reader.GetFile().GetDataSet(), Tag(0x0062, 0x0002), kept)) {
    numbers.push_back(shortOf(*item, Tag(0x0062, 0x0004)));
    lines.push_back(std::to_string(lines.size()) + " " + std::to_string(numbers.back()) + " " + colorOf(*item) + " " +
                    textOf(*item, Tag(0x0062, 0x0005)).substr(0, 64));
  }
  std::vector<Frame> frames = framesOf(file);
  if (numbers.empty()) throw SceneError(file + ": has no segments; it needs a SegmentSequence");
  if (layer < 0 || static_cast<size_t>(layer) >= numbers.size())
    throw SceneError(file + ": has no layer " + std::to_string(layer) + "; accepted: 0 .. " +
                     std::to_string(numbers.size() - 1));
  const Planes planes = planesOf(file, reader.GetFile(), frames);
  Stack stack = stackOf(frames);
  std::vector<Frame> positions;  // one for each height: segments have frames of their own
  for (const Frame& frame : frames)
    if (positions.empty() || frame.height() - positions.back().height() > 0.01) positions.push_back(frame);
  stack.axes.col(2) = stepOf(positions, true);
  const std::vector<int> slices = slicesOf(frames, stack.axes.col(2));
  stack.size[2] = slices.back() + 1;
  std::multimap<int, const Frame*> of_layer;
  for (size_t n = 0; n < frames.size(); ++n)
    if (frames[n].segment == numbers[static_cast<size_t>(layer)]) of_layer.emplace(slices[n], &frames[n]);
  writeHeader(stack, static_cast<int>(numbers.size()), lines);
  std::vector<float> values(planes.pixels);
  for (int k = 0; k < stack.size[2]; ++k) {
    std::fill(values.begin(), values.end(), 0.F);
    const auto [begin, end] = of_layer.equal_range(k);
    for (auto frame = begin; frame != end; ++frame)
      for (size_t n = 0; n < values.size(); ++n)
        if (planes.at(frame->second->index, n)) values[n] = static_cast<float>(numbers[static_cast<size_t>(layer)]);
    writeSlice(values);
  }
}

}  // namespace viscera::dicom
