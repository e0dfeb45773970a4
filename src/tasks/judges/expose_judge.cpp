// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include "math/number_text.h"
#include "tasks/task_kinds.h"
#include "viscera/session/session.h"
#include "viscera/session/tissue_processes.h"

namespace viscera {

namespace {

constexpr double kExposeMark = 0.5;  ///< radius of a place's mark over the radius within which it is freed
constexpr double kPercent = 100;

/// Judge of tissue that is freed: the least share, over all places, of the area of fibres near it that has parted.
class ExposeJudge : public TaskJudge {
 public:
  /// @throws TaskError  there are no fibres at a place
  ExposeJudge(const ExposeGoal& goal, const std::vector<FibreState>& fibres) : goal_(goal) {
    for (size_t i = 0; i < goal.places.size(); ++i) {
      Place place;
      for (uint32_t f = 0; f < fibres.size(); ++f)
        if ((fibres[f].rest_m - goal.places[i].position_m).norm() <= goal.radius_m) place.fibres.push_back(f);
      for (const uint32_t f : place.fibres) place.area_m2 += fibres[f].area_m2;
      if (place.fibres.empty())
        throw TaskError("'expose.places[" + std::to_string(i) +
                        "]' must be within 'expose.radius_m' of tissue that 'attachments' of the scene join; there "
                        "is none");
      places_.push_back(std::move(place));
    }
  }
  bool usesFibres() const override { return true; }
  void judge(const TaskTick& tick, TaskTally&) override {
    for (Place& place : places_) {
      double parted_m2 = 0;
      for (const uint32_t f : place.fibres) parted_m2 += tick.fibres[f].whole ? 0 : tick.fibres[f].area_m2;
      place.freed = parted_m2 / place.area_m2;
    }
  }
  double progress() const override { return std::min(1.0, least() / goal_.share); }
  bool reached() const override { return least() >= goal_.share; }
  std::string step() const override {
    return "free the marked places: " + fixedText(kPercent * least(), 0) + " % of " +
           fixedText(kPercent * goal_.share, 0) + " % at the least of them";
  }
  std::vector<MarkConfig> marks() const override {
    std::vector<MarkConfig> out;
    for (const TaskPosition& place : goal_.places)
      out.push_back(targetMark(place.position_m, Vector3d::Zero(), kExposeMark * goal_.radius_m));
    return out;
  }
  std::vector<MarkState> markStates() const override {
    std::vector<MarkState> out;
    for (const Place& place : places_) out.push_back(place.freed >= goal_.share ? MarkState::kDone : MarkState::kNext);
    return out;
  }

 private:
  struct Place {
    std::vector<uint32_t> fibres;  ///< indices into those of the scene
    double area_m2 = 0, freed = 0;
  };
  double least() const {
    double out = 1;
    for (const Place& place : places_) out = std::min(out, place.freed);
    return out;
  }

  const ExposeGoal goal_;
  std::vector<Place> places_;
};

}  // namespace

std::string exposeFault(const TaskConfig& task) {
  if (!task.expose.given) return groupFault(false, "expose");
  return task.expose.places.empty() ? "'expose.places' must be a list of one or more positions; found none" : "";
}

std::unique_ptr<TaskJudge> exposeJudge(const TaskConfig& task, const Session& session) {
  try {
    return std::make_unique<ExposeJudge>(task.expose, seenFibres(session));
  } catch (const TaskError& error) {
    throw TaskError(task.name + ": " + error.what());
  }
}

TaskShapes exposeShapes(const TaskConfig& task) {
  TaskShapes out;
  for (const TaskPosition& place : task.expose.places)
    out.lines_m.push_back(circleOf(place.position_m, Vector3d::UnitZ(), task.expose.radius_m));
  return out;
}

}  // namespace viscera
