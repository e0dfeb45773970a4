// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstring>
#include <sstream>

#include "math/archive.h"
#include "math/number_text.h"
#include "model/scene/scene_text.h"
#include "session/state_file.h"
#include "session/view.h"
#include "solver/tissue/carried_tissue.h"
#include "tools/restored_tools.h"
#include "tools/shaft_meeting.h"
#include "viscera/math/state_hash.h"
#include "viscera/session/session.h"
#include "viscera/session/session_log.h"

namespace viscera {

namespace {

constexpr uint64_t kTicksBack = 8;  // ticks with paths of tips that may be needed later

/// Returns whether a key changes no state: threads, cameras, appearance.
bool isAside(const std::string& line) {
  const std::string key = line.substr(0, line.find('='));
  const auto ends = [&key](const std::string& with) {
    return key.size() >= with.size() && key.compare(key.size() - with.size(), with.size(), with) == 0;
  };
  return key.rfind("cameras[", 0) == 0 || key == "solver.threads" || key == "solver.device" || ends(".color") ||
         ends(".roughness") || ends(".color_variation") || ends(".specular_wetness") || ends(".cut_wall_texture") ||
         ends(".blanching");
}

/// Checks that two texts of a scene agree. @throws Error  names the first key that differs
void requireSame(const std::string& saved, const std::string& here) {
  TextIn saved_lines(saved), here_lines(here);
  const auto next = [](std::istringstream& lines) {
    std::string line;
    while (std::getline(lines, line)) {
      if (!isAside(line)) return line;
    }
    return std::string("no further key");
  };
  for (;;) {
    const std::string a = next(saved_lines), b = next(here_lines);
    if (a != b) throw Error("the state belongs to another scene: saved " + a + ", here " + b);
    if (a == "no further key") return;
  }
}

template <class T>
void addBytes(StateHash& hash, const std::vector<T>& values) {
  const char* at = reinterpret_cast<const char*>(values.data());
  for (size_t left = values.size() * sizeof(T); left >= sizeof(uint32_t); left -= sizeof(uint32_t)) {
    uint32_t word;
    std::memcpy(&word, at, sizeof word);
    hash.add(word);
    at += sizeof word;
  }
}

/// Returns a fingerprint of the model made from the scene and the files that it names.
uint64_t modelHash(const Model& model) {
  StateHash hash;
  for (const Body& body : model.bodies) {
    for (int c = 0; c < 3; ++c) hash.add(static_cast<float>(body.lattice.origin_m[c]));
    hash.add(static_cast<float>(body.lattice.spacing_m));
    addBytes(hash, body.lattice.nodes);
    addBytes(hash, body.lattice.active_slots);
    addBytes(hash, body.lattice.cell_fills);
    addBytes(hash, body.lattice.depth_m);
    if (body.network) addBytes(hash, body.network->masses_kg);
  }
  return hash.value();
}

}  // namespace

/// Saves or restores the session itself; solver and tools have their own sections.
void Session::persist(Archive& archive) {
  archive.section("session");
  archive.value(tick_);
  archive.value(ticks_);
  archive.value(time_s_);
  archive.value(judged_);
  archive.value(stats_);
  archive.value(has_stats_);
  archive.value(reactions_);
  archive.value(contacts_);
  archive.value(jaw_moments_nm_);
  archive.values(obstacle_forces_);
  archive.value(extremes_);
  archive.value(request_.motions);
  requireModes(archive, request_.motions);
  archive.values(request_.obstacles);
  for (ForceLimiter& limiter : limiters_) archive.value(limiter);
  shafts_->persist(archive);
  tools_.persist(archive);
  obstacles_.persist(archive);
  for (uint64_t t = tick_ - std::min(tick_, kTicksBack - 1); t <= tick_; ++t) {
    PoseTimes& times = pose_times_[t % pose_times_.size()];
    archive.value(times);
    if (archive.reads()) times.received = {};  // from another clock
  }
  solver_->persist(archive);
}

void Session::save(Archive& archive) {
  Frame taken;
  collectStats(taken, true);
  archive.section("scene");
  std::string text = sceneText(scene_);
  uint64_t hash = modelHash(*model_);
  archive.list(text);
  archive.value(hash);
  persist(archive);
}

void Session::save(const std::string& path) {
  Archive archive;
  save(archive);
  writeStateFile(path, archive.sections());
}

void Session::restore(const std::string& path) {
  Archive archive(readStateFile(path));
  restore(archive, path);
}

void Session::restore(Archive& archive, const std::string& name) {
  try {
    archive.section("scene");
    std::string text;
    uint64_t hash = 0;
    archive.list(text);
    archive.value(hash);
    requireSame(text, sceneText(scene_));
    if (hash != modelHash(*model_))
      throw Error("the state belongs to other tissue: a file that the scene names has changed");
  } catch (const Error& error) {
    throw Error(name + ": " + error.what());
  }
  reset();
  try {
    persist(archive);
    archive.end();
  } catch (const Error& error) {
    reset();
    throw Error(name + ": " + error.what() + "; solver.backend or the version of viscera may differ");
  }
  for (SessionLog* log : logs_) log->restored(*this);
}

CarriedTissue Session::carried() const {
  requireContext();
  return {model_, solver_->readState()};
}

void Session::carry(const CarriedTissue& tissue) {
  const auto named = [](const Model& model) {
    std::vector<std::string> names;
    for (const Body& body : model.bodies) names.push_back(body.name);
    return names;
  };
  if (named(*tissue.model) != named(*model_)) throw Error("a state can only be continued with the same bodies");
  reset();
  solver_->goOnFrom(carriedState(tissue, *model_, solver_->readState()));
  for (SessionLog* log : logs_) log->restored(*this);
}

}  // namespace viscera
