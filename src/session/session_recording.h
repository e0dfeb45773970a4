// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "math/archive.h"
#include "viscera/model/scene/overrides.h"

namespace viscera {

struct Scene;

// Contents of a recording's chunks, to memory and back.

/// Scene of a session when its recording began.
struct RecordedScene {
  std::string version;  ///< version of the program
  std::string folder;   ///< folder of its relative files
  std::string yaml;     ///< resolvedYaml()
  std::string stepped_by;
  double tick_hz = 0;
  uint32_t styluses = 0;
  uint32_t sample_bytes = 0;  ///< size of a stylus sample [bytes]: another layout is another version

  static RecordedScene of(const Scene& scene, const std::string& stepped_by);
  std::vector<char> bytes();
  /// Parses a scene. @throws Error  damaged, or of another layout
  static RecordedScene from(std::vector<char> bytes);
  /// Returns the scene. @param name  for errors   @throws SceneError  as parseScene()
  Scene scene(const std::string& name, const Overrides& overrides) const;

 private:
  void persist(Archive& archive);
};

/// State of a session. @throws Error  damaged
struct RecordedState {
  bool leaps = false;  ///< the session was set to this state, it did not reach it by steps
  uint64_t tick = 0, hash = 0;
  std::vector<Archive::Section> sections;  ///< sections of Session::save(); none at an end

  std::vector<char> bytes();
  static RecordedState from(std::vector<char> bytes);

 private:
  void persist(Archive& archive);
};

}  // namespace viscera
