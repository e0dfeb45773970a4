// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/page/page_writer.h"

#include <algorithm>
#include <cmath>

#include "export/page/viewer_text.h"
#include "math/base64.h"
#include "session/arrows.h"

namespace viscera {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kBlock_s = 3;  // what a browser decodes at most to show a moment
constexpr int kFormat = 1;

/// Returns a number with so many decimals, for a short index.
double rounded(double value, double per) {
  return std::round(value * per) / per;
}

}  // namespace

PageWriter::PageWriter(const std::string& path, double rate_hz)
    : file_(path, FileKind::kHtml),
      rate_hz_(rate_hz),
      block_frames_(std::max<size_t>(1, static_cast<size_t>(std::ceil(kBlock_s * rate_hz)))) {
  put(viewerHead(ViewerData::kFile));
}

void PageWriter::put(std::string_view text) {
  file_.write(text);
  bytes_ += text.size();
}

/// Writes bytes that the index refers to by their number, which it returns.
size_t PageWriter::putBlock(const PageBytes& block) {
  put("<script type=\"text/plain\" id=\"b" + std::to_string(blocks_) + "\">" + base64(deflated(block.text())) +
      "</script>\n");
  return blocks_++;
}

void PageWriter::follow(const Session& session) {
  endBlock();
  colors_ = std::make_unique<SceneColors>(session.model());
  scene_shapes_ = SceneShapes(session.scene());
  shape_numbers_.clear();
  scenes_.push_back(sceneJson(session, scene_shapes_.styles()));
  has_base_ = false;
}

void PageWriter::endBlock() {
  if (frames_in_block_ == 0) return;
  const size_t number = putBlock(block_);
  block_list_.push_back({{"block", number}, {"base", bases_.size() - 1}, {"frames", frames_in_block_}});
  block_.clear();
  frames_in_block_ = 0;
}

void PageWriter::beginBase(const VisibleMesh& skin) {
  endBlock();
  PageBytes base;
  coder_.begin(skin, colors_->of(skin), base);
  const PageGrid& grid = coder_.grid();
  bases_.push_back({{"block", putBlock(base)},
                    {"scene", scenes_.size() - 1},
                    {"origin", {grid.origin_m.x(), grid.origin_m.y(), grid.origin_m.z()}},
                    {"step", grid.step_m}});
  has_base_ = true;
}

void PageWriter::add(const Session& session, const Frame& now, const VisibleMesh& skin, double time_s) {
  if (frames_in_block_ == block_frames_) endBlock();
  if (!has_base_ || !coder_.hasRoomFor(skin)) beginBase(skin);
  const bool is_key = frames_in_block_ == 0;
  coder_.add(skin, colors_->of(skin), is_key, block_);
  if (is_key) tubes_.clear();
  putTubes(tubesOf(session, now));
  putTools(session, now);
  ++frames_in_block_;
  times_.push_back(rounded(time_s, 1e4));
  if (statuses_.empty() || !(status_ == shown_status_))
    statuses_.push_back({times_.size() - 1, status_.task, status_.step, rounded(status_.score, 10)});
  shown_status_ = status_;
}

/// Appends tubes: differences from the tube of the last frame at the same place in the list, or else along the tube.
void PageWriter::putTubes(const VisibleTubes& tubes) {
  std::vector<std::vector<Eigen::Vector3i>> now;
  block_.putCount(static_cast<uint32_t>(tubes.size()));
  for (const VisibleTube& tube : tubes) {
    const size_t t = now.size();
    std::vector<Eigen::Vector3i> positions;
    for (const Vector3d& position_m : tube.positions_m) positions.push_back(coder_.grid().nearest(position_m));
    const bool follows = t < tubes_.size() && tubes_[t].size() == positions.size();
    block_.putCount(scene_shapes_.styleOf(tube));
    block_.putCount(static_cast<uint32_t>(positions.size()));
    block_.putByte(follows);
    Eigen::Vector3i before = Eigen::Vector3i::Zero();
    for (size_t i = 0; i < positions.size(); ++i) {
      const Eigen::Vector3i offset = positions[i] - (follows ? tubes_[t][i] : before);
      for (int axis = 0; axis < 3; ++axis) block_.putSigned(offset[axis]);
      before = positions[i];
    }
    now.push_back(std::move(positions));
  }
  tubes_ = std::move(now);
}

void PageWriter::putTools(const Session& session, const Frame& now) {
  const std::vector<PlacedShape> placed = placedShapes(session, now);
  block_.putCount(static_cast<uint32_t>(placed.size()));
  for (const PlacedShape& one : placed) {
    auto found = shape_numbers_.find(one.shape);
    if (found == shape_numbers_.end()) {
      const ToolShape shape = triangleShape(session.scene(), one.shape);
      PageBytes bytes;
      putShape(shape, bytes);
      found = shape_numbers_.emplace(one.shape, static_cast<uint32_t>(shapes_.size())).first;
      shapes_.push_back({{"block", putBlock(bytes)},
                         {"vertices", shape.vertices.size()},
                         {"indices", shape.indices.size()},
                         {"solid", shape.solid_indices}});
    }
    block_.putCount(found->second);
    for (int axis = 0; axis < 3; ++axis) block_.putFloat(static_cast<float>(one.pose.position_m[axis]));
    for (int c = 0; c < 4; ++c) block_.putFloat(static_cast<float>(one.pose.orientation.coeffs()[c]));
  }
  putForces(session, now);
}

void PageWriter::putForces(const Session& session, const Frame& now) {
  const size_t styluses = session.scene().styluses.size();
  block_.putCount(static_cast<uint32_t>(styluses));
  for (size_t s = 0; s < styluses; ++s)
    for (int axis = 0; axis < 3; ++axis) block_.putFloat(static_cast<float>(now.reactions[s].force_n[axis]));
  for (size_t s = 0; s < styluses; ++s)
    for (int axis = 0; axis < 3; ++axis) block_.putFloat(static_cast<float>(now.tools[s].to.position_m[axis]));
}

void PageWriter::setLines(const std::vector<std::vector<Vector3d>>& lines_m) {
  Json lines = Json::array();
  for (const std::vector<Vector3d>& line : lines_m) {
    lines.push_back(Json::array());
    for (const Vector3d& position : line)
      for (int axis = 0; axis < 3; ++axis) lines.back().push_back(rounded(position[axis], 1e6));
  }
  lines_.push_back({times_.size(), lines});
}

void PageWriter::addMark(const std::string& kind, const std::string& text, double from_s, double to_s) {
  marks_.push_back({{"kind", kind}, {"text", text}, {"from", rounded(from_s, 1e4)}, {"to", rounded(to_s, 1e4)}});
}

void PageWriter::finish() {
  endBlock();
  const Json index = {{"format", kFormat}, {"rate_hz", rate_hz_},  {"newton_m", kArrowPerNewton_m},
                      {"scenes", scenes_}, {"bases", bases_},      {"blocks", block_list_},
                      {"shapes", shapes_}, {"times", times_},      {"marks", marks_},
                      {"lines", lines_},   {"statuses", statuses_}};
  put(viewerTail(ViewerData::kFile, index));
  file_.keep();
}

}  // namespace viscera
