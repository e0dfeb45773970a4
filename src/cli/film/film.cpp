// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/film/film.h"

#include <algorithm>
#include <iostream>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera::cli {

namespace {

constexpr size_t kChannels = 3;
constexpr double kRounding = 1e-9;  // of an image, by which sums of rates may be too small

}  // namespace

Film::Film(const FilmOptions& options, const FilmFormat& format)
    : options_(options),
      format_(format),
      file_(options.file, FileKind::kFilm),
      cleanup_(file_.target()),
      encoder_(format, file_.target(), options.file) {
  cleanup_.setProcess(encoder_.process());
}

void Film::follow(const Scene& scene) {
  camera_ = filmCamera(options_, scene, "scene " + scene.name);
  repeats_ = format_.rate_hz / filmFormat(options_, scene, "scene " + scene.name).rate_hz;
}

void Film::add(const ImageFrame& image) {
  const uint8_t* const rgb = fitted(image);
  for (owed_ += repeats_; owed_ > 1 - kRounding; --owed_) {
    encoder_.write(rgb);
    ++images_;
  }
}

const uint8_t* Film::fitted(const ImageFrame& image) {
  if (image.width == format_.width && image.height == format_.height) return image.rgb.data();
  canvas_.assign(kChannels * format_.width * format_.height, 0);
  const size_t width = std::min(image.width, format_.width), height = std::min(image.height, format_.height);
  const size_t left = (format_.width - width) / 2, top = (format_.height - height) / 2;
  for (size_t row = 0; row < height; ++row) {
    const auto from = image.rgb.begin() + static_cast<ptrdiff_t>(kChannels * row * image.width);
    std::copy_n(from, kChannels * width,
                canvas_.begin() + static_cast<ptrdiff_t>(kChannels * ((top + row) * format_.width + left)));
  }
  return canvas_.data();
}

void Film::finish() {
  if (images_ == 0)
    throw Error(options_.file + ": no film was written, because no picture was due; the film's camera has " +
                numberText(format_.rate_hz) + " per second");
  encoder_.finish();
  cleanup_.setProcess(-1);
  file_.keep();
  std::cout << "film: " << options_.file << ", " << images_ << (images_ == 1 ? " picture of " : " pictures of ")
            << format_.width << " x " << format_.height << ", " << numberText(format_.rate_hz) << " per second\n";
}

}  // namespace viscera::cli
