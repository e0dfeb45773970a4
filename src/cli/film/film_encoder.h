// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "cli/film/film_options.h"

namespace viscera::cli {

/// Returns the path of the program ffmpeg, as PATH has it; empty: there is none.
std::string ffmpegPath();

/// Child process ffmpeg, which gets images through a pipe and encodes them as H.264. It ends with this object.
class FilmEncoder {
 public:
  /// @param file  existing file that receives the film   @param name  of the film, for errors
  /// @throws Error  the process cannot be started
  FilmEncoder(const FilmFormat& format, const std::string& file, std::string name);
  ~FilmEncoder();
  FilmEncoder(const FilmEncoder&) = delete;
  FilmEncoder& operator=(const FilmEncoder&) = delete;

  pid_t process() const { return process_; }
  /// Encodes an image. @param rgb  RGB8, rows from the top, of the size of the format
  /// @throws Error  ffmpeg failed, with the last line of its messages
  void write(const uint8_t* rgb);
  /// Ends the film, and waits for ffmpeg. @throws Error  it failed
  void finish();

 private:
  int wait();  ///< closes the pipe, waits for the process, and returns its status
  [[noreturn]] void fail(int status) const;

  const std::string name_;
  const size_t image_bytes_;
  pid_t process_ = -1;
  int images_ = -1, messages_ = -1;
};

}  // namespace viscera::cli
