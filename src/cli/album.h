// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "cli/film/film.h"
#include "viscera/session/session.h"
#include "viscera/tools/strokes.h"

namespace viscera::cli {

/// Writes the images of a run: a numbered series per camera, and a named image for every mark of the strokes; also the
/// final surface mesh and the images of a film. A separate thread compresses and writes the images.
class Album {
 public:
  /// Which images of a run are written.
  enum class Pictures {
    kAll,
    kLive,  ///< the series may have gaps if drawing falls behind
    kNone,  ///< none, only the final surface mesh
  };
  /// Images that are written in addition to colour.
  struct Kinds {
    bool depth = false;   ///< whether to write depth as .npy: float32, m along the optical axis, NaN: nothing
    bool labels = false;  ///< whether to write labels as grey PNG (layout/picture_labels.h)
  };
  /// @param folder  empty: neither images nor surface mesh   @param film  null: none
  /// @throws Error  the folder cannot be created
  Album(const std::string& folder, const Scene& scene, const Strokes& strokes, uint64_t ticks, Pictures pictures,
        const Kinds& kinds, Film* film);
  ~Album();
  Album(const Album&) = delete;
  Album& operator=(const Album&) = delete;

  /// Returns the outputs that the session's next step should produce.
  FrameRequest outputs(const Session& session);
  /// Adds the images of a frame. Blocks only if more than kWaiting images wait to be written.
  /// @throws ImageError, Error  for an earlier image
  void add(Frame&& frame);
  /// Waits until all images are written. @throws ImageError; Error  the surface mesh cannot be written, or an image of
  /// the film is missing
  void finish();

 private:
  static constexpr size_t kWaiting = 32;  // a megabyte each
  struct Waiting {
    ImageFrame image;
    bool is_filmed;
  };
  void makeFolder(const Strokes& strokes);
  FrameRequest filesOf(const Session& session) const;
  bool isFilmed(const ImageFrame& image);
  void write();
  void writeOut(const ImageFrame& image) const;
  static void writeFile(const ImageFrame& image, const std::string& stem);
  void rethrow();

  std::string folder_;
  const Scene& scene_;
  Pictures pictures_;
  uint64_t ticks_;
  Kinds kinds_;
  Film* film_;
  std::deque<uint64_t> film_ticks_;  ///< ticks with an image of the film, which is still in flight
  std::unique_ptr<SurfaceFrame> surface_;
  std::multimap<uint64_t, std::string> marks_;  ///< names by tick
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  bool end_ = false;
  std::exception_ptr error_;
  std::thread writer_;
};

/// Returns the results of the session's last tick, which it waits for, with the surface mesh. Images that are ready go
/// to the album. @param album  null: none   @throws Error  the surface mesh is missing
Frame frameNow(Session& session, Album* album);

}  // namespace viscera::cli
