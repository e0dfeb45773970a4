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

#include "viscera/session/session.h"
#include "viscera/tools/strokes.h"

namespace viscera::cli {

/// Where pictures go: a numbered series per camera, and a named one for every mark of the strokes; and the skin at the
/// end. A thread of its own packs and writes the pictures.
class Album {
 public:
  /// What is shown of a run.
  enum class Pictures {
    kAll,
    kLive,  ///< the series may have gaps where drawing falls behind
    kNone,  ///< only the skin at the end
  };
  /// What is taken beside what cameras see.
  struct Kinds {
    bool depth = false;   ///< as .npy: float32, m along the optical axis, NaN where nothing is
    bool labels = false;  ///< as grey PNG (layout/picture_labels.h)
  };
  /// @param folder  empty: neither pictures nor skin   @throws Error  the folder cannot be made
  Album(const std::string& folder, const Scene& scene, const Strokes& strokes, uint64_t ticks, Pictures pictures,
        const Kinds& kinds);
  ~Album();
  Album(const Album&) = delete;
  Album& operator=(const Album&) = delete;

  /// What the session's next step should show.
  Wants wants(const Session& session) const;
  /// Waits only where more pictures wait to be written than kWaiting. @throws ImageError  of an earlier picture
  void add(Frame&& frame);
  /// Waits until all are written. @throws ImageError; Error  the skin cannot be written
  void finish();

 private:
  static constexpr size_t kWaiting = 32;  // a megabyte each
  void write();
  void writeOut(const ImageFrame& image) const;
  static void writeFile(const ImageFrame& image, const std::string& stem);
  void rethrow();

  std::string folder_;
  const Scene& scene_;
  Pictures pictures_;
  uint64_t ticks_;
  Kinds kinds_;
  std::unique_ptr<SurfaceFrame> surface_;
  std::multimap<uint64_t, std::string> marks_;  ///< tick -> names
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<ImageFrame> waiting_;
  bool end_ = false;
  std::exception_ptr error_;
  std::thread writer_;
};

}  // namespace viscera::cli
