// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/inline_view.h"

#include <algorithm>
#include <utility>

#include "gpu/gl.h"
#include "gpu/software.h"
#include "gpu/stage_clock.h"
#include "model/scene/tool_kinds.h"
#include "render/overlay_painter.h"
#include "session/thread_looks.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

constexpr int kImagesInFlight = 3;
constexpr int kSurfacesInFlight = 3;

size_t surfaceBytes(const Surface& surface) {
  constexpr size_t kNormalAndColors = 3;  // of the tissue, of its strain
  return surface.capacity() * (3 * sizeof(float) + kNormalAndColors * sizeof(uint32_t)) +
         surface.triangles() * sizeof(uint32_t);
}

std::unique_ptr<gpu::ReadbackRing> makeRing(const Surface& surface) {
  return std::make_unique<gpu::ReadbackRing>(surfaceBytes(surface), kSurfacesInFlight, "the surface",
                                             gpu::isSoftware());
}

gpu::ReadbackRing::Pixel pixelOf(PictureKind kind) {
  if (kind == PictureKind::kDepth) return gpu::ReadbackRing::Pixel::kFloat;
  return kind == PictureKind::kLabels ? gpu::ReadbackRing::Pixel::kUint8 : gpu::ReadbackRing::Pixel::kRgb8;
}

/// Cameras, then the right eyes of those that have one: a camera in its place, which is moved before it draws.
std::vector<CameraConfig> eyesOf(const std::vector<CameraConfig>& cameras) {
  std::vector<CameraConfig> out = cameras;
  for (const CameraConfig& camera : cameras) {
    if (camera.stereo_baseline_m > 0) out.push_back(camera);
  }
  return out;
}

/// Do two motions look the same? Only where the tools end up is drawn.
bool looksTheSame(const ToolMotions& a, const ToolMotions& b) {
  for (size_t s = 0; s < a.size(); ++s) {
    if (a[s].present != b[s].present) return false;
    if (!a[s].present) continue;
    if (a[s].mode != b[s].mode || a[s].to.position_m != b[s].to.position_m) return false;
    if (a[s].to.orientation.coeffs() != b[s].to.orientation.coeffs()) return false;
  }
  return true;
}

bool isSame(const Pose& a, const Pose& b) {
  return a.position_m == b.position_m && a.orientation.coeffs() == b.orientation.coeffs();
}

}  // namespace

InlineView::InlineView(const Model& model, const Scene& scene)
    : model_(model),
      surface_(model),
      renderer_(eyesOf(scene.cameras), scene.styluses, scene.obstacles, &model),
      surface_ring_(makeRing(surface_)),
      strain_range_(scene.cameras.empty() ? CameraConfig().strain_range : scene.cameras.front().strain_range),
      reads_late_(gpu::isSoftware()) {
  if (PaleSkin::isSeenIn(model)) pale_skin_ = std::make_unique<PaleSkin>(model);
  if (hasThreadsOrClips(scene)) renderer_.addThreads(looksOf(scene));
  const std::vector<CameraConfig>& cameras = scene.cameras;
  for (size_t c = 0; c < cameras.size(); ++c) addEye(c, cameras[c], PictureKind::kColor);
  for (size_t c = 0; c < cameras.size(); ++c) {
    if (cameras[c].stereo_baseline_m > 0) addEye(c, cameras[c], PictureKind::kRight);
  }
}

void InlineView::addEye(size_t camera, const CameraConfig& config, PictureKind kind) {
  auto ring = std::make_unique<gpu::ReadbackRing>(pictureBytes(config, kind), kImagesInFlight, "an image");
  eyes_.push_back({camera,
                   config,
                   SeenSkin(config, surface_.boxes()),
                   opticalPose(config),
                   {kind, std::move(ring)},
                   {PictureKind::kDepth, nullptr},
                   {PictureKind::kLabels, nullptr},
                   {},
                   {}});
}

void InlineView::capture(Solver& solver, const Look& look, Pictures& out) {
  const StateView state = solver.stateOnGpu().value();
  if (look.wants.count() > 0 && surface_.canBeWounded() && solver.readCuts(cuts_)) {
    wound(cuts_, cuts_.revision);
  }
  capture(state, look, out);
}

void InlineView::wound(const CutSprings& cuts, uint64_t revision) {
  const size_t capacity = surface_.capacity();
  surface_.wound(cuts, revision);
  if (surface_.capacity() > capacity) {  // a larger ring; what is in flight is overtaken
    counters_.skipped += static_cast<uint64_t>(surface_ring_->inFlight());
    surface_ring_->drop();
    in_flight_.clear();
    surface_ring_ = makeRing(surface_);
  }
}

void InlineView::capture(const StateView& state, const Look& look, Pictures& out,
                         const std::optional<HostDisplacements>& displacements) {
  ++captures_;
  const bool surface = look.wants.surface && surface_ring_->inFlight() < kSurfacesInFlight;
  counters_.skipped += look.wants.surface && !surface ? 1 : 0;
  bool all = surface, any = surface;  // of the skin is to be mapped
  for (size_t e = 0; e < eyes_.size(); ++e) {
    Eye& eye = eyes_[e];
    choose(e, state, look, out);
    if (!eye.draws && !eye.measures) continue;
    any = true;
    all = all || (eye.draws && overlaysOf(eye.camera, look).any()) || !eye.skin.asks(displacements.has_value());
  }
  surface_.paint(look.processes.paints);
  if (any) follow(state, all, displacements);
  if (surface) captureSurface(state, look);
  const auto last =
      std::find_if(eyes_.rbegin(), eyes_.rend(), [](const Eye& eye) { return eye.draws || eye.measures; });
  for (size_t e = 0; e < eyes_.size(); ++e) {
    const bool is_last = last != eyes_.rend() && &eyes_[e] == &*last;
    const bool pauses = is_last && !last->measures && !overlaysOf(last->camera, look).any();
    renderer_.setPause(pauses ? pause_ : std::function<void()>());
    if (eyes_[e].color.wanted) captureImage(e, state, look);
    if (eyes_[e].depth.wanted || eyes_[e].labels.wanted) captureGeometry(e, state, look);
  }
}

/// Brings an eye to where it is in this capture.
void InlineView::place(size_t e, const Look& look) {
  Eye& eye = eyes_[e];
  eye.pose = eye.camera < look.cameras.size() ? look.cameras[eye.camera] : opticalPose(eye.config);
  if (eye.color.kind == PictureKind::kRight) eye.pose = eye.pose * rightEye(eye.config);
  eye.skin.place(eye.pose);
  renderer_.placeCamera(e, eye.pose);
}

/// What of an eye is wanted in this capture, and what of that is to be drawn.
void InlineView::choose(size_t e, const StateView& state, const Look& look, Pictures& out) {
  Eye& eye = eyes_[e];
  const bool left = eye.color.kind == PictureKind::kColor;
  const bool color = claim(eye.color, eye, look, out);
  const bool depth = left && claim(eye.depth, eye, look, out), labels = left && claim(eye.labels, eye, look, out);
  eye.draws = eye.measures = false;
  if (!color && !depth && !labels) return;
  place(e, look);
  eye.draws = color && !isRepeat(eye, eye.drawn, overlaysOf(eye.camera, look), state, look);
  eye.measures = (depth || labels) && !isRepeat(eye, eye.measured, Overlays{}, state, look);
}

/// Is a picture of that kind wanted, and is there room for another in its ring?
bool InlineView::claim(Channel& channel, Eye& eye, const Look& look, Pictures& out) {
  channel.wanted = look.wants.image(eye.camera, channel.kind);
  if (!channel.wanted) return false;
  if (channel.drawn) readDrawn(channel, eye);
  if (!channel.ring) {
    channel.ring = std::make_unique<gpu::ReadbackRing>(pictureBytes(eye.config, channel.kind), kImagesInFlight,
                                                       "depths or labels");
  }
  const bool full = channel.ring->inFlight() == kImagesInFlight;
  if (!full || (look.wants.every_image && takeImage(channel, eye, out, true))) return true;
  ++counters_.skipped;
  channel.wanted = false;
  return false;
}

Overlays InlineView::overlaysOf(size_t camera, const Look& look) {
  return camera < look.overlays.size() ? look.overlays[camera] : Overlays{};  // none were asked for
}

/// Would the picture be the last one again?
bool InlineView::isRepeat(const Eye& eye, const std::optional<Drawn>& drawn, const Overlays& overlays,
                          const StateView& state, const Look& look) const {
  return drawn && state.moved_revision == drawn->moved_revision && state.cut_revision == drawn->cut_revision &&
         looksTheSame(look.motions, drawn->motions) && isSame(eye.pose, drawn->pose) &&
         std::equal(look.obstacles.begin(), look.obstacles.end(), drawn->obstacles.begin(), drawn->obstacles.end(),
                    isSame) &&
         look.processes == drawn->processes && overlays == drawn->overlays &&
         (!overlays.any() || look.arrows == drawn->arrows);
}

/// Brings the surface to a state, as far as the images that are to be drawn show it. @param all  the whole of it
void InlineView::follow(const StateView& state, bool all, const std::optional<HostDisplacements>& displacements) {
  surface_.split(state);
  std::vector<SkinBox> boxes;
  std::vector<uint8_t> seen(model_.bodies.size());  // by any camera that is drawn
  for (Eye& eye : eyes_) {
    if (!eye.draws && !eye.measures) continue;
    const bool asks = eye.skin.asks(displacements.has_value());
    if (asks && boxes.empty()) {
      boxes = displacements ? surface_.boxes().place(*displacements) : boxesOf(surface_.boxes(), state, model_.slots());
    }
    eye.skin.look(surface_, asks ? &boxes : nullptr);
    eye.skin.addTo(seen);
  }
  surface_.follow(state, all ? nullptr : &seen);
  const bool draws = std::any_of(eyes_.begin(), eyes_.end(), [](const Eye& eye) { return eye.draws; });
  if (pale_skin_ && draws) renderer_.showColors(pale_skin_->follow(state, surface_).id());
}

void InlineView::captureSurface(const StateView& state, const Look& look) {
  const bool colors = surface_.isPainted(), strain = look.wants.strain;
  if (strain) {
    if (!strain_) strain_ = std::make_unique<NodeOverlay>(model_);
    strain_->follow(state, surface_);
    strain_->makeColors(surface_, strain_range_);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  }
  const gpu::TimedStage timed(gpu::Stage::kReadback);
  const size_t words = surface_.vertices() * sizeof(uint32_t);
  std::vector<gpu::ReadbackRing::Source> sources = {
      {surface_.positions().id(), 0, 3 * words},
      {surface_.normals().id(), 0, words},
      {surface_.alive().id(), 0, surface_.triangles() * sizeof(uint32_t)}};
  if (colors) sources.push_back({surface_.colors().id(), 0, words});
  if (strain) sources.push_back({strain_->colors().id(), 0, words});
  surface_ring_->request(sources.data(), sources.size(), look.tick);
  in_flight_.push_back({surface_.wounds(), colors, strain});
  ++counters_.readbacks;
}

void InlineView::captureImage(size_t e, const StateView& state, const Look& look) {
  Eye& eye = eyes_[e];
  if (eye.draws) {
    draw(e, state, look);
  } else {
    renderer_.bindLast(e);
    ++counters_.repeats;
  }
  if (reads_late_) {
    eye.color.drawn = std::make_unique<gpu::Fence>();
    eye.color.drawn_tick = look.tick;
  } else {
    request(eye.color, eye, look.tick);
  }
}

void InlineView::captureGeometry(size_t e, const StateView& state, const Look& look) {
  Eye& eye = eyes_[e];
  if (eye.measures) {
    renderer_.placeObstacles(look.obstacles);
    renderer_.placeThreads(look.processes.threads);
    renderer_.drawGeometry(e, surface_, look.motions, eye.skin.drawn());
    eye.measured.reset();
    if (state.moved_revision) {
      eye.measured =
          Drawn{state.moved_revision, state.cut_revision, look.motions, look.obstacles, eye.pose, Overlays{}, {},
                look.processes};
    }
  } else {
    ++counters_.repeats;
  }
  if (eye.depth.wanted) {
    renderer_.geometry(e).bindDepths();
    request(eye.depth, eye, look.tick);
  }
  if (eye.labels.wanted) {
    renderer_.geometry(e).bindLabels();
    request(eye.labels, eye, look.tick);
  }
}

/// Of what is bound for reading.
void InlineView::request(Channel& channel, const Eye& eye, uint64_t tick) {
  const gpu::TimedStage timed(gpu::Stage::kReadback);
  channel.ring->requestPixels(eye.config.width_px, eye.config.height_px, tick, pixelOf(channel.kind));
  ++counters_.readbacks;
}

/// Leaves the image bound for reading.
void InlineView::draw(size_t e, const StateView& state, const Look& look) {
  Eye& eye = eyes_[e];
  const Overlays overlays = overlaysOf(eye.camera, look);
  renderer_.placeObstacles(look.obstacles);
  renderer_.placeThreads(look.processes.threads);
  if (overlays.any()) {
    const OverlayLook over = {overlays,     eye.config.strain_range, state,    &surface_,
                              &look.arrows, eye.skin.drawn(),        captures_};
    renderer_.draw(e, model_, over, look.motions);
  } else {
    renderer_.draw(e, surface_, look.motions, eye.skin.drawn());
  }
  eye.drawn.reset();
  if (state.moved_revision) {
    eye.drawn = Drawn{state.moved_revision, state.cut_revision, look.motions, look.obstacles, eye.pose, overlays,
                      look.arrows,          look.processes};
  }
}

void InlineView::showSurface(const StateView& state, const Look& look, Pictures& out) {
  if (surface_ring_->inFlight() == kSurfacesInFlight) {
    ++counters_.skipped;
    return;
  }
  surface_.paint(look.processes.paints);
  surface_.split(state);
  surface_.follow(state, nullptr);
  captureSurface(state, look);
  takeSurface(out, false);
}

void InlineView::reset() {
  surface_.reset();
  for (Eye& eye : eyes_) {
    eye.drawn.reset();
    eye.measured.reset();
  }
}

ViewCounters InlineView::counters() const {
  ViewCounters out = counters_;
  out.mappings = surface_.mappings();
  out.renders = renderer_.renders();
  if (const std::shared_ptr<const ShownWounds> wounds = surface_.wounds()) {
    out.wound_holes = wounds->holes;
    out.wound_slivers = wounds->slivers;
  }
  return out;
}

}  // namespace viscera
