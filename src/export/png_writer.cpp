// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/png_writer.h"

#include <png.h>

namespace viscera {

namespace {

void write(const std::string& path, int width, int height, const std::vector<uint8_t>& bytes, bool grey) {
  if (width < 1 || height < 1 || bytes.size() != size_t{grey ? 1U : 3U} * width * height) {
    throw ImageError("cannot write '" + path + "': " + std::to_string(bytes.size()) + " bytes are no " +
                     std::to_string(width) + " x " + std::to_string(height) + (grey ? " grey" : " RGB") +
                     " image of at least 1 x 1 pixels");
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = grey ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
  image.flags =
      PNG_IMAGE_FLAG_FAST;  // several times faster, slightly larger: images are written while the simulation runs
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string packed(size, '\0');
  if (!png_image_write_to_memory(&image, packed.data(), &size, 0, bytes.data(), 0, nullptr))
    throw ImageError("cannot write '" + path + "': " + image.message);
  packed.resize(size);
  writeImageFile(path, FileKind::kPng, packed);
}

}  // namespace

void writeImageFile(const std::string& path, FileKind kind, std::string_view bytes) {
  try {
    writeFile(path, kind, bytes);
  } catch (const Error& error) {
    throw ImageError(error.what());
  }
}

void writePng(const std::string& path, int width, int height, const std::vector<uint8_t>& rgb) {
  write(path, width, height, rgb, false);
}

void writeGreyPng(const std::string& path, int width, int height, const std::vector<uint8_t>& values) {
  write(path, width, height, values, true);
}

}  // namespace viscera
