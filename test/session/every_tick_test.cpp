// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Shipped lessons, saved at every tick: a session resumed from there equals the one that was never stopped.
#include <gtest/gtest.h>

#include <deque>
#include <limits>

#include "math/archive.h"
#include "support/source_folder.h"
#include "viscera/session/session.h"
#include "viscera/tools/strokes.h"

namespace viscera {
namespace {

constexpr int kGoesOn = 2;  // ticks

struct Lesson {
  const char *scene, *strokes;
  double from_s, to_s;                                         ///< time range in which it is saved
  const char* name = strokes;                                  ///< of the test
  double lets_go_s = std::numeric_limits<double>::infinity();  ///< time from which no button is pressed
  ToolMode button1 = ToolMode::kNone;                          ///< replaces the scene's, unless none
};
void PrintTo(const Lesson& lesson, std::ostream* out) {
  *out << lesson.name;
}

/// All outputs of a step that do not depend on the clock, compared to the bit.
struct Report {
  uint64_t hash = 0, trips = 0, springs_cut = 0;
  std::vector<double> numbers;
  bool operator==(const Report& other) const {
    return hash == other.hash && trips == other.trips && springs_cut == other.springs_cut && numbers == other.numbers;
  }
};

void PrintTo(const Report& report, std::ostream* out) {
  *out << "hash " << report.hash << ", trips " << report.trips << ", cut " << report.springs_cut << ", numbers";
  for (const double number : report.numbers) *out << ' ' << number;
}

Report reportedBy(const Session& session, const Frame& frame) {
  Report out{session.stateHash(), frame.health.trips, frame.stats.springs_cut, {}};
  const auto add = [&](const Vector3d& v) { out.numbers.insert(out.numbers.end(), v.data(), v.data() + v.size()); };
  for (size_t s = 0; s < layout::kMaxStyluses; ++s) {
    const TickContact& contact = frame.contacts[s];
    for (const Reaction* reaction : {&frame.reactions[s], &contact.reaction}) {
      add(reaction->force_n);
      add(reaction->torque_nm);
    }
    for (const Vector3d* v : {&contact.along, &contact.from_m, &contact.to_m}) add(*v);
    for (const double number : {contact.limit_n, contact.back_n, contact.stiffness_n_per_m, frame.jaw_moments_nm[s],
                                static_cast<double>(contact.kind), static_cast<double>(contact.anew)})
      out.numbers.push_back(number);
  }
  return out;
}

class EveryTick : public ::testing::TestWithParam<Lesson> {
 protected:
  Scene scene_;
  Strokes strokes_;

  EveryTick() {
    const std::string config = std::string(test::sourceFolder()) + "/config/";
    scene_ = loadScene(config + "scenes/" + GetParam().scene + ".yaml");
    strokes_ = loadStrokes(config + "strokes/" + GetParam().strokes + ".yaml");
    scene_.solver.backend = Backend::kCpu;
    scene_.solver.threads = 1;
    for (StylusConfig& stylus : scene_.styluses)
      if (GetParam().button1 != ToolMode::kNone) stylus.button1 = GetParam().button1;
  }
  Frame step(Session& session) const {
    const double time_s = static_cast<double>(session.tick() + 1) * session.tick_s();
    StylusSamples samples = strokes_.at(time_s, scene_.styluses);
    for (StylusSample& sample : samples)
      if (time_s > GetParam().lets_go_s) sample.button1 = sample.button2 = false;
    return session.step(samples, {});
  }
  void expectSame(double from_s, double to_s) {
    struct Save {
      Archive archive;
      std::vector<Report> report;  ///< immediately, and after each of the next ticks
    };
    Session unbroken(scene_), resumed(scene_);
    std::deque<Save> saves;
    for (uint64_t t = 1; static_cast<double>(t) * unbroken.tick_s() < to_s && !HasFailure(); ++t) {
      const Frame frame = step(unbroken);
      if (static_cast<double>(t) * unbroken.tick_s() < from_s) continue;
      const Report report = reportedBy(unbroken, frame);
      for (Save& save : saves) save.report.push_back(report);
      if (saves.size() > kGoesOn) {
        resume(resumed, saves.front().archive, saves.front().report);
        saves.pop_front();
      }
      saves.emplace_back();
      unbroken.save(saves.back().archive);
      saves.back().report.push_back(reportedBy(unbroken, unbroken.drain()));
    }
  }

 private:
  void resume(Session& resumed, const Archive& saved, const std::vector<Report>& report) const {
    Archive read(saved.sections());
    resumed.restore(read, "a test");
    const uint64_t tick = resumed.tick();
    for (const Report& unbroken : report) {
      const Frame frame = &unbroken == &report.front() ? resumed.drain() : step(resumed);
      EXPECT_EQ(reportedBy(resumed, frame), unbroken) << "tick " << resumed.tick() << ", saved after " << tick;
    }
  }
};

TEST_P(EveryTick, IsOneToGoOnFrom) {
  expectSame(GetParam().from_s, GetParam().to_s);
}

TEST_P(EveryTick, OfAllIsOneToGoOnFrom) {
  expectSame(0, strokes_.duration_s());
}

INSTANTIATE_TEST_SUITE_P(
    Lessons, EveryTick,
    ::testing::Values(Lesson{"gauze", "pattern_cut_good", 0.9, 1.2},
                      Lesson{"practice_skin", "incision_clumsy", 0.4, 0.9},
                      Lesson{"practice_pad", "touch_targets_clumsy", 0.5, 1.0},
                      Lesson{"practice_pad", "gentle_lift_clumsy", 0.8, 1.5},
                      Lesson{"practice_vessel", "clip_and_divide_good", 1.2, 1.5, "grasper", 1.4, ToolMode::kGrasper},
                      Lesson{"wound_pad", "close_wound_clumsy", 0.9, 1.2},
                      Lesson{"practice_vessel", "clip_and_divide_good", 1.2, 1.8},
                      Lesson{"suture_pad", "suture", 0.9, 1.2}, Lesson{"running_suture", "running_suture", 2.8, 3.0},
                      Lesson{"running_suture", "running_suture", 2.5, 2.7, "loose_needle", 2.6},
                      Lesson{"cautery_pad", "cautery", 0.9, 1.1}, Lesson{"bleeding_vessel", "bleeding", 0.6, 1.6},
                      Lesson{"hollow_vessel", "hollow_vessel", 3.9, 4.2},
                      Lesson{"skin_under_tension", "incision", 0.3, 0.5},
                      Lesson{"cloth_on_points", "cut_cloth", 1.1, 1.3}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace viscera
