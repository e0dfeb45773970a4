// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/film/film_encoder.h"
#include "cli/film/film_options.h"
#include "cli/film/signal_cleanup.h"
#include "math/out_file.h"
#include "viscera/session/frame.h"

namespace viscera::cli {

/// Film of the images of one camera, at real-time speed. The file appears with finish(), and not at all after an error.
class Film {
 public:
  /// Starts the encoder. @throws Error  the file cannot be written, or the encoder cannot be started
  Film(const FilmOptions& options, const FilmFormat& format);

  /// Continues with the images of this session. @param scene  has the film's camera
  void follow(const Scene& scene);
  size_t camera() const { return camera_; }  ///< number of the film's camera in the session
  /// Appends an image of the camera, in the middle of the film's images where it is smaller. Where the camera is slower
  /// than the film, its images are repeated. Any thread may call it, one at a time. @throws Error  encoding failed
  void add(const ImageFrame& image);
  /// Ends the film and prints what was written. @throws Error  encoding failed, or there were no images
  void finish();

 private:
  const uint8_t* fitted(const ImageFrame& image);

  const FilmOptions options_;
  const FilmFormat format_;
  OutFile file_;
  SignalCleanup cleanup_;
  FilmEncoder encoder_;
  size_t camera_ = 0;
  double repeats_ = 1;  ///< number of images of the film per image of the camera
  double owed_ = 0;     ///< number of images that the film is short of
  uint64_t images_ = 0;
  std::vector<uint8_t> canvas_;
};

}  // namespace viscera::cli
