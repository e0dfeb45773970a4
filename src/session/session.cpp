// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/session/session.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "viscera/solver/gpu/gpu_solver.h"

namespace viscera {

namespace {

constexpr int kImagesInFlight = 3;
constexpr int kSurfacesInFlight = 3;

size_t surfaceBytes(const Surface& surface) {
  return surface.vertices() * (3 * sizeof(float) + sizeof(uint32_t)) + surface.triangles() * sizeof(uint32_t);
}

size_t imageBytes(const CameraConfig& camera) {
  return size_t{3} * static_cast<size_t>(camera.width_px) * static_cast<size_t>(camera.height_px);
}

bool wanted(const Wants& wants, size_t camera) {
  return camera < wants.cameras.size() && wants.cameras[camera];
}

float floatFromBits(uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

Vector3d xyz(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

Session::Session(const Scene& scene, gpu::Context&, const Progress& progress)
    : scene_(scene),
      model_(buildModel(scene, progress)),
      tools_(scene.styluses, waveSpeed(model_) / scene.solver.tick_hz) {
  solver_ = std::make_unique<GpuSolver>(model_, scene_);
  surface_ = std::make_unique<Surface>(model_);
  renderer_ = std::make_unique<Renderer>(scene_.cameras, scene_.styluses);
  surface_ring_ = std::make_unique<gpu::ReadbackRing>(surfaceBytes(*surface_), kSurfacesInFlight);
  for (const CameraConfig& camera : scene_.cameras) {
    image_rings_.push_back(std::make_unique<gpu::ReadbackRing>(imageBytes(camera), kImagesInFlight));
  }
  for (const StylusConfig& stylus : scene_.styluses) {
    limiters_.emplace_back(stylus.max_force_n, stylus.max_force_rate_n_per_s);
  }
}

Session::~Session() = default;

Frame Session::step(const StylusSamples& samples, const Wants& wants) {
  const ToolMotions motions = tools_.advance(samples);  // VR05 2.7: probe, grab, cut
  solver_->step(motions);                               // VR05 2.4: n substeps on the GPU
  ++tick_;
  ++ticks_;
  Frame frame;
  capture(wants, motions, frame);  // EGVE 3.3: nodes -> vertices, only what is wanted
  collect(frame, false);
  for (size_t s = 0; s < limiters_.size(); ++s) {
    frame.held_back[s] = motions[s].held_back;
    extremes_.held_back += motions[s].held_back;
    if (!motions[s].present || frame.health.recovering) {  // no pose, or tissue that is not itself: no force, at once
      limiters_[s].reset();
      frame.reactions[s] = Reaction{};
    }
  }
  return frame;
}

void Session::capture(const Wants& wants, const ToolMotions& motions, Frame& frame) {
  bool followed = false;
  const auto follow = [&] {
    if (followed) return;
    followed = true;
    surface_->tear(solver_->state());
    surface_->follow(solver_->state());
  };
  if (wants.surface && surface_ring_->inFlight() < kSurfacesInFlight) {
    follow();
    const gpu::ReadbackRing::Source sources[] = {
        {surface_->positions().id(), 0, surface_->positions().size() * sizeof(float)},
        {surface_->normals().id(), 0, surface_->normals().size() * sizeof(uint32_t)},
        {surface_->alive().id(), 0, surface_->alive().size() * sizeof(uint32_t)}};
    surface_ring_->request(sources, 3, tick_);
    ++readbacks_;
  }
  for (size_t c = 0; c < image_rings_.size(); ++c) {
    if (!wanted(wants, c)) continue;
    const bool full = image_rings_[c]->inFlight() == kImagesInFlight;
    if (full && !(wants.every_image && takeImage(c, frame, true))) continue;
    follow();
    renderer_->draw(c, *surface_, motions);
    image_rings_[c]->requestPixels(scene_.cameras[c].width_px, scene_.cameras[c].height_px, tick_);
    ++readbacks_;
  }
}

void Session::collect(Frame& frame, bool wait) {
  frame.tick = tick_;
  collectStats(frame, wait);
  uint64_t tick = 0;
  while (const void* memory = surface_ring_->collect(&tick, wait)) {
    const char* at = static_cast<const char*>(memory);
    frame.surface = std::make_unique<SurfaceFrame>();  // an older one of the same call is overtaken
    const auto take = [&at](auto& out, size_t count) {
      out.resize(count);
      std::memcpy(out.data(), at, count * sizeof(out[0]));
      at += count * sizeof(out[0]);
    };
    frame.surface->tick = tick;
    take(frame.surface->positions_m, 3 * surface_->vertices());
    take(frame.surface->normals, surface_->vertices());
    take(frame.surface->alive, surface_->triangles());
    surface_ring_->release();
  }
  for (size_t c = 0; c < image_rings_.size(); ++c) {
    while (takeImage(c, frame, wait)) {
    }
  }
}

bool Session::takeImage(size_t camera, Frame& frame, bool wait) {
  uint64_t tick = 0;
  const auto* rgb = static_cast<const uint8_t*>(image_rings_[camera]->collect(&tick, wait));
  if (!rgb) return false;
  const CameraConfig& config = scene_.cameras[camera];
  ImageFrame image{tick, camera, config.width_px, config.height_px, {}};
  image.rgb.assign(rgb, rgb + imageBytes(config));
  frame.images.push_back(std::move(image));
  image_rings_[camera]->release();
  return true;
}

void Session::collectStats(Frame& frame, bool wait) {
  while (solver_->pollStats(stats_, wait)) {
    has_stats_ = true;
    for (size_t s = 0; s < limiters_.size(); ++s) {
      // Force on a tool: minus the momentum it gave the nodes, per tick (physics.md 5).
      const Reaction raw{-xyz(stats_.impulse[s]) / tick_s(), -xyz(stats_.angular[s]) / tick_s(), false};
      extremes_.peak_force_n = std::max(extremes_.peak_force_n, raw.force_n.norm());
      reactions_[s] = limiters_[s].limit(raw, tick_s());
    }
    extremes_.max_stretch =
        std::max(extremes_.max_stretch, static_cast<double>(floatFromBits(stats_.max_stretch_bits)));
    extremes_.max_speed_m_per_s =
        std::max(extremes_.max_speed_m_per_s, static_cast<double>(floatFromBits(stats_.max_speed_bits)));
    extremes_.nonfinite = std::max<uint64_t>(extremes_.nonfinite, stats_.nonfinite);
  }
  frame.health = solver_->health();
  extremes_.governor_trips = frame.health.trips;
  frame.stats = stats_;
  frame.has_stats = has_stats_;
  frame.reactions = reactions_;
}

void Session::reset() {
  drain();
  solver_->reset();
  surface_->reset();
  tools_.reset();
  for (ForceLimiter& limiter : limiters_) limiter.reset();
  reactions_ = {};
  stats_ = {};
  has_stats_ = false;
  extremes_ = {};
  tick_ = 0;
}

Frame Session::drain() {
  Frame frame;
  collect(frame, true);
  return frame;
}

uint64_t Session::stateHash() const {
  return viscera::stateHash(model_, solver_->readState());
}

Counters Session::counters() const {
  return {ticks_, solver_->substepsDone(), surface_->mappings(), renderer_->renders(), readbacks_};
}

bool Session::imageDue(size_t camera) const {
  const double per_tick = scene_.cameras[camera].rate_hz * tick_s();
  return std::floor(static_cast<double>(tick_ + 1) * per_tick) != std::floor(static_cast<double>(tick_) * per_tick);
}

}  // namespace viscera
