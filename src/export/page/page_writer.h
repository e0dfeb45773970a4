// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "export/page/page_shapes.h"
#include "export/page/surface_coder.h"
#include "math/out_file.h"
#include "viscera/session/session.h"

namespace viscera {

/// Text of the page's clock at a frame: the task's state.
struct PageStatus {
  std::string task, step;  ///< empty: no task
  double score = 0;        ///< score so far
  bool operator==(const PageStatus& other) const {
    return task == other.task && step == other.step && score == other.score;
  }
};

/// Writes one HTML file that shows a session in a browser, from any side and at any time (docs/replay.md). The file has
/// everything that it needs. Memory does not grow with the length of the session, except for 30 bytes per frame.
///
/// Format. A block is an element <script type="text/plain" id="bN"> with base64 of zlib data (RFC 1950). Numbers are
/// little-endian; counts and signed counts are those of PageBytes. The element "index" is JSON:
/// * format, rate_hz, newton_m: 1; frames per simulated second; length of a force arrow [m/N].
/// * times: time of each frame [s].
/// * scenes: names of bodies, tools and cameras; poses of cameras; width and colour of tubes.
/// * bases: block, scene, and the grid: origin and step [m].
/// * blocks: block, base and the number of frames; at most 3 s each.
/// * shapes: block of a rigid shape: vertices (position, normal, RGBA: 28 bytes each), then indices (4 bytes), of which
///   "solid" are opaque.
/// * marks: kind, text, from and to [s].
/// * lines, statuses: lists of [first frame, value]: lines of a task; its name, step and score.
///
/// A base is one surface (SurfaceCoder). A new one begins with each scene, after each jump of the state, and where a
/// vertex leaves the grid (PageGrid). A block of frames has for each frame:
/// * A surface.
/// * Tubes: their count; for each its style and number of points as counts, a byte, and three signed counts per point,
///   in steps of the grid. Byte 1: minus the point of the same tube in the last frame; 0: minus the point before it.
/// * Tools: their count; for each its shape as a count, position [m] and quaternion x, y, z, w as float32.
/// * Forces: the count of tools; the force on each [N], then the tip of each [m], three float32 each.
class PageWriter {
 public:
  /// Begins the file. @param rate_hz  frames per simulated second, for the player   @throws Error  it cannot be written
  PageWriter(const std::string& path, double rate_hz);

  /// Continues with another session, at a jump of the state too. The session must outlive the calls of add().
  void follow(const Session& session);
  /// Adds a moment. @param now  results of the last tick, of Session::drain()   @param skin  of the same tick
  /// @param time_s  on the page's clock; not before that of the last moment   @throws Error
  void add(const Session& session, const Frame& now, const VisibleMesh& skin, double time_s);
  /// Sets the text for the next moments.
  void setStatus(const PageStatus& status) { status_ = status; }
  /// Sets the lines of a task for the next moments, tissue frame [m].
  void setLines(const std::vector<std::vector<Vector3d>>& lines_m);
  /// Adds a mark to the time axis. @param kind  cut, clip, knot, task, mistake or mark
  void addMark(const std::string& kind, const std::string& text, double from_s, double to_s);
  /// Ends the page; the file appears. @throws Error
  void finish();

  size_t frames() const { return times_.size(); }
  uint64_t bytes() const { return bytes_; }  ///< of the file so far
  double lastTime_s() const { return times_.empty() ? 0 : times_.back(); }

 private:
  void put(std::string_view text);
  size_t putBlock(const PageBytes& block);
  void endBlock();
  void beginBase(const VisibleMesh& skin);
  void putTubes(const VisibleTubes& tubes);
  void putTools(const Session& session, const Frame& now);
  void putForces(const Session& session, const Frame& now);

  OutFile file_;
  uint64_t bytes_ = 0;
  const double rate_hz_;
  const size_t block_frames_;
  size_t blocks_ = 0;
  // Lists of the index.
  nlohmann::ordered_json scenes_ = nlohmann::ordered_json::array(), bases_ = scenes_, block_list_ = scenes_,
                         shapes_ = scenes_;
  nlohmann::ordered_json marks_ = scenes_, lines_ = scenes_, statuses_ = scenes_;
  std::vector<double> times_;
  // Of the present session.
  std::unique_ptr<SceneColors> colors_;
  SceneShapes scene_shapes_;
  std::map<PageShape, uint32_t> shape_numbers_;
  SurfaceCoder coder_;
  bool has_base_ = false;
  PageBytes block_;
  size_t frames_in_block_ = 0;
  std::vector<std::vector<Eigen::Vector3i>> tubes_;  ///< of the last frame
  PageStatus status_, shown_status_;
};

}  // namespace viscera
