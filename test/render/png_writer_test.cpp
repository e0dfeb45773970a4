// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/png_writer.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cstdio>

using namespace viscera;

namespace {

std::vector<uint8_t> readPng(const std::string& path, int& width, int& height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_file(&image, path.c_str())) << image.message;
  image.format = PNG_FORMAT_RGB;
  std::vector<uint8_t> rgb(PNG_IMAGE_SIZE(image));
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, rgb.data(), 0, nullptr)) << image.message;
  width = static_cast<int>(image.width);
  height = static_cast<int>(image.height);
  return rgb;
}

}  // namespace

TEST(PngWriter, ImageComesBackByteForByte) {
  const int width = 7, height = 5;
  std::vector<uint8_t> rgb(size_t{3} * width * height);
  for (size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<uint8_t>(i * 37);
  const std::string path = ::testing::TempDir() + "viscera_png_writer_test.png";
  writePng(path, width, height, rgb);
  int read_width = 0, read_height = 0;
  EXPECT_EQ(readPng(path, read_width, read_height), rgb);
  EXPECT_EQ(read_width, width);
  EXPECT_EQ(read_height, height);
  std::remove(path.c_str());
}

TEST(PngWriter, FolderThatDoesNotExistIsNamed) {
  try {
    writePng("/no/such/folder/image.png", 1, 1, {0, 0, 0});
    FAIL() << "wrote into a folder that does not exist";
  } catch (const ImageError& e) {
    EXPECT_NE(std::string(e.what()).find("/no/such/folder/image.png"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("No such file"), std::string::npos) << e.what();
  }
}

TEST(PngWriter, BytesThatAreNoImageOfTheSizeAreRefused) {
  EXPECT_THROW(writePng("unused.png", 2, 2, std::vector<uint8_t>(11)), ImageError);
  EXPECT_THROW(writePng("unused.png", 0, 2, {}), ImageError);
}
