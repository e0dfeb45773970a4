// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The part of InlineView that reads results back from the GPU.
#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "session/inline_view.h"

namespace viscera {

namespace {

constexpr uint32_t kOpaqueAlpha = 0xff000000U;

}  // namespace

/// Reads a drawn image. A software rasteriser draws on threads of its own, but reading pixels waits for them.
void InlineView::readDrawn(Channel& channel, const Eye& eye) {
  renderer_.bindLast(static_cast<size_t>(&eye - eyes_.data()));
  channel.drawn.reset();
  startReadback(channel, eye, channel.drawn_tick);
}

void InlineView::collect(Pictures& out, bool wait) {
  while (takeSurface(out, wait)) {
  }
  for (Eye& eye : eyes_) {
    for (Channel* channel : {&eye.color, &eye.depth, &eye.labels}) {
      while (takeImage(*channel, eye, out, wait)) {
      }
    }
  }
}

bool InlineView::anyInFlight() const {
  if (surface_ring_->inFlight() > 0) return true;
  return std::any_of(eyes_.begin(), eyes_.end(), [](const Eye& eye) {
    const auto in_flight = [](const Channel& channel) {
      return channel.drawn || (channel.ring && channel.ring->inFlight() > 0);
    };
    return in_flight(eye.color) || in_flight(eye.depth) || in_flight(eye.labels);
  });
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
  out.surface = std::make_unique<SurfaceFrame>();  // an older surface of the same call is dropped
  out.surface->tick = tick;
  const Sent sent = std::move(in_flight_.front());
  in_flight_.pop_front();
  const size_t vertices = sent.wounds ? sent.wounds->vertices : surface_.vertices();
  take(out.surface->positions_m, 3 * vertices);
  take(out.surface->normals, vertices);
  take(alive_, surface_.triangles());
  if (sent.colors) take(out.surface->colors, vertices);
  if (sent.strain) take(out.surface->strain_colors, vertices);
  for (uint32_t& color : out.surface->colors) color |= kOpaqueAlpha;  // images use it for the body's label
  out.surface->topology = surface_.skin().shown(alive_.data(), sent.wounds.get());
  surface_ring_->release();
  return true;
}

bool InlineView::takeImage(Channel& channel, const Eye& eye, Pictures& out, bool wait) {
  if (channel.drawn && (wait || channel.drawn->hasPassed())) readDrawn(channel, eye);
  if (!channel.ring) return false;
  uint64_t tick = 0;
  const void* const pixels = channel.ring->collect(&tick, wait);
  if (!pixels) return false;
  ImageFrame image;
  image.tick = tick;
  image.camera = eye.camera;
  image.kind = channel.kind;
  image.width = eye.config.width_px;
  image.height = eye.config.height_px;
  const size_t bytes = pictureBytes(eye.config, channel.kind);
  if (channel.kind == PictureKind::kDepth) {
    const auto* const depths_m = static_cast<const float*>(pixels);
    image.depths_m.assign(depths_m, depths_m + bytes / sizeof(float));
    std::replace(image.depths_m.begin(), image.depths_m.end(), 0.0F, std::numeric_limits<float>::infinity());
  } else {
    const auto* const values = static_cast<const uint8_t*>(pixels);
    (channel.kind == PictureKind::kLabels ? image.labels : image.rgb).assign(values, values + bytes);
  }
  out.images.push_back(std::move(image));
  channel.ring->release();
  return true;
}

}  // namespace viscera
