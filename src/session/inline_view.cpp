// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/inline_view.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "render/overlay_painter.h"

namespace viscera {

namespace {

constexpr int kImagesInFlight = 3;
constexpr int kSurfacesInFlight = 3;

size_t surfaceBytes(const Surface& surface) {
  return surface.capacity() * (3 * sizeof(float) + sizeof(uint32_t)) + surface.triangles() * sizeof(uint32_t);
}

std::unique_ptr<gpu::ReadbackRing> makeRing(const Surface& surface) {
  return std::make_unique<gpu::ReadbackRing>(surfaceBytes(surface), kSurfacesInFlight, "the surface");
}

size_t imageBytes(const CameraConfig& camera) {
  return size_t{3} * static_cast<size_t>(camera.width_px) * static_cast<size_t>(camera.height_px);
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
      renderer_(scene.cameras, scene.styluses, scene.obstacles, &model),
      surface_ring_(makeRing(surface_)) {
  for (const CameraConfig& camera : scene.cameras) {
    auto ring = std::make_unique<gpu::ReadbackRing>(imageBytes(camera), kImagesInFlight, "an image");
    eyes_.push_back({camera, std::move(ring), SeenSkin(camera, model, surface_.groups()), false, false, {}});
  }
}

void InlineView::capture(Solver& solver, const Look& look, Pictures& out) {
  const StateView state = solver.stateOnGpu().value();
  if (look.wants.count() > 0 && surface_.canBeWounded() && solver.readCuts(cuts_)) {
    wound({cuts_.nodes.data(), cuts_.axial_cut.data(), cuts_.spring_cut.data()}, cuts_.revision);
  }
  capture(state, look, out);
}

void InlineView::wound(const CutSprings& cuts, uint64_t revision) {
  const size_t capacity = surface_.capacity();
  surface_.wound(cuts, revision);
  if (surface_.capacity() > capacity) {  // a larger ring; what is in flight is overtaken
    counters_.skipped += static_cast<uint64_t>(surface_ring_->inFlight());
    surface_ring_->drop();
    wounds_in_flight_.clear();
    surface_ring_ = makeRing(surface_);
  }
}

void InlineView::capture(const StateView& state, const Look& look, Pictures& out,
                         const std::optional<HostDisplacements>& displacements) {
  ++captures_;
  const bool surface = look.wants.surface && surface_ring_->inFlight() < kSurfacesInFlight;
  counters_.skipped += look.wants.surface && !surface ? 1 : 0;
  bool all = surface, any = surface;  // of the skin is to be mapped
  for (size_t c = 0; c < eyes_.size(); ++c) {
    Eye& eye = eyes_[c];
    eye.wanted = look.wants.image(c) && makeRoom(c, look, out);
    eye.repeated = eye.wanted && isRepeat(c, state, look);
    if (!eye.wanted || eye.repeated) continue;
    any = true;
    all = all || overlaysOf(c, look).any() || !eye.skin.asks(displacements.has_value());
  }
  if (any) follow(state, all, displacements);
  if (surface) captureSurface(look.tick);
  for (size_t c = 0; c < eyes_.size(); ++c) {
    if (eyes_[c].wanted) captureImage(c, state, look);
  }
}

/// For another picture in a camera's ring.
bool InlineView::makeRoom(size_t camera, const Look& look, Pictures& out) {
  const bool full = eyes_[camera].ring->inFlight() == kImagesInFlight;
  if (!full || (look.wants.every_image && takeImage(camera, out, true))) return true;
  ++counters_.skipped;
  return false;
}

Overlays InlineView::overlaysOf(size_t camera, const Look& look) {
  return camera < look.overlays.size() ? look.overlays[camera] : Overlays{};  // none were asked for
}

/// Would the image be the last one again?
bool InlineView::isRepeat(size_t camera, const StateView& state, const Look& look) const {
  const std::optional<Drawn>& drawn = eyes_[camera].drawn;
  const Overlays overlays = overlaysOf(camera, look);
  return drawn && state.moved_revision == drawn->moved_revision && state.cut_revision == drawn->cut_revision &&
         looksTheSame(look.motions, drawn->motions) &&
         std::equal(look.obstacles.begin(), look.obstacles.end(), drawn->obstacles.begin(), drawn->obstacles.end(),
                    isSame) &&
         overlays == drawn->overlays && (!overlays.any() || look.arrows == drawn->arrows);
}

/// Brings the surface to a state, as far as the images that are to be drawn show it. @param all  the whole of it
void InlineView::follow(const StateView& state, bool all, const std::optional<HostDisplacements>& displacements) {
  surface_.tear(state);
  const SkinGroups& groups = surface_.groups();
  bool placed = false;
  seen_.assign(groups.count(), 0);
  for (Eye& eye : eyes_) {
    if (!eye.wanted || eye.repeated) continue;
    const bool asks = eye.skin.asks(displacements.has_value());
    if (asks && !std::exchange(placed, true)) {
      if (displacements) {
        places_.follow(groups, *displacements);
      } else {
        places_.follow(groups, state, model_.slots());
      }
    }
    eye.skin.look(surface_, asks ? &places_ : nullptr);
    eye.skin.addTo(seen_);
  }
  if (!all) groups.need(seen_, needs_);
  surface_.follow(state, all ? nullptr : &needs_);
}

void InlineView::captureSurface(uint64_t tick) {
  const gpu::ReadbackRing::Source sources[] = {{surface_.positions().id(), 0, 3 * surface_.vertices() * sizeof(float)},
                                               {surface_.normals().id(), 0, surface_.vertices() * sizeof(uint32_t)},
                                               {surface_.alive().id(), 0, surface_.alive().size() * sizeof(uint32_t)}};
  surface_ring_->request(sources, 3, tick);
  wounds_in_flight_.push_back(surface_.wounds());
  ++counters_.readbacks;
}

void InlineView::captureImage(size_t camera, const StateView& state, const Look& look) {
  Eye& eye = eyes_[camera];
  if (eye.repeated) {
    renderer_.bindLast(camera);
    ++counters_.repeats;
  } else {
    draw(camera, state, look);
  }
  eye.ring->requestPixels(eye.camera.width_px, eye.camera.height_px, look.tick);
  ++counters_.readbacks;
}

/// Leaves the image bound for reading.
void InlineView::draw(size_t camera, const StateView& state, const Look& look) {
  Eye& eye = eyes_[camera];
  const Overlays overlays = overlaysOf(camera, look);
  renderer_.placeObstacles(look.obstacles);
  if (overlays.any()) {
    const OverlayLook over = {overlays,     eye.camera.strain_range, state,    &surface_,
                              &look.arrows, eye.skin.drawn(),        captures_};
    renderer_.draw(camera, model_, over, look.motions);
  } else {
    renderer_.draw(camera, surface_, look.motions, eye.skin.drawn());
  }
  eye.drawn.reset();
  if (state.moved_revision) {
    eye.drawn = Drawn{state.moved_revision, state.cut_revision, look.motions, look.obstacles, overlays, look.arrows};
  }
}

void InlineView::collect(Pictures& out, bool wait) {
  while (takeSurface(out, wait)) {
  }
  for (size_t c = 0; c < eyes_.size(); ++c) {
    while (takeImage(c, out, wait)) {
    }
  }
}

bool InlineView::takeSurface(Pictures& out, bool wait) {
  uint64_t tick = 0;
  const char* at = static_cast<const char*>(surface_ring_->collect(&tick, wait));
  if (!at) return false;
  const auto take = [&at](auto& values, size_t count) {
    values.resize(count);
    std::memcpy(values.data(), at, count * sizeof(values[0]));
    at += count * sizeof(values[0]);
  };
  out.surface = std::make_unique<SurfaceFrame>();  // an older one of the same call is overtaken
  out.surface->tick = tick;
  const std::shared_ptr<const ShownWounds> wounds = std::move(wounds_in_flight_.front());
  wounds_in_flight_.pop_front();
  const size_t vertices = wounds ? wounds->vertices : surface_.vertices();
  take(out.surface->positions_m, 3 * vertices);
  take(out.surface->normals, vertices);
  take(alive_, surface_.triangles());
  out.surface->topology = surface_.skin().shown(alive_.data(), wounds.get());
  surface_ring_->release();
  return true;
}

bool InlineView::takeImage(size_t camera, Pictures& out, bool wait) {
  Eye& eye = eyes_[camera];
  uint64_t tick = 0;
  const auto* rgb = static_cast<const uint8_t*>(eye.ring->collect(&tick, wait));
  if (!rgb) return false;
  ImageFrame image;
  image.tick = tick;
  image.camera = camera;
  image.width = eye.camera.width_px;
  image.height = eye.camera.height_px;
  image.rgb.assign(rgb, rgb + imageBytes(eye.camera));
  out.images.push_back(std::move(image));
  eye.ring->release();
  return true;
}

void InlineView::reset() {
  surface_.reset();
  for (Eye& eye : eyes_) eye.drawn.reset();
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
