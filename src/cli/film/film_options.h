// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/scene/scene.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace viscera::cli {

/// Film that a command makes of a session.
struct FilmOptions {
  std::string file;    ///< empty: none
  std::string camera;  ///< name of the camera; empty: the first one
};

/// Images of a film.
struct FilmFormat {
  int width = 0, height = 0;  ///< even, as H.264 requires [px]
  double rate_hz = 0;         ///< images per second of simulated time, and of film

  /// Enlarges the format so that images of another one fit.
  void include(const FilmFormat& other);
};

/// Adds --film and --film-camera to a command. @return --film
CLI::Option* addFilm(CLI::App* command, FilmOptions& options);

/// Checks the options of a film, if one is requested, before anything is computed. @param no_view  no images are drawn
/// @throws Error  not .mp4, not a file, no images, or no ffmpeg
void requireFilm(const FilmOptions& options, bool no_view);

/// Returns the number of the film's camera. @throws Error  the scene does not have it   @param name  of the scene
size_t filmCamera(const FilmOptions& options, const Scene& scene, const std::string& name);
/// Returns the format of the images of the film's camera. @throws Error  as filmCamera()
FilmFormat filmFormat(const FilmOptions& options, const Scene& scene, const std::string& name);

}  // namespace viscera::cli
