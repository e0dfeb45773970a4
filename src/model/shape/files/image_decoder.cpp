// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/image_decoder.h"

#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>

#include "math/one_line.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

bool beginsWith(const uint8_t* bytes, size_t count, const char* magic, size_t length) {
  return count >= length && std::memcmp(bytes, magic, length) == 0;
}

void requireSize(int64_t width, int64_t height) {
  if (width >= 1 && height >= 1 && width <= kMostTexturePixels && height <= kMostTexturePixels) return;
  throw MeshError("is " + std::to_string(width) + " x " + std::to_string(height) + " pixels; accepted: 1 to " +
                  std::to_string(kMostTexturePixels) + " along each side");
}

TextureImage emptyImage(int64_t width, int64_t height) {
  requireSize(width, height);
  TextureImage image;
  image.width_px = static_cast<int>(width);
  image.height_px = static_cast<int>(height);
  image.rgba.resize(size_t{4} * image.width_px * image.height_px);
  return image;
}

TextureImage decodePng(const uint8_t* bytes, size_t count) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const std::unique_ptr<png_image, decltype(&png_image_free)> cleanup(&png, png_image_free);
  const auto fail = [&] { throw MeshError("is not a readable PNG: " + oneLine(png.message)); };
  if (!png_image_begin_read_from_memory(&png, bytes, count)) fail();
  TextureImage image = emptyImage(png.width, png.height);
  png.format = PNG_FORMAT_RGBA;
  // Negative stride: our rows begin at the bottom.
  const auto stride = -static_cast<png_int_32>(4 * png.width);
  if (!png_image_finish_read(&png, nullptr, image.rgba.data(), stride, nullptr)) fail();
  return image;
}

TextureImage decodeJpeg(const uint8_t* bytes, size_t count) {
  const std::unique_ptr<void, decltype(&tjDestroy)> jpeg(tjInitDecompress(), tjDestroy);
  const auto fail = [&] { throw MeshError("is not a readable JPEG: " + oneLine(tjGetErrorStr2(jpeg.get()))); };
  int width = 0, height = 0, sampling = 0, colors = 0;
  if (!jpeg || tjDecompressHeader3(jpeg.get(), bytes, count, &width, &height, &sampling, &colors) != 0) fail();
  TextureImage image = emptyImage(width, height);
  const int code = tjDecompress2(jpeg.get(), bytes, count, image.rgba.data(), width, 4 * width, height, TJPF_RGBA,
                                 TJFLAG_BOTTOMUP | TJFLAG_STOPONWARNING);
  if (code != 0) fail();
  return image;
}

}  // namespace

TextureImage decodeImage(const uint8_t* bytes, size_t count) {
  if (beginsWith(bytes, count, "\x89PNG", 4)) return decodePng(bytes, count);
  if (beginsWith(bytes, count, "\xff\xd8\xff", 3)) return decodeJpeg(bytes, count);
  if (count == 0) throw MeshError("is empty (0 bytes)");
  const std::string start(reinterpret_cast<const char*>(bytes), std::min<size_t>(count, 8));
  throw MeshError("is neither PNG nor JPEG; it begins with '" + oneLine(start) + "'");
}

}  // namespace viscera
