// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viscera/model/model.h"
#include "viscera/model/scene/organ_fit.h"
#include "viscera/tools/stylus.h"

namespace viscera {

struct StylusConfig;

/// A ray towards the tissue. Where it first meets the skin at rest lies the origin of the stroke's own frame: z back
/// along the ray, x horizontal, y upwards. A stroke made so touches any organ, whatever its shape.
struct Anchor {
  Vector3d from_m, towards_m;  ///< two points of the ray, tissue frame
};

/// Timed poses and buttons of one stylus: in the tissue frame, or in that of the anchor until resolveAnchors(). Either
/// way-points (`keys`) between which poses are interpolated, or what was recorded tick by tick (`samples`).
struct Stroke {
  struct Key {
    double time_s;
    Pose pose;
    bool button1, button2;
    double jaw_rad = kNoJaw;  ///< as StylusSample::jaw_rad; between keys that both have one it is interpolated
  };
  /// What a simulation took from a hand in a tick, as it was recorded: replayed to the bit.
  struct Sample {
    uint64_t tick = 0;  ///< from 1 on
    Pose pose;
    bool button1 = false, button2 = false;
    float jaw_rad = kNoJaw;  ///< as StylusSample::jaw_rad
  };
  std::string stylus;     ///< name of a stylus of the scene
  std::vector<Key> keys;  ///< times strictly increasing; empty where there are samples
  std::optional<Anchor> anchor;
  std::vector<Sample> samples = {};  ///< ticks strictly increasing; the stylus is absent in ticks without one
};

/// A moment worth a picture: `viscera run` saves one per camera under this name.
struct Mark {
  std::string name;
  double time_s;
};

/// What a recording was made of, as its simulator was told; empty where that is not known.
struct RecordedFrom {
  std::string scene;       ///< name or path
  std::string overrides;   ///< scene keys, as in "bodies[0].spacing_m=0.004;solver.tick_hz=100"
  std::string state_hash;  ///< at the end, 16 hexadecimal digits
};

/// A recorded strokes file.
struct Strokes {
  std::vector<Stroke> strokes;
  std::vector<Mark> marks;
  double tick_hz = 0;                ///< of the simulation that was recorded; 0: nothing was
  uint64_t ticks = 0;                ///< how many were recorded
  std::vector<uint64_t> hands_anew;  ///< before these ticks it forgot where hands were, as in a pause; increasing
  RecordedFrom recorded;
  std::string file;  ///< where they were read, for errors; empty: nowhere
  double duration_s() const;
  /// Tools::forget() is due before this tick, the first of which is 1.
  bool handsAnew(uint64_t tick) const;
  /// @throws StrokesError  ticks were recorded, and a scene has others
  void requireTickRate(double scene_tick_hz) const;
  bool anchored() const;  ///< some stroke still waits for resolveAnchors()
  /// Samples at a time; anchors must have been resolved: poses interpolated between keys, buttons of the last key;
  /// invalid before the first key. Of recorded ones: that of the last tick up to this time, to the bit.
  /// @param configs  the scene's styluses, in order
  StylusSamples at(double time_s, const std::vector<StylusConfig>& configs) const;
};

/// @throws StrokesError  file, line and key, for a missing file, an unknown key, times that do not increase,
///                       a number out of range
Strokes loadStrokes(const std::string& path);
Strokes parseStrokes(const std::string& yaml, const std::string& name);

/// Brings anchored strokes into the tissue frame.
/// @param fit  of a scene to an organ that neither it nor the strokes were made for: their anchors and keys follow it
/// @returns a line for a person for each stroke that meets only tissue that is held
/// @throws StrokesError if a ray misses every skin
std::vector<std::string> resolveAnchors(Strokes& strokes, const Model& model,
                                        const std::optional<OrganFit>& fit = std::nullopt);

/// The strokes as a file that loadStrokes() reads; anchors must have been resolved.
std::string strokesYaml(const Strokes& strokes);

}  // namespace viscera
