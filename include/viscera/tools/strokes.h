// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/model/model.h"
#include "viscera/model/part_position.h"
#include "viscera/model/scene/organ_fit.h"
#include "viscera/tools/stylus.h"

namespace VISCERA_PUBLIC viscera {

struct StylusConfig;

/// Ray towards the tissue. The stroke's own frame has its origin where the ray first meets the surface at rest: z back
/// along the ray, x horizontal, y upwards. A stroke in this frame touches any organ, whatever its shape.
struct Anchor {
  Vector3d from_m, towards_m;  ///< two points of the ray, tissue frame [m]
};

/// Timed poses and buttons of one stylus, in the tissue frame, or in that of the anchor until resolveAnchors(). They
/// are either way-points (`keys`) between which poses are interpolated, or recorded tick by tick (`samples`).
struct Stroke {
  struct Key {
    double time_s;
    Pose pose;
    bool button1, button2;
    double jaw_rad = kNoJaw;              ///< as StylusSample::jaw_rad; interpolated between keys that both have one
    std::optional<PartPosition> at = {};  ///< position of the tip relative to a part, until resolveAnchors()
  };
  /// Input of a simulation from a stylus in a tick, as recorded: replayed to the bit.
  struct Sample {
    uint64_t tick = 0;  ///< tick, from 1 on
    Pose pose;
    bool button1 = false, button2 = false;
    float jaw_rad = kNoJaw;  ///< as StylusSample::jaw_rad
  };
  std::string stylus;     ///< name of a stylus of the scene
  std::vector<Key> keys;  ///< way-points, with strictly increasing times; empty where there are samples
  std::optional<Anchor> anchor;
  std::vector<Sample> samples = {};  ///< ticks strictly increasing; the stylus is absent in ticks without one
};

/// Time of an image: `viscera run` saves one per camera under this name.
struct Mark {
  std::string name;
  double time_s;
};

/// Origin of a recording, as its simulator reported it; empty where unknown.
struct RecordedFrom {
  std::string scene;       ///< name or path of the scene
  std::string overrides;   ///< scene keys, as in "bodies[0].spacing_m=0.004;solver.tick_hz=100"
  std::string state_hash;  ///< state hash at the end, 16 hexadecimal digits
};

/// Contents of a strokes file.
struct Strokes {
  std::vector<Stroke> strokes;
  std::vector<Mark> marks;
  double tick_hz = 0;  ///< tick rate of the recorded simulation [Hz]; 0: nothing was recorded
  uint64_t ticks = 0;  ///< number of recorded ticks
  /// Ticks before which the simulation discarded device input, as in a pause; increasing.
  std::vector<uint64_t> input_reset;
  RecordedFrom recorded;
  std::string file;  ///< file that they were read from, for errors; empty: none
  double duration_s() const;
  /// Returns whether Tools::clear() is due before this tick; ticks count from 1.
  bool inputReset(uint64_t tick) const;
  /// Checks the tick rate of a scene. @throws StrokesError  ticks were recorded, and the scene has another rate
  void requireTickRate(double scene_tick_hz) const;
  bool anchored() const;  ///< some stroke still waits for resolveAnchors()
  /// Returns the samples at a time; anchors must have been resolved. Poses are interpolated between keys, buttons are
  /// those of the last key; samples are invalid before the first key. Of recorded samples it returns those of the last
  /// tick up to this time, to the bit.
  /// @param configs  styluses of the scene, in order
  StylusSamples at(double time_s, const std::vector<StylusConfig>& configs) const;
};

/// Reads a strokes file.
/// @throws StrokesError  file, line and key, for a missing file, an unknown key, times that do not increase,
///                       a number out of range
Strokes loadStrokes(const std::string& path);
Strokes parseStrokes(const std::string& yaml, const std::string& name);

/// Transforms anchored strokes, and keys relative to parts, into the tissue frame.
/// @param fit  of a scene to an organ that neither it nor the strokes were made for: their anchors and keys follow it
/// @returns a line for a person for each stroke that meets only fixed tissue
/// @throws StrokesError if a ray misses every surface, or the tissue has no part of a name
std::vector<std::string> resolveAnchors(Strokes& strokes, const Model& model,
                                        const std::optional<OrganFit>& fit = std::nullopt);

/// Returns the strokes as a file that loadStrokes() reads; anchors must have been resolved.
std::string strokesYaml(const Strokes& strokes);

}  // namespace viscera
