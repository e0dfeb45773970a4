// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gdcmImageReader.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "cli/dicom/frames.h"
#include "cli/dicom/tags.h"

namespace viscera::dicom {
using gdcm::Tag;

constexpr uint64_t kMostTail = 1 << 20;  ///< size of a file's end in which compressed pixels must end [bytes]

void requireWhole(const std::string& file) {
  nowReading(file);
  std::ifstream head(file, std::ios::binary);
  gdcm::Reader reader;
  reader.SetStream(head);
  if (!reader.ReadUpToTag(Tag(0x7fe0, 0x0010), {Tag(0x7fe0, 0x0010)})) throw SceneError(file + ": not a DICOM file");
  const gdcm::DataSet& data = reader.GetFile().GetDataSet();
  const gdcm::TransferSyntax& syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
  const auto count = numbersOf(data, Tag(0x0028, 0x0008));
  const uint64_t pixels = uint64_t(shortOf(data, Tag(0x0028, 0x0010))) * uint64_t(shortOf(data, Tag(0x0028, 0x0011))) *
                          uint64_t(std::max(1, shortOf(data, Tag(0x0028, 0x0002)))) *
                          uint64_t(count.empty() ? 1 : std::max(1.0, count[0]));
  const uint64_t bytes = (pixels * uint64_t(shortOf(data, Tag(0x0028, 0x0100))) + 7) / 8;
  head.clear();
  const uint64_t size = std::filesystem::file_size(file), at = static_cast<uint64_t>(head.tellg());
  if (!syntax.IsEncapsulated()) {
    if (size < at + bytes)
      throw SceneError(file + ": ends early: " + std::to_string(bytes) +
                       " bytes of pixels are announced, and it has at most " +
                       std::to_string(size - std::min(size, at)));
    return;
  }
  const uint64_t tail = std::min<uint64_t>(size, kMostTail);
  std::string end(tail, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(static_cast<std::streamoff>(size - tail));
  stream.read(end.data(), static_cast<std::streamsize>(tail));
  if (end.find(std::string("\xfe\xff\xdd\xe0\0\0\0\0", 8)) == std::string::npos)
    throw SceneError(file + ": ends early: the end of its compressed pixels is missing");
}

namespace {

struct Rescale {
  double slope = 1, intercept = 0;
  int shift = 0;  ///< number of bits below the lowest stored bit
};

template <typename T>
void convert(const char* from, const Rescale& rescale, std::vector<float>& values) {
  const auto [slope, intercept, shift] = rescale;
  for (float& value : values) {
    T x;
    std::memcpy(&x, from, sizeof(T));
    from += sizeof(T);
    x = static_cast<T>(x >> shift);
    value = static_cast<float>(static_cast<double>(x) * slope + intercept);
  }
}

/// Returns the number of bits below the lowest stored bit, for uncompressed pixels.
int shiftOf(const gdcm::File& file) {
  if (file.GetHeader().GetDataSetTransferSyntax().IsEncapsulated()) return 0;
  const gdcm::DataSet& data = file.GetDataSet();
  return std::max(0, shortOf(data, Tag(0x0028, 0x0102)) + 1 - shortOf(data, Tag(0x0028, 0x0101)));
}

/// Pixels of a file. Those of the last requested file are kept.
class Pixels {
 public:
  void slice(const Frame& frame, std::vector<float>& values) {
    if (frame.file != file_) open(frame.file);
    const size_t bytes = values.size() * format_.GetPixelSize(), at = bytes * frame.index;
    if (at + bytes > buffer_.size())
      throw SceneError(frame.file + ": ends early: it has no frame " + std::to_string(frame.index));
    const char* from = buffer_.data() + at;
    switch (format_.GetScalarType()) {
      case gdcm::PixelFormat::UINT8:
        return convert<uint8_t>(from, rescale_, values);
      case gdcm::PixelFormat::INT8:
        return convert<int8_t>(from, rescale_, values);
      case gdcm::PixelFormat::UINT16:
        return convert<uint16_t>(from, rescale_, values);
      case gdcm::PixelFormat::INT16:
        return convert<int16_t>(from, rescale_, values);
      case gdcm::PixelFormat::UINT32:
        return convert<uint32_t>(from, rescale_, values);
      case gdcm::PixelFormat::INT32:
        return convert<int32_t>(from, rescale_, values);
      default:
        throw SceneError(frame.file +
                         ": the type of its pixels is not supported; accepted: whole numbers of 8, 16 or 32 bits");
    }
  }

 private:
  void open(const std::string& file) {
    requireWhole(file);
    gdcm::ImageReader reader;
    reader.SetFileName(file.c_str());
    const bool read = reader.Read();
    const std::string syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax().GetString();
    const std::string kinds =
        "; accepted: one grey number per pixel, uncompressed or as JPEG, JPEG-LS, JPEG 2000 or RLE";
    if (!read) throw SceneError(file + ": its pixels, of transfer syntax " + syntax + ", cannot be read" + kinds);
    const gdcm::Image& image = reader.GetImage();
    format_ = image.GetPixelFormat();
    const auto colours = image.GetPhotometricInterpretation();
    if (format_.GetSamplesPerPixel() != 1 || (colours != gdcm::PhotometricInterpretation::MONOCHROME1 &&
                                              colours != gdcm::PhotometricInterpretation::MONOCHROME2))
      throw SceneError(file + ": colour pixels (" + colours.GetString() + ")" + kinds);
    const gdcm::DataElement& raw = reader.GetFile().GetDataSet().GetDataElement(Tag(0x7fe0, 0x0010));
    const gdcm::ByteValue* bytes = raw.GetByteValue();
    const int shift = shiftOf(reader.GetFile());
    buffer_.resize(image.GetBufferLength());
    if (shift > 0 && bytes)  // GDCM would assume that the lowest bits are stored
      buffer_.assign(bytes->GetPointer(), bytes->GetPointer() + bytes->GetLength());
    else if (!image.GetBuffer(buffer_.data()))
      throw SceneError(file + ": its pixels, of transfer syntax " + syntax + ", cannot be decompressed" + kinds);
    rescale_ = {image.GetSlope(), image.GetIntercept(), shift};
    file_ = file;
  }

  std::string file_;
  std::vector<char> buffer_;
  gdcm::PixelFormat format_;
  Rescale rescale_;
};

}  // namespace

void writeVolume(const std::vector<std::string>& files, bool fill) {
  std::vector<Frame> frames;
  for (const std::string& file : files)
    for (Frame& frame : framesOf(file)) frames.push_back(std::move(frame));
  for (const Frame& frame : frames)
    if (frame.rescale != frames.front().rescale && frame.file == frames.front().file)
      throw SceneError(frame.file +
                       ": frames have different slopes; accepted: one RescaleSlope and RescaleIntercept for all");
  Stack stack = stackOf(frames);
  stack.axes.col(2) = stepOf(frames, fill);
  const std::vector<int> slices = slicesOf(frames, stack.axes.col(2));
  stack.size[2] = slices.back() + 1;
  const size_t missing = static_cast<size_t>(stack.size[2]) - frames.size();
  if (missing > 0)
    writeNote(frames.front().file + ": " + std::to_string(missing) + " missing slices, of " +
              std::to_string(stack.size[2]) + ", repeat the nearest slice");
  writeHeader(stack, 1, {});
  Pixels pixels;
  std::vector<float> values(static_cast<size_t>(stack.size[0]) * static_cast<size_t>(stack.size[1]));
  for (size_t n = 0; n < frames.size(); ++n) {
    pixels.slice(frames[n], values);
    const int before = n == 0 ? 0 : slices[n] - slices[n - 1] - 1;
    const int after = n + 1 == frames.size() ? 0 : slices[n + 1] - slices[n] - 1;
    for (int copies = before / 2 + 1 + (after + 1) / 2; copies > 0; --copies) writeSlice(values);
  }
}

}  // namespace viscera::dicom
