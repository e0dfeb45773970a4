// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/session_speed.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace viscera::bench {

namespace {

constexpr int kWarmUpTicks = 3;
constexpr double kDepth_m = 0.003, kSwing_m = 0.002, kSag_s = 0.5, kPress_s = 0.5, kTurn = 6.283185307179586;

ViewCounters minus(const ViewCounters& a, const ViewCounters& b) {
  ViewCounters out;
  out.mappings = a.mappings - b.mappings;
  out.renders = a.renders - b.renders;
  out.readbacks = a.readbacks - b.readbacks;
  out.repeats = a.repeats - b.repeats;
  out.skipped = a.skipped - b.skipped;
  out.moved_bricks = a.moved_bricks - b.moved_bricks;
  return out;
}

}  // namespace

std::string nameOf(Wanted wanted) {
  switch (wanted) {
    case Wanted::kNothing:
      return "nothing";
    case Wanted::kSurface:
      return "surface";
    case Wanted::kImages:
      return "images";
    case Wanted::kSurfaceAndImages:
      return "surface and images";
    default:
      return "an image of every tick";
  }
}

FrameRequest outputsOf(const Session& session, Wanted wanted) {
  FrameRequest out;
  out.surface = wanted == Wanted::kSurface || wanted == Wanted::kSurfaceAndImages;
  if (wanted == Wanted::kNothing || wanted == Wanted::kSurface) return out;
  for (size_t c = 0; c < session.scene().cameras.size(); ++c)
    out.cameras.push_back(wanted == Wanted::kEveryImage || session.imageDue(c));
  return out;
}

Pressing::Pressing(Session& session) : session_(session) {
  while (static_cast<double>(session.tick()) * session.tick_s() < kSag_s) session.step({}, {});
  start_tick_ = session.tick();
  touching_m_ = farthestNode(session.model(), session.solver().readState(), Vector3d::UnitX()) +
                session.scene().styluses[0].probe.radius_m * Vector3d::UnitX();
  while (static_cast<double>(session.tick() - start_tick_) * session.tick_s() < kPress_s) session.step(now(), {});
}

StylusSamples Pressing::now() const {
  const double time_s = static_cast<double>(session_.tick() + 1 - start_tick_) * session_.tick_s();
  const double in = std::min(1.0, time_s / kPress_s), swing = time_s > kPress_s ? std::sin(kTurn * time_s) : 0;
  StylusSamples out;
  out[0].valid = true;
  out[0].pose.position_m = touching_m_ - (in * kDepth_m + swing * kSwing_m) * Vector3d::UnitX();
  out[0].received = std::chrono::steady_clock::now();
  return out;
}

SessionSpeed measureSession(Session& session, Wanted wanted, double seconds,
                            const std::function<StylusSamples()>& samples) {
  const auto tick = [&] { session.step(samples(), outputsOf(session, wanted)); };
  for (int t = 0; t < kWarmUpTicks; ++t) tick();
  session.drain();
  const ViewCounters before = session.counters();
  const auto start = std::chrono::steady_clock::now();
  SessionSpeed out;
  double took_s = 0;
  while (took_s < seconds) {
    tick();
    ++out.ticks;
    took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  session.drain();
  took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  out.tick_s = took_s / out.ticks;
  out.work = minus(session.counters(), before);
  return out;
}

}  // namespace viscera::bench
