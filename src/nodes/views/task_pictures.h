// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "tasks/task_report.h"
#include "viscera/session/frame.h"

namespace viscera::nodes {

/// Images of the first camera for the report of a task, taken from the ticks that follow. No tick waits for them.
class TaskPictures {
 public:
  /// @param can_draw  false: there will be none
  void setCanDraw(bool can_draw) { can_draw_ = can_draw; }
  void clear();
  /// Asks for the image of a tick after this one. @param name  of its file, without .png
  void ask(const std::string& caption, const std::string& name, uint64_t tick);
  /// Returns whether it still waits for an image.
  bool waits() const;
  void addTo(FrameRequest& outputs) const;
  /// Copies the image, if it is there. @param tick  of this frame
  void take(const std::vector<ImageFrame>& images, uint64_t tick);

  struct Taken {
    std::string caption, name;
    ImageFrame image;
  };
  std::vector<Taken> release();  ///< returns the images, and forgets them
  /// Writes images to a folder, which is created if missing. @throws Error
  static std::vector<ReportPicture> write(const std::string& folder, const std::vector<Taken>& taken);

 private:
  struct Asked {
    std::string caption, name;
    uint64_t tick;
    std::chrono::steady_clock::time_point since;
  };
  bool can_draw_ = false;
  std::optional<Asked> asked_;
  std::vector<Taken> taken_;
};

}  // namespace viscera::nodes
