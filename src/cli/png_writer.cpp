// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/png_writer.h"

#include <png.h>

namespace viscera {

void writePng(const std::string& path, int width, int height, const std::vector<uint8_t>& rgb) {
  if (width < 1 || height < 1 || rgb.size() != size_t{3} * width * height) {
    throw ImageError("cannot write '" + path + "': " + std::to_string(rgb.size()) + " bytes are no " +
                     std::to_string(width) + " x " + std::to_string(height) + " RGB image of at least 1 x 1 pixels");
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  image.flags =
      PNG_IMAGE_FLAG_FAST;  // several times faster, somewhat larger: pictures are taken while tissue is stepped
  if (!png_image_write_to_file(&image, path.c_str(), 0, rgb.data(), 0, nullptr)) {
    throw ImageError("cannot write '" + path + "': " + image.message);
  }
}

}  // namespace viscera
