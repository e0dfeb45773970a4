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
#include "session/tube_styles.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

constexpr int kImagesInFlight = 3;
constexpr int kSurfacesInFlight = 3;

size_t surfaceBytes(const Surface& surface) {
  constexpr size_t kNormalAndColors = 3;  // normal, colour, and colour of the strain
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

/// Returns the cameras, then the right eyes of stereo cameras: copies of the camera, moved before drawing.
std::vector<CameraConfig> eyesOf(const std::vector<CameraConfig>& cameras) {
  std::vector<CameraConfig> out = cameras;
  for (const CameraConfig& camera : cameras) {
    if (camera.stereo_baseline_m > 0) out.push_back(camera);
  }
  return out;
}

/// Returns whether two motions request the same. Only the final poses of the tools are drawn.
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
      styluses_(scene.styluses),
      surface_(model),
      renderer_(eyesOf(scene.cameras), scene.styluses, scene.obstacles, &model, !scene.marks.empty()),
      surface_ring_(makeRing(surface_)),
      strain_range_(scene.cameras.empty() ? CameraConfig().strain_range : scene.cameras.front().strain_range),
      reads_late_(gpu::isSoftware()) {
  if (Blanching::isSeenIn(model)) pale_skin_ = std::make_unique<Blanching>(model);
  if (hasSuturesOrClips(scene) || !scene.attachments.empty()) renderer_.addTubes(stylesOf(scene));
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
                   SkinVisibility(config, surface_.boxes()),
                   opticalPose(config),
                   {kind, std::move(ring)},
                   {PictureKind::kDepth, nullptr},
                   {PictureKind::kLabels, nullptr},
                   {},
                   {}});
}

void InlineView::capture(Solver& solver, const RenderRequest& request, Pictures& out) {
  const StateView state = solver.stateOnGpu().value();
  if (request.outputs.count() > 0 && surface_.canBeWounded() && solver.readCuts(cuts_)) {
    wound(cuts_, cuts_.revision);
  }
  capture(state, request, out);
}

void InlineView::wound(const CutSprings& cuts, uint64_t revision) {
  const size_t capacity = surface_.capacity();
  surface_.wound(cuts, revision);
  if (surface_.capacity() > capacity) {  // a larger ring; what is in flight is dropped
    counters_.skipped += static_cast<uint64_t>(surface_ring_->inFlight());
    surface_ring_->drop();
    in_flight_.clear();
    surface_ring_ = makeRing(surface_);
  }
}

void InlineView::capture(const StateView& state, const RenderRequest& request, Pictures& out,
                         const std::optional<HostDisplacements>& displacements) {
  ++captures_;
  const bool surface = request.outputs.surface && surface_ring_->inFlight() < kSurfacesInFlight;
  counters_.skipped += request.outputs.surface && !surface ? 1 : 0;
  bool all = surface, any = surface;  // of the surface mesh to map
  for (size_t e = 0; e < eyes_.size(); ++e) {
    Eye& eye = eyes_[e];
    choose(e, state, request, out);
    if (!eye.draws && !eye.measures) continue;
    any = true;
    all = all || (eye.draws && overlaysOf(eye.camera, request).any()) || !eye.skin.asks(displacements.has_value());
  }
  surface_.paint(request.processes.paints);
  renderer_.showMarks(request.marks);
  if (any) follow(state, all, displacements);
  if (surface) captureSurface(state, request);
  const auto last =
      std::find_if(eyes_.rbegin(), eyes_.rend(), [](const Eye& eye) { return eye.draws || eye.measures; });
  for (size_t e = 0; e < eyes_.size(); ++e) {
    const bool is_last = last != eyes_.rend() && &eyes_[e] == &*last;
    const bool pauses = is_last && !last->measures && !overlaysOf(last->camera, request).any();
    renderer_.setPause(pauses ? pause_ : std::function<void()>());
    if (eyes_[e].color.wanted) captureImage(e, state, request);
    if (eyes_[e].depth.wanted || eyes_[e].labels.wanted) captureGeometry(e, state, request);
  }
}

/// Moves an eye to its pose in this capture.
void InlineView::place(size_t e, const RenderRequest& request) {
  Eye& eye = eyes_[e];
  eye.pose = eye.camera < request.cameras.size() ? request.cameras[eye.camera] : opticalPose(eye.config);
  if (eye.color.kind == PictureKind::kRight) eye.pose = eye.pose * rightEye(eye.config);
  eye.skin.place(eye.pose);
  renderer_.placeCamera(e, eye.pose);
}

/// Chooses which images of an eye are requested in this capture, and which of those to draw.
void InlineView::choose(size_t e, const StateView& state, const RenderRequest& request, Pictures& out) {
  Eye& eye = eyes_[e];
  const bool left = eye.color.kind == PictureKind::kColor;
  const bool color = claim(eye.color, eye, request, out);
  const bool depth = left && claim(eye.depth, eye, request, out), labels = left && claim(eye.labels, eye, request, out);
  eye.draws = eye.measures = false;
  if (!color && !depth && !labels) return;
  place(e, request);
  eye.draws = color && !isRepeat(eye, eye.drawn, overlaysOf(eye.camera, request), state, request);
  eye.measures = (depth || labels) && !isRepeat(eye, eye.measured, Overlays{}, state, request);
}

/// Returns whether an image of that kind is requested and its ring has room for another.
bool InlineView::claim(Channel& channel, Eye& eye, const RenderRequest& request, Pictures& out) {
  channel.wanted = request.outputs.image(eye.camera, channel.kind);
  if (!channel.wanted) return false;
  if (channel.drawn) readDrawn(channel, eye);
  if (!channel.ring) {
    channel.ring = std::make_unique<gpu::ReadbackRing>(pictureBytes(eye.config, channel.kind), kImagesInFlight,
                                                       "depths or labels");
  }
  const bool full = channel.ring->inFlight() == kImagesInFlight;
  if (!full || (request.outputs.every_image && takeImage(channel, eye, out, true))) return true;
  ++counters_.skipped;
  channel.wanted = false;
  return false;
}

Overlays InlineView::overlaysOf(size_t camera, const RenderRequest& request) {
  return camera < request.overlays.size() ? request.overlays[camera] : Overlays{};  // none requested
}

/// Returns whether the image would equal the last one.
bool InlineView::isRepeat(const Eye& eye, const std::optional<Drawn>& drawn, const Overlays& overlays,
                          const StateView& state, const RenderRequest& request) const {
  return drawn && state.moved_revision == drawn->moved_revision && state.cut_revision == drawn->cut_revision &&
         looksTheSame(request.motions, drawn->motions) && isSame(eye.pose, drawn->pose) &&
         std::equal(request.obstacles.begin(), request.obstacles.end(), drawn->obstacles.begin(),
                    drawn->obstacles.end(), isSame) &&
         request.processes == drawn->processes && request.marks == drawn->marks && overlays == drawn->overlays &&
         (!overlays.any() || request.arrows == drawn->arrows);
}

/// Updates the surface to a state, as far as the images to draw show it. @param all  the whole surface
void InlineView::follow(const StateView& state, bool all, const std::optional<HostDisplacements>& displacements) {
  surface_.split(state);
  std::vector<SkinBox> boxes;
  std::vector<uint8_t> seen(model_.bodies.size());  // by any camera that draws
  for (Eye& eye : eyes_) {
    if (!eye.draws && !eye.measures) continue;
    const bool asks = eye.skin.asks(displacements.has_value());
    if (asks && boxes.empty()) {
      boxes = displacements ? surface_.boxes().place(*displacements) : boxesOf(surface_.boxes(), state, model_.slots());
    }
    eye.skin.update(surface_, asks ? &boxes : nullptr);
    eye.skin.addTo(seen);
  }
  surface_.follow(state, all ? nullptr : &seen);
  const bool draws = std::any_of(eyes_.begin(), eyes_.end(), [](const Eye& eye) { return eye.draws; });
  if (pale_skin_ && draws) renderer_.showColors(pale_skin_->follow(state, surface_).id());
}

void InlineView::captureSurface(const StateView& state, const RenderRequest& request) {
  const bool colors = surface_.hasColors(), strain = request.outputs.strain;
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
  surface_ring_->request(sources.data(), sources.size(), request.tick);
  in_flight_.push_back({surface_.wounds(), colors, strain});
  ++counters_.readbacks;
}

void InlineView::captureImage(size_t e, const StateView& state, const RenderRequest& request) {
  Eye& eye = eyes_[e];
  if (eye.draws) {
    draw(e, state, request);
  } else {
    renderer_.bindLast(e);
    ++counters_.repeats;
  }
  if (reads_late_) {
    eye.color.drawn = std::make_unique<gpu::Fence>();
    eye.color.drawn_tick = request.tick;
  } else {
    startReadback(eye.color, eye, request.tick);
  }
}

void InlineView::captureGeometry(size_t e, const StateView& state, const RenderRequest& request) {
  Eye& eye = eyes_[e];
  if (eye.measures) {
    renderer_.placeObstacles(request.obstacles);
    renderer_.placeTubes(request.processes.sutures);
    renderer_.drawGeometry(e, surface_, shownTools(eye.config, styluses_, request.motions), eye.skin.drawn());
    eye.measured.reset();
    if (state.moved_revision) {
      eye.measured =
          Drawn{state.moved_revision, state.cut_revision, request.motions, request.obstacles, eye.pose, Overlays{}, {},
                request.processes,    request.marks};
    }
  } else {
    ++counters_.repeats;
  }
  if (eye.depth.wanted) {
    renderer_.geometry(e).bindDepths();
    startReadback(eye.depth, eye, request.tick);
  }
  if (eye.labels.wanted) {
    renderer_.geometry(e).bindLabels();
    startReadback(eye.labels, eye, request.tick);
  }
}

/// Requests what is bound for reading.
void InlineView::startReadback(Channel& channel, const Eye& eye, uint64_t tick) {
  const gpu::TimedStage timed(gpu::Stage::kReadback);
  channel.ring->requestPixels(eye.config.width_px, eye.config.height_px, tick, pixelOf(channel.kind));
  ++counters_.readbacks;
}

/// Draws an image and leaves it bound for reading.
void InlineView::draw(size_t e, const StateView& state, const RenderRequest& request) {
  Eye& eye = eyes_[e];
  const Overlays overlays = overlaysOf(eye.camera, request);
  const ToolMotions tools = shownTools(eye.config, styluses_, request.motions);
  renderer_.placeObstacles(request.obstacles);
  renderer_.placeTubes(request.processes.sutures);
  if (overlays.any()) {
    const OverlayStyle over = {overlays,        eye.config.strain_range, state,    &surface_,
                               &request.arrows, eye.skin.drawn(),        captures_};
    renderer_.draw(e, model_, over, tools);
  } else {
    renderer_.draw(e, surface_, tools, eye.skin.drawn());
  }
  eye.drawn.reset();
  if (state.moved_revision) {
    eye.drawn = Drawn{state.moved_revision, state.cut_revision, request.motions, request.obstacles, eye.pose, overlays,
                      request.arrows,       request.processes,  request.marks};
  }
}

void InlineView::showSurface(const StateView& state, const RenderRequest& request, Pictures& out) {
  if (surface_ring_->inFlight() == kSurfacesInFlight) {
    ++counters_.skipped;
    return;
  }
  surface_.paint(request.processes.paints);
  surface_.split(state);
  surface_.follow(state, nullptr);
  captureSurface(state, request);
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
  if (const std::shared_ptr<const VisibleWounds> wounds = surface_.wounds()) {
    out.wound_holes = wounds->holes;
    out.wound_slivers = wounds->slivers;
  }
  return out;
}

}  // namespace viscera
