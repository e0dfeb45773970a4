// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#include "bench/harness/rate.h"
#include "bench/harness/session_speed.h"
#include "bench/suites/pace/performance_suites.h"

namespace viscera::bench {

namespace {

using Clock = std::chrono::steady_clock;
constexpr double kViewedStep = 2;  // a software rasteriser uses the same cores
constexpr int kWarmUpTicks = 10;

/// Delays [ms] of one session.
struct Delays {
  std::vector<double> force, surface, image;
  std::vector<double> late;  ///< end of a tick, relative to that of the previous tick plus a tick
  std::vector<double> step;  ///< duration of a call of Session::step
};

double msSince(SteadyTime time) {
  return std::chrono::duration<double, std::milli>(Clock::now() - time).count();
}

void record(std::vector<double>& delays, SteadyTime pose_received) {
  if (pose_received != SteadyTime{}) delays.push_back(msSince(pose_received));
}

/// Records the delay of a force. Each pose counts once.
void recordForce(const Frame& frame, SteadyTime& last, std::vector<double>& delays) {
  const SteadyTime pose = frame.poses_received[0];
  if (pose != last) record(delays, pose);
  last = pose;
}

void recordPictures(const Frame& frame, Delays& delays) {
  if (frame.surface) record(delays.surface, frame.surface->pose_received);
  for (const ImageFrame& image : frame.images) record(delays.image, image.pose_received);
}

/// Runs ticks at the scene's rate, like the simulator node: after a late tick the next one starts at once.
Delays measureDelays(Session& session, const Pressing& pressing, Wanted wanted, double seconds) {
  const auto tick = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(session.tick_s()));
  const int ticks = kWarmUpTicks + static_cast<int>(std::ceil(seconds / session.tick_s()));
  Delays out;
  SteadyTime answered{}, due = Clock::now(), ended = due;
  for (int t = 0; t < ticks; ++t) {
    std::this_thread::sleep_until(due);
    due = std::max(due + tick, Clock::now());
    const Clock::time_point began = Clock::now();
    const Frame frame = session.step(pressing.now(), outputsOf(session, wanted));
    const Clock::time_point end = Clock::now();
    if (t == kWarmUpTicks) out = {};
    recordForce(frame, answered, out.force);
    recordPictures(frame, out);
    out.step.push_back(std::chrono::duration<double, std::milli>(end - began).count());
    out.late.push_back(std::chrono::duration<double, std::milli>(end - ended - tick).count());
    ended = end;
  }
  session.drain();
  return out;
}

Table delayTable(const std::string& title) {
  return Table(title,
               {{"backend"}, {"wanted"}, {"of"}, {"count"}, {"p50", "ms", 3}, {"p99", "ms", 3}, {"max", "ms", 3}});
}

void addRow(Table& table, const std::string& backend, Wanted wanted, const std::string& of,
            const std::vector<double>& ms) {
  if (ms.empty()) return;
  table.add({backend, nameOf(wanted), of, static_cast<double>(ms.size()), median(ms), percentile(ms, 0.99),
             *std::max_element(ms.begin(), ms.end())});
}

std::vector<double> absolute(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return values;
}

void addRows(Table& table, const std::string& backend, Wanted wanted, const Delays& delays) {
  addRow(table, backend, wanted, "pose to force", delays.force);
  addRow(table, backend, wanted, "pose to surface", delays.surface);
  addRow(table, backend, wanted, "pose to image", delays.image);
  addRow(table, backend, wanted, "a step", delays.step);
  addRow(table, backend, wanted, "jitter of ticks", absolute(delays.late));
}

}  // namespace

void latencySuite(Report& report, gpu::Context& context) {
  const int nodes = report.isShort() ? 1500 : 10000;
  Table table = delayTable("heart of " + std::to_string(nodes) +
                           " nodes at 60 ticks/s, a probe moving in it, pictures "
                           "of 640 x 480 at 30 Hz");
  for (Backend backend : {Backend::kCpu, Backend::kGpu}) {
    Scene scene = pigHeartScene(nodes, 0.2);
    scene.solver.backend = backend;
    report.stage("building, " + nameOf(backend));
    Session session(scene, context);
    const Pressing pressing(session);
    double plain_ms = 0;
    for (Wanted wanted : {Wanted::kNothing, Wanted::kSurface, Wanted::kImages, Wanted::kSurfaceAndImages}) {
      report.stage(nameOf(backend) + ", wanted: " + nameOf(wanted));
      const Delays delays = measureDelays(session, pressing, wanted, report.isShort() ? 0.3 : 10);
      addRows(table, session.solver().backend(), wanted, delays);
      if (wanted == Wanted::kNothing) plain_ms = median(delays.step);
      if (backend == Backend::kCpu && wanted == Wanted::kSurfaceAndImages)
        report.checkAtMost("cpu: a step with a view over one without, p50", median(delays.step) / plain_ms,
                           kViewedStep);
    }
  }
  report.add(table, "delays");
}

}  // namespace viscera::bench
