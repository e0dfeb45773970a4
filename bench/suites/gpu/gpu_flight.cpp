// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/session_speed.h"
#include "bench/suites/gpu/gpu_parts.h"
#include "gpu/stage_clock.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

namespace {

struct Variant {
  const char* name;
  Wanted wanted;
  bool waits;
};
constexpr Variant kVariants[] = {{"nothing", Wanted::kNothing, false},
                                 {"skin and image, in flight", Wanted::kSurfaceAndImages, false},
                                 {"nothing, waiting for every tick", Wanted::kNothing, true},
                                 {"skin and image, waiting for every tick", Wanted::kSurfaceAndImages, true}};

/// Returns a session with outputs after every tick: its surface mesh and its only image.
Scene viewedHeart(int nodes) {
  Scene scene = pigHeartScene(nodes, 0.2);
  scene.solver.backend = Backend::kGpu;
  scene.cameras[0].rate_hz = scene.solver.tick_hz;
  return scene;
}

}  // namespace

void measureFlight(Report& report) {
  const int nodes = report.isShort() ? 1500 : 42745;
  report.stage("read-back: building");
  Session session(viewedHeart(nodes), *report.context());
  const Pressing pressing(session);
  Table table(
      "read-back of a heart of " + std::to_string(nodes) + " nodes, 60 ticks/s of simulated time, as fast as possible",
      {{"read back after each tick"}, {"tick", "ms", 3}, {"read back", "per tick", 3}, {"overtaken", "per tick", 3}});
  for (const Variant& variant : kVariants) {
    report.stage(std::string("read-back: ") + variant.name);
    const auto samples = [&] {
      if (variant.waits) session.drain();
      return pressing.now();
    };
    const SessionSpeed speed = measureSession(session, variant.wanted, report.isShort() ? 0.2 : 3, samples);
    const double ticks = speed.ticks;
    table.add({variant.name, 1e3 * speed.tick_s, static_cast<double>(speed.work.readbacks) / ticks,
               static_cast<double>(speed.work.skipped) / ticks});
  }
  report.add(table, "flight");
}

namespace {

constexpr double kLiveSeconds = 5, kStagesSeconds = 2, kShortSeconds = 0.2;

StylusSamples noTools() {
  return {};
}

/// Adds the times of the solver's stages per tick, by the GPU's clock.
void addStages(Session& session, Wanted wanted, double seconds, Table& table) {
  gpu::StageClock clock;
  const auto begun_with = session.tick();
  measureSession(session, wanted, seconds, noTools);
  const double ticks = static_cast<double>(session.tick() - begun_with);
  const auto& times = clock.collect(true);
  for (size_t s = 0; s < gpu::kStages; ++s) {
    if (times[s].count == 0) continue;
    table.add({nameOf(wanted), gpu::stageName(static_cast<gpu::Stage>(s)), static_cast<double>(times[s].count) / ticks,
               1e3 * times[s].seconds / ticks});
  }
}

}  // namespace

void measureLive(Report& report) {
  constexpr int kMillion = 1000000, kFew = 3000, kOnSoftware = 10000;
  const int nodes = report.isShort() ? kFew : report.context()->isSoftware() ? kOnSoftware : kMillion;
  Scene scene = viewedHeart(nodes);
  scene.bodies[0].material.law = Law::kAuto;  // default of scenes
  scene.solver.sleep_speed_m_per_s = 0;       // keeps tissue at rest awake, so that it is measured like moving tissue
  report.stage("live: building");
  Session session(scene, *report.context());
  Table table("a heart of 10 cm, E " + Cell(1e-3 * scene.bodies[0].material.young_modulus_pa).text(3) +
                  " kPa, with its skin and 60 pictures of 640 x 480 a second",
              {{"nodes", "", 8},
               {"faces", "", 8},
               {"substeps at rest", "per tick"},
               {"substeps", "per tick", 4},
               {"read back"},
               {"tick", "ms", 3},
               {"of real time", "", 3},
               {"overtaken", "per tick", 3}});
  Table stages("stages of its ticks by the GPU's clock",
               {{"read back"}, {"stage"}, {"entered", "per tick", 4}, {"takes", "ms per tick", 3}});
  const double at_rest = session.solver().substeps();
  for (const Wanted wanted : {Wanted::kNothing, Wanted::kSurfaceAndImages}) {
    report.stage("live: wanted: " + nameOf(wanted));
    const uint64_t ticks_before = session.tick(), substeps_before = session.solver().substepsDone();
    const SessionSpeed speed =
        measureSession(session, wanted, report.isShort() ? kShortSeconds : kLiveSeconds, noTools);
    const double substeps = static_cast<double>(session.solver().substepsDone() - substeps_before) /
                            static_cast<double>(session.tick() - ticks_before);
    table.add({static_cast<double>(session.model().activeNodes()), static_cast<double>(session.model().skinTriangles()),
               at_rest, substeps, nameOf(wanted), 1e3 * speed.tick_s, session.tick_s() / speed.tick_s,
               static_cast<double>(speed.work.skipped) / speed.ticks});
    addStages(session, wanted, report.isShort() ? kShortSeconds : kStagesSeconds, stages);
  }
  if (!report.isShort() && nodes != kMillion)
    report.note("The renderer is software, so a million nodes are skipped.\n");
  report.add(table, "live");
  report.add(stages, "live_stages");
}

}  // namespace viscera::bench
