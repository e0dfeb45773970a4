// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/page/live_scene.h"

#include <algorithm>
#include <utility>

namespace viscera::nodes {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kPlainColor = 0xff8080d0;            // sRGB, red in the low byte: where a sender gives no colours
constexpr uint32_t kMostBody = layout::kMaxBodies - 1;  // alpha of a vertex has room for no more
constexpr double kApart_m = 1e-7, kTurned = 1e-7;       // smaller motions of a tool are not seen

Vector3d toColor(uint32_t packed) {
  return Vector3d(packed & 255, packed >> 8 & 255, packed >> 16 & 255) / 255;
}

std::shared_ptr<const VisibleTopology> toVisible(const received::SentTopology& sent) {
  auto out = std::make_shared<VisibleTopology>();
  out->revision = sent.version;
  out->vertices = sent.vertices;
  out->triangles = sent.triangles;
  for (size_t b = 0; b < sent.bodies.size(); ++b)
    out->bodies.push_back({sent.bodies[b], toColor(sent.body_colors.empty() ? kPlainColor : sent.body_colors[b])});
  for (const received::SentPart& part : sent.parts)
    out->patches.push_back({std::min(static_cast<uint32_t>(part.body), kMostBody),
                            part.walls ? SurfaceKind::kWound : SurfaceKind::kSkin, part.first, part.count});
  return out;
}

}  // namespace

void LiveScene::clear() {
  markers_.clear();
  mesh_ = {};
  shown_.reset();
  topology_.reset();
  base_.reset();
  is_new_ = true;
}

void LiveScene::beginBase(const received::SentSurface& surface) {
  if (surface.topology() != topology_) mesh_.topology = toVisible(*surface.topology());
  topology_ = surface.topology();
  const std::vector<uint32_t> colors = std::exchange(mesh_.colors, {});
  plain_ = colors_.of(mesh_);
  mesh_.colors = colors;
  PageBytes bytes;
  coder_.begin(mesh_, plain_, bytes);
  auto part = std::make_shared<LivePart>();
  part->number = markers_.newPart();
  part->bytes =
      liveMessage({{"part", part->number}, {"origin", jsonOf(coder_.grid().origin_m)}, {"step", coder_.grid().step_m}},
                  bytes.text());
  base_ = std::move(part);
}

void LiveScene::takeSurface(const received::SentSurface& surface) {
  if (!surface.vertices() || surface.vertices() == shown_) return;
  shown_ = surface.vertices();
  mesh_.positions_m = shown_->positions_m;
  mesh_.normals = shown_->normals;
  mesh_.colors = shown_->colors;
  is_new_ = true;
  if (!base_ || surface.topology() != topology_ || !coder_.hasRoomFor(mesh_)) beginBase(surface);
}

/// Returns whether tools or obstacles are elsewhere than at the last moment, or others.
bool LiveScene::hasMoved(const std::vector<LiveMarkers::Placed>& placed) const {
  const auto same = [](const LiveMarkers::Placed& a, const LiveMarkers::Placed& b) {
    return a.part == b.part && (a.pose.position_m - b.pose.position_m).norm() < kApart_m &&
           (a.pose.orientation.coeffs() - b.pose.orientation.coeffs()).norm() < kTurned;
  };
  return !std::equal(placed.begin(), placed.end(), placed_.begin(), placed_.end(), same);
}

void LiveScene::putTubes(PageBytes& out, Json& styles) const {
  const std::vector<LiveTube> tubes = markers_.tubes();
  out.putCount(static_cast<uint32_t>(tubes.size()));
  for (const LiveTube& tube : tubes) {
    const Json style = {{"part", tube.part}, {"radius", tube.radius_m}, {"color", tube.color}};
    const auto found = std::find(styles.begin(), styles.end(), style);
    out.putCount(static_cast<uint32_t>(found - styles.begin()));
    if (found == styles.end()) styles.push_back(style);
    out.putCount(static_cast<uint32_t>(tube.positions_m.size()));
    out.putByte(0);
    Eigen::Vector3i before = Eigen::Vector3i::Zero();
    for (const Vector3d& position_m : tube.positions_m) {
      const Eigen::Vector3i now = coder_.grid().nearest(position_m);
      for (int axis = 0; axis < 3; ++axis) out.putSigned(now[axis] - before[axis]);
      before = now;
    }
  }
}

void LiveScene::putForces(PageBytes& out) const {
  const std::vector<LiveMarkers::Force> forces = markers_.forces();
  out.putCount(static_cast<uint32_t>(forces.size()));
  for (const LiveMarkers::Force& force : forces)
    for (int axis = 0; axis < 3; ++axis) out.putFloat(static_cast<float>(force.arrow_m[axis] / newton_m_));
  for (const LiveMarkers::Force& force : forces)
    for (int axis = 0; axis < 3; ++axis) out.putFloat(static_cast<float>(force.tip_m[axis]));
}

std::shared_ptr<const LiveFrame> LiveScene::next(const received::SentSurface& surface, const PoseOfFrame& pose_of) {
  takeSurface(surface);
  if (!base_) return nullptr;
  std::vector<LiveMarkers::Placed> placed = markers_.placed(pose_of);
  if (!is_new_ && !hasMoved(placed)) return nullptr;
  is_new_ = false;
  placed_ = std::move(placed);
  PageBytes bytes;
  coder_.add(mesh_, mesh_.colors.empty() ? plain_ : colors_.of(mesh_), true, bytes);
  Json styles = Json::array(), needs = Json::array({base_->number});
  putTubes(bytes, styles);
  auto out = std::make_shared<LiveFrame>();
  out->number = ++frames_;
  out->parts = {base_};
  bytes.putCount(static_cast<uint32_t>(placed_.size()));
  for (const LiveMarkers::Placed& one : placed_) {
    bytes.putCount(one.part->number);
    for (int axis = 0; axis < 3; ++axis) bytes.putFloat(static_cast<float>(one.pose.position_m[axis]));
    for (int c = 0; c < 4; ++c) bytes.putFloat(static_cast<float>(one.pose.orientation.coeffs()[c]));
    out->parts.push_back(one.part);
    needs.push_back(one.part->number);
  }
  putForces(bytes);
  out->bytes = liveMessage({{"frame", out->number},
                            {"base", base_->number},
                            {"needs", needs},
                            {"tick", shown_->tick},
                            {"newton_m", newton_m_},
                            {"tubes", styles}},
                           bytes.text());
  return out;
}

}  // namespace viscera::nodes
