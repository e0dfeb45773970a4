// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/suture/tearing_trial.h"

#include <algorithm>
#include <cmath>

#include "bench/harness/specimens/block_on_bone.h"
#include "bench/suites/suture/sutures.h"
#include "solver/processes/suture/suture_bodies.h"
#include "viscera/math/state_hash.h"
#include "viscera/session/session.h"
#include "viscera/session/tissue_processes.h"

namespace viscera::bench {

namespace {

constexpr double kGrip_n = 20, kSpeed_m_per_s = 1, kReach_m = 0.03;
constexpr double kLongest_s = 5;  // for a block: what has not torn by then is out of reach
constexpr double kTop_m = 0.009, kSpacing_m = 0.003;
const Vector3d kTool_m(0.010, 0, 0.05);

/// Returns a point in the plane of the suture [mm].
Vector3d inPlane(double x, double z) {
  return 1e-3 * Vector3d(x, 0, z);
}

/// Adds a bite: in through the surface, 6 mm deep, and out 9 mm further on.
void addBite(double x_mm, SutureConfig& suture) {
  suture.path.push_back({inPlane(x_mm, 9.8)});
  for (const auto& [ahead, height] :
       {std::pair<double, double>{0, 8.3}, {0.5, 5.5}, {3, 3.2}, {6, 3.2}, {8.5, 5.5}, {9, 8.3}}) {
    suture.path.push_back({inPlane(x_mm + ahead, height)});
    suture.channels.push_back({"", inPlane(x_mm + ahead, height)});
  }
  suture.path.push_back({inPlane(x_mm + 9, 9.8)});
}

/// Returns a block on bone, 36 x 30 x 9 mm.
Scene padScene(double young_modulus_pa, int threads) {
  Scene scene;
  scene.name = "pad";
  scene.bodies.push_back(blockOnBone(Vector3d(0.036, 0.03, kTop_m), kSpacing_m, young_modulus_pa));
  scene.styluses.resize(1);
  scene.styluses[0].idle = ToolMode::kGrab;
  scene.styluses[0].button2 = ToolMode::kCut;
  scene.styluses[0].max_force_n = kGrip_n;
  SutureConfig suture;
  suture.material = SutureMaterial::kSilk;
  suture.usp = SutureSize::kUsp4;
  suture.position_m = inPlane(-14, 13);
  suture.start = SutureEnd::kFixed;
  addBite(-12, suture);
  addBite(3, suture);
  suture.path.push_back({inPlane(10, 14)});
  suture.path.push_back({kTool_m});
  scene.sutures.push_back(suture);
  scene.solver.backend = Backend::kCpu;
  scene.solver.threads = threads;
  return scene;
}

/// A user who moves back and forth, in a different direction each time.
class RoughTool {
 public:
  /// Returns the next sample. Initially it is at the suture's end.
  StylusSamples next(double tick_s) {
    StylusSamples out;
    out[0].valid = true;
    out[0].pose.position_m = kTool_m + kReach_m * std::sin(phase_) * direction_;
    phase_ += tick_s * kSpeed_m_per_s / kReach_m;
    if (phase_ > 2 * kPi) {
      phase_ -= 2 * kPi;
      direction_ = Vector3d(random(), random(), random()).normalized();
    }
    return out;
  }
  void beginAgain() { phase_ = 0; }

 private:
  double random() {
    seed_ = seed_ * 1664525U + 1013904223U;
    return static_cast<double>(seed_ >> 8) / 16777216.0 - 0.5;
  }
  uint32_t seed_ = 1;
  double phase_ = 0;
  Vector3d direction_{0.1, 0.2, 0.97};
};

}  // namespace

TearingTrial tornOut(double seconds, double young_modulus_pa, int threads) {
  Session session(padScene(young_modulus_pa, threads));
  const SutureBodies& bodies = *findProcess<SutureBodies>(session.solver());
  const size_t channels = bodies.slides(0).size();
  RoughTool tool;
  TearingTrial out;
  StateHash hash;
  const double from_s = cpuTime_s();
  const auto endBlock = [&] {
    const Frame last = session.drain();
    out.torn += static_cast<double>(channels - bodies.slides(0).size());
    out.springs += last.stats.springs_cut;
    const Extremes& extremes = session.extremes();
    out.nonfinite += static_cast<double>(extremes.nonfinite);
    out.most_force_n = std::max(out.most_force_n, extremes.peak_force_n);
    out.stretch = std::max(out.stretch, extremes.max_stretch);
    const uint64_t state = session.stateHash();
    hash.add(static_cast<uint32_t>(state));
    hash.add(static_cast<uint32_t>(state >> 32));
  };
  const int ticks = static_cast<int>(std::lround(seconds / session.tick_s()));
  for (int t = 0; t < ticks; ++t) {
    if (bodies.slides(0).empty() || static_cast<double>(session.tick()) * session.tick_s() > kLongest_s) {
      endBlock();
      session.reset();
      tool.beginAgain();
      ++out.blocks;
    }
    session.step(tool.next(session.tick_s()), {});
    for (const Vector3d& position : suturePositions(session, 0)) out.nonfinite += !position.allFinite();
    const std::vector<ChainSlide>& slides = bodies.slides(0);
    for (size_t k = 0; k + 1 < slides.size(); ++k)
      out.nearest_links = std::min(out.nearest_links, slides[k].between_rest_m / bodies.chain(0).link_m());
  }
  endBlock();
  out.trips = static_cast<double>(session.solver().health().trips);
  const SutureLinks& links = bodies.links();
  out.substeps = static_cast<double>(links.substeps);
  out.off = static_cast<double>(links.off);
  out.worst_link = links.worst;
  out.iterations = links.iterations / out.substeps;
  out.waits = static_cast<double>(links.waits);
  out.seconds_of_cpu = cpuTime_s() - from_s;
  out.hash = hash.value();
  return out;
}

}  // namespace viscera::bench
