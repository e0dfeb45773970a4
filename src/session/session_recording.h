// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "math/archive.h"
#include "viscera/model/scene/overrides.h"

namespace viscera {

struct Scene;

// What chunks of a recording hold, to memory and back.

/// The scene of a session, as its recorder found it.
struct RecordedScene {
  std::string version;  ///< of the program
  std::string folder;   ///< where its relative files are
  std::string yaml;     ///< resolvedYaml()
  std::string stepped_by;
  double tick_hz = 0;
  uint32_t styluses = 0;
  uint32_t sample_bytes = 0;  ///< of a hand: another layout is another version

  static RecordedScene of(const Scene& scene, const std::string& stepped_by);
  std::vector<char> bytes();
  /// @throws Error  damaged, or of another layout
  static RecordedScene from(std::vector<char> bytes);
  /// @param name  for errors   @throws SceneError
  Scene scene(const std::string& name, const Overrides& overrides) const;

 private:
  void persist(Archive& archive);
};

/// A state of it. @throws Error  damaged
struct RecordedState {
  bool leaps = false;  ///< it was brought into this state: it did not come there by itself
  uint64_t tick = 0, hash = 0;
  std::vector<Archive::Section> sections;  ///< of Session::save(); of an end: none

  std::vector<char> bytes();
  static RecordedState from(std::vector<char> bytes);

 private:
  void persist(Archive& archive);
};

}  // namespace viscera
