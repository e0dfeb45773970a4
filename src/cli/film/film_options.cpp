// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/film/film_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "cli/film/film_encoder.h"
#include "viscera/math/error.h"

namespace viscera::cli {

namespace {

namespace fs = std::filesystem;

int evenUp(int pixels) {
  return pixels + pixels % 2;
}

double imagesPerSecond(const Scene& scene, size_t camera) {
  return std::min(scene.cameras[camera].rate_hz, scene.solver.tick_hz);  // at most one per tick
}

}  // namespace

void FilmFormat::include(const FilmFormat& other) {
  width = std::max(width, other.width);
  height = std::max(height, other.height);
  rate_hz = std::max(rate_hz, other.rate_hz);
}

CLI::Option* addFilm(CLI::App* command, FilmOptions& options) {
  CLI::Option* film = command->add_option("--film", options.file,
                                          "film of one camera to write, .mp4, at real-time speed; needs ffmpeg");
  command->add_option("--film-camera", options.camera, "name of the film's camera; default: the first one")
      ->needs(film);
  return film;
}

void requireFilm(const FilmOptions& options, bool no_view) {
  if (options.file.empty()) return;
  if (no_view) throw Error("--film: needs pictures; remove --no-view");
  if (fs::path(options.file).extension() != ".mp4")
    throw Error("--film " + options.file + ": films are .mp4 files; give a name that ends in .mp4");
  std::error_code error;
  const fs::file_status there = fs::status(options.file, error);
  if (fs::exists(there) && !fs::is_regular_file(there) && !fs::is_directory(there))
    throw Error(options.file + ": cannot be written: it is a device or a pipe, and a film needs a file");
  if (ffmpegPath().empty()) throw Error("--film needs ffmpeg; install it with: apt install ffmpeg");
}

size_t filmCamera(const FilmOptions& options, const Scene& scene, const std::string& name) {
  if (scene.cameras.empty()) throw Error("--film: needs pictures; " + name + " has no cameras");
  if (options.camera.empty()) return 0;
  std::string names;
  for (size_t c = 0; c < scene.cameras.size(); ++c) {
    if (scene.cameras[c].name == options.camera) return c;
    names += (names.empty() ? "" : ", ") + scene.cameras[c].name;
  }
  throw Error("--film-camera " + options.camera + ": " + name + " has no such camera; it has " + names);
}

FilmFormat filmFormat(const FilmOptions& options, const Scene& scene, const std::string& name) {
  const size_t camera = filmCamera(options, scene, name);
  return {evenUp(scene.cameras[camera].width_px), evenUp(scene.cameras[camera].height_px),
          imagesPerSecond(scene, camera)};
}

}  // namespace viscera::cli
