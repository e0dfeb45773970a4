// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The shipped wounds are open once they are cut. One is closed by four stitches that are tied, also when their tails
// are cut; the other by the four stitches of a running suture with a needle.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "solver/processes/suture/suture_bodies.h"
#include "support/source_folder.h"
#include "viscera/gpu/context.h"
#include "viscera/session/session.h"
#include "viscera/session/tissue_processes.h"
#include "viscera/tools/strokes.h"

namespace viscera {
namespace {

constexpr double kHalf_m = 0.0015, kRestGap_m = 0.003;  // nodes next to the wound's plane, x = 0
constexpr double kWoundEnds_m = 0.0135;  // rows of nodes along it, y, farther than that are not separated
constexpr double kCutDown_m = 0.0015;    // z of the blade's tip

constexpr double kLastStitch_m = -0.01125, kBesideStitch_m = 0.0025;  // y of the running suture's last stitch; rows

struct Gap {
  double mean_m = 0, skin_m = 0;  // of all pairs across the wound, and of those at the surface
  double last_m = 0;              // largest of those at the surface next to the running suture's last stitch
};

/// Returns the gaps of two nodes across the wound in excess of their rest distance.
Gap gapOf(const Session& session) {
  const HostState state = session.solver().readState();
  const Body& body = session.model().bodies[0];
  const auto displaced = [&](uint32_t slot) -> Vector3d {
    const layout::vec4& by = state.displacement_m[slot];
    return Vector3d(by.x, by.y, by.z);
  };
  Gap out;
  int all = 0, skin = 0;
  for (const uint32_t left : body.lattice.active_slots) {
    const Vector3d at_m = restPosition(body, left);
    if (std::abs(at_m.x() + kHalf_m) > 1e-6 || std::abs(at_m.y()) > kWoundEnds_m || at_m.z() < kCutDown_m) continue;
    for (const uint32_t right : body.lattice.active_slots) {
      if ((restPosition(body, right) - at_m - kRestGap_m * Vector3d::UnitX()).norm() > 1e-6) continue;
      const double gap_m = (displaced(right) - displaced(left)).x();
      out.mean_m += gap_m;
      ++all;
      if (at_m.z() < 0.005) continue;
      out.skin_m += gap_m;
      ++skin;
      if (std::abs(at_m.y() - kLastStitch_m) < kBesideStitch_m) out.last_m = std::max(out.last_m, gap_m);
    }
  }
  out.mean_m /= all;
  out.skin_m /= skin;
  return out;
}

struct Sutured {
  Gap open, tied, cut;
  std::vector<SutureState> sutures;
  uint64_t hash = 0, trips = 0;
};

Sutured sutured(double young_pa, Backend backend) {
  const std::string config = std::string(test::sourceFolder()) + "/config/";
  Scene scene = loadScene(config + "scenes/suture_pad.yaml");
  const Strokes strokes = loadStrokes(config + "strokes/suture.yaml");
  const double stiffer = young_pa / scene.bodies[0].material.young_modulus_pa;
  scene.bodies[0].material.young_modulus_pa = young_pa;
  scene.solver.backend = backend;
  for (SutureConfig& suture : scene.sutures) suture.ties[0].tension_n *= stiffer;
  std::optional<gpu::Context> context;
  if (backend == Backend::kGpu) context.emplace();
  Session session = context ? Session(scene, *context) : Session(scene);
  Sutured out;
  const auto until = [&](double time_s) {
    while (static_cast<double>(session.tick()) * session.tick_s() < time_s)
      session.step(strokes.at(static_cast<double>(session.tick() + 1) * session.tick_s(), scene.styluses), {});
    return gapOf(session);
  };
  out.open = until(2.9);
  out.tied = until(7.4);
  out.cut = until(strokes.duration_s());
  out.sutures = sutureStates(session);
  session.drain();
  out.hash = session.stateHash();
  out.trips = session.extremes().roll_backs;
  return out;
}

void expectClosed(double young_pa, Backend backend = Backend::kCpu) {
  constexpr double kOpen_m = 0.0008, kMean_m = 3e-4, kSkin_m = 5e-4;  // that wound gapes by a millimetre and more
  constexpr size_t kSutures = 4, kTails = 8;
  const Sutured found = sutured(young_pa, backend);
  printf("E %.0f kPa: gap open %.2f (skin %.2f), tied %.2f (%.2f), tails cut %.2f (%.2f) mm\n", young_pa / 1e3,
         1e3 * found.open.mean_m, 1e3 * found.open.skin_m, 1e3 * found.tied.mean_m, 1e3 * found.tied.skin_m,
         1e3 * found.cut.mean_m, 1e3 * found.cut.skin_m);
  EXPECT_GT(found.open.skin_m, kOpen_m);
  for (const Gap& gap : {found.tied, found.cut}) {
    EXPECT_LT(gap.mean_m, kMean_m);
    EXPECT_LT(gap.skin_m, kSkin_m);
  }
  EXPECT_EQ(found.trips, 0U);
  EXPECT_GE(found.sutures.size(), kSutures + kTails);  // a hanging tail may be met twice
  size_t knots = 0;
  for (const SutureState& suture : found.sutures) {
    for (const KnotState& knot : suture.knots) {
      EXPECT_TRUE(knot.tied);
      ++knots;
    }
  }
  EXPECT_EQ(knots, kSutures);
}

struct Sewn {
  Gap open, drawn, tied;
  std::array<size_t, 8> channels{};  ///< of each stitch in the left lip, then in the right one
  double worst_link = 0, tail_off_m = 0;
  SutureState suture;
  uint64_t trips = 0, nonfinite = 0;
};

/// Assigns channels by position: they were made in the order of the needle's path.
void countChannels(const Session& session, std::array<size_t, 8>& channels) {
  constexpr double kStitches_m[] = {0.01125, 0.00375, -0.00375, kLastStitch_m};
  for (const ChainSlide& slide : findProcess<SutureBodies>(session.solver())->slides(0)) {
    for (size_t k = 0; k < 4; ++k) {
      if (std::abs(slide.to_m.y() - kStitches_m[k]) < kBesideStitch_m) ++channels[2 * k + (slide.to_m.x() > 0 ? 1 : 0)];
    }
  }
}

Sewn sewn() {
  const std::string config = std::string(test::sourceFolder()) + "/config/";
  const Scene scene = loadScene(config + "scenes/running_suture.yaml");
  const Strokes strokes = loadStrokes(config + "strokes/running_suture.yaml");
  const auto mark_s = [&](const char* name) {
    return std::find_if(strokes.marks.begin(), strokes.marks.end(), [&](const Mark& mark) { return mark.name == name; })
        ->time_s;
  };
  Session session(scene);
  Sewn out;
  const auto until = [&](double time_s) {
    while (static_cast<double>(session.tick()) * session.tick_s() < time_s) {
      session.step(strokes.at(static_cast<double>(session.tick() + 1) * session.tick_s(), scene.styluses), {});
      const SutureBodies& sutures = *findProcess<SutureBodies>(session.solver());
      out.worst_link = std::max(out.worst_link, sutures.chain(0).worstLink());
      out.tail_off_m = std::max(out.tail_off_m, (suturePositions(session, 0)[0] - sutures.needle(0)->tail_m()).norm());
    }
    return gapOf(session);
  };
  out.open = until(mark_s("wound"));
  out.drawn = until(mark_s("drawn"));
  out.tied = until(strokes.duration_s());
  countChannels(session, out.channels);
  out.suture = sutureStates(session)[0];
  session.drain();
  out.trips = session.extremes().roll_backs;
  out.nonfinite = session.extremes().nonfinite;
  return out;
}

TEST(RunningSuture, ANeedleSewsAWoundClosed) {
  constexpr double kOpen_m = 0.0015, kMean_m = 3e-4, kSkin_m = 5e-4;
  constexpr double kLink = 1e-3, kOnTail_m = 1e-4;
  const Sewn found = sewn();
  printf(
      "gap open %.2f (skin %.2f), drawn %.2f (%.2f), tied %.2f (%.2f, at the last stitch %.2f) mm; worst link %.1e\n",
      1e3 * found.open.mean_m, 1e3 * found.open.skin_m, 1e3 * found.drawn.mean_m, 1e3 * found.drawn.skin_m,
      1e3 * found.tied.mean_m, 1e3 * found.tied.skin_m, 1e3 * found.tied.last_m, found.worst_link);
  EXPECT_GT(found.open.skin_m, kOpen_m);
  for (const Gap& gap : {found.drawn, found.tied}) {
    EXPECT_LT(gap.mean_m, kMean_m);
    EXPECT_LT(gap.skin_m, kSkin_m);
  }
  for (size_t lip = 0; lip < found.channels.size(); ++lip)
    EXPECT_GE(found.channels[lip], 2U) << "stitch " << lip / 2 << (lip % 2 ? ", right lip" : ", left lip");
  EXPECT_LT(found.tied.last_m, kSkin_m);  // without its knot, with the suture's last loop, 0.9 mm
  ASSERT_EQ(found.suture.knots.size(), 2U);
  for (const KnotState& knot : found.suture.knots) EXPECT_TRUE(knot.tied);
  EXPECT_LT(found.worst_link, kLink);
  EXPECT_LT(found.tail_off_m, kOnTail_m);
  EXPECT_EQ(found.trips, 0U);
  EXPECT_EQ(found.nonfinite, 0U);
}

TEST(SuturePad, FourStitchesCloseAWoundInSoftTissue) {
  expectClosed(1e4);
}

TEST(SuturePad, AndInStiffer) {
  expectClosed(5e4);
}

TEST(SuturePad, AndOnTheGpuBackend) {
  expectClosed(1e4, Backend::kGpu);
}

}  // namespace
}  // namespace viscera
