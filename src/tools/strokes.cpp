// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/strokes.h"

#include <algorithm>
#include <cmath>

#include "math/memory_for.h"
#include "model/part_position_fields.h"
#include "model/scene/yaml/yaml_reader.h"
#include "tools/stroke_samples.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr double kLongestStrokeS = 3600;
constexpr double kMostKeys = 1e6;
constexpr Range kTickRate{1, 1000};  // as solver.tick_hz
constexpr double kMostTicks = kLongestStrokeS * 1000;
constexpr double kTickRounding = 1e-6;  // in ticks: a time computed from a tick must map back to it

/// Key as in the file; missing values are zero or released.
struct FileKey {
  int line = 0;
  double t_s = 0;
  Vector3d position_m = Vector3d::Zero();
  PartPosition at;
  bool has_position = false, has_at = false;
  Vector3d rotation_deg = Vector3d::Zero();
  bool button1 = false, button2 = false;
  double jaw_rad = kNoJaw;
};
struct FileAnchor {
  Vector3d from_m = Vector3d::Zero(), towards_m = Vector3d::Zero();
};
struct FileStroke {
  int line = 0;
  std::string stylus;
  FileAnchor anchor;
  bool anchored = false;
  std::vector<FileKey> keys;
  std::string samples;
  int samples_line = 0;  ///< 0: there are none
};
struct FileMark {
  int line = 0;
  std::string name;
  double t_s = 0;
};
struct FileRecorded : RecordedFrom {};
struct FileStrokes {
  double tick_hz = 0, ticks = 0;
  FileRecorded recorded;
  std::vector<double> input_reset;
  std::vector<FileStroke> strokes;
  std::vector<FileMark> marks;
};

void visitFields(YamlReader& v, FileKey& c) {
  c.line = v.line();
  v.number("t_s", c.t_s, {0, kLongestStrokeS}, "s", "time from the start");
  c.has_position = v.has("position_m");
  v.vector("position_m", c.position_m, {-100, 100}, "m", "position of the stylus tip in the tissue frame");
  c.has_at = v.has("at");
  v.group("at", c.at, "position of the stylus tip relative to a part at rest, instead of position_m");
  v.vector("rotation_deg", c.rotation_deg, {-360, 360}, "deg",
           "rotation of the stylus: turns about the fixed x, then y, then z axis");
  v.boolean("button1", c.button1, "");
  v.boolean("button2", c.button2, "");
  v.number("jaw_rad", c.jaw_rad, {0, kWidestJaw_rad}, "rad", "opening of the tool's jaws, instead of a button");
}

void visitFields(YamlReader& v, FileAnchor& c) {
  v.vector("from_m", c.from_m, {-100, 100}, "m", "start of the ray in the tissue frame");
  v.vector("towards_m", c.towards_m, {-100, 100}, "m", "point that the ray passes through");
}

void visitFields(YamlReader& v, FileStroke& c) {
  c.line = v.line();
  c.anchored = v.has("anchor");
  v.group("anchor", c.anchor, "ray; keys are relative to the point where it meets the surface");
  v.text("stylus", c.stylus, "name of a stylus of the scene");
  v.list("keys", c.keys, kMostKeys, "");
  v.block("samples", c.samples, c.samples_line, "recorded samples, a line per tick");
}

void visitFields(YamlReader& v, FileMark& c) {
  c.line = v.line();
  v.text("name", c.name, "name of the picture");
  v.number("t_s", c.t_s, {0, kLongestStrokeS}, "s", "time from the start");
}

void visitFields(YamlReader& v, FileRecorded& c) {
  v.text("scene", c.scene, "name or path of the scene that was recorded");
  v.text("overrides", c.overrides, "overrides of the scene, separated by semicolons");
  v.text("state_hash", c.state_hash, "state hash at the end of the recording, 16 hexadecimal digits");
}

void visitFields(YamlReader& v, FileStrokes& c) {
  v.number("tick_hz", c.tick_hz, kTickRate, "Hz", "ticks per second of the recording");
  v.number("ticks", c.ticks, {0, kMostTicks}, "1", "number of recorded ticks");
  v.group("recorded", c.recorded, "source of the recording");
  v.numbers("input_reset", c.input_reset, kMostKeys, {1, kMostTicks}, "1");
  v.list("strokes", c.strokes, 16, "recorded strokes");
  v.list("marks", c.marks, 1000, "times at which a picture is taken");
}

std::string lineOf(const std::string& name, int line) {
  return name + ":" + std::to_string(line);
}

Stroke checked(const FileStroke& file, size_t index, const std::string& name) {
  const std::string item = ": strokes[" + std::to_string(index) + "]", where = lineOf(name, file.line) + item;
  if (file.stylus.empty()) throw StrokesError(where + ": 'stylus' must name a stylus");
  Stroke stroke;
  stroke.stylus = file.stylus;
  if (file.samples_line > 0) {
    if (!file.keys.empty() || file.anchored)
      throw StrokesError(where + ": 'samples' cannot be combined with 'keys' or 'anchor'");
    stroke.samples = parseSamples(file.samples, name, file.samples_line);
    return stroke;
  }
  if (file.keys.empty()) throw StrokesError(where + ": 'keys' must contain at least one key");
  if (file.anchored) {
    if (file.anchor.from_m == file.anchor.towards_m)
      throw StrokesError(where + ": anchor: 'from_m' and 'towards_m' must differ");
    stroke.anchor = Anchor{file.anchor.from_m, file.anchor.towards_m};
  }
  for (size_t k = 0; k < file.keys.size(); ++k) {
    const FileKey& key = file.keys[k];
    if (k > 0 && key.t_s <= file.keys[k - 1].t_s) {
      throw StrokesError(lineOf(name, key.line) + item + ": keys[" + std::to_string(k) +
                         "]: 't_s' must be greater than that of the key before, " + numberText(file.keys[k - 1].t_s) +
                         " s; found " + numberText(key.t_s));
    }
    if (key.has_at && (key.has_position || file.anchored || key.at.part.empty()))
      throw StrokesError(lineOf(name, key.line) + item + ": keys[" + std::to_string(k) +
                         "]: 'at' needs 'part', and replaces 'position_m' and the stroke's 'anchor'");
    stroke.keys.push_back(
        {key.t_s, {key.position_m, rotationFromDegrees(key.rotation_deg)}, key.button1, key.button2, key.jaw_rad});
    if (key.has_at) stroke.keys.back().at = key.at;
  }
  return stroke;
}

/// Returns the sample of exactly this tick.
StylusSample sampleOf(const Stroke& stroke, uint64_t tick) {
  const auto found = std::lower_bound(stroke.samples.begin(), stroke.samples.end(), tick,
                                      [](const Stroke::Sample& sample, uint64_t t) { return sample.tick < t; });
  if (found == stroke.samples.end() || found->tick != tick) return {};
  return {true, found->pose, found->button1, found->button2, found->jaw_rad};
}

StylusSample sampleAt(const Stroke& stroke, double time_s) {
  const auto after = std::upper_bound(stroke.keys.begin(), stroke.keys.end(), time_s,
                                      [](double t, const Stroke::Key& key) { return t < key.time_s; });
  if (after == stroke.keys.begin()) return {};
  const Stroke::Key& last = *(after - 1);
  Pose pose = last.pose;
  double jaw_rad = last.jaw_rad;
  if (after != stroke.keys.end()) {
    const double share = (time_s - last.time_s) / (after->time_s - last.time_s);
    pose = interpolate(last.pose, after->pose, share);
    if (jaw_rad >= 0 && after->jaw_rad >= 0) jaw_rad += share * (after->jaw_rad - jaw_rad);
  }
  return {true, pose, last.button1, last.button2, static_cast<float>(jaw_rad)};
}

}  // namespace

double Strokes::duration_s() const {
  double end = tick_hz > 0 ? static_cast<double>(ticks) / tick_hz : 0;
  for (const Stroke& stroke : strokes)
    if (!stroke.keys.empty()) end = std::max(end, stroke.keys.back().time_s);
  return end;
}

bool Strokes::inputReset(uint64_t tick) const {
  return std::binary_search(input_reset.begin(), input_reset.end(), tick);
}

void Strokes::requireTickRate(double scene_tick_hz) const {
  if (tick_hz == 0 || tick_hz == scene_tick_hz) return;
  throw StrokesError(file + ": 'tick_hz' is " + numberText(tick_hz) + " Hz, but 'solver.tick_hz' of the scene is " +
                     numberText(scene_tick_hz) + " Hz; recorded ticks can only be replayed at their own rate");
}

bool Strokes::anchored() const {
  const auto relative = [](const Stroke::Key& key) { return key.at.has_value(); };
  return std::any_of(strokes.begin(), strokes.end(), [&](const Stroke& stroke) {
    return stroke.anchor.has_value() || std::any_of(stroke.keys.begin(), stroke.keys.end(), relative);
  });
}

StylusSamples Strokes::at(double time_s, const std::vector<StylusConfig>& configs) const {
  StylusSamples samples;
  const auto tick = static_cast<uint64_t>(std::max(0.0, std::floor(time_s * tick_hz + kTickRounding)));
  for (const Stroke& stroke : strokes) {
    for (size_t i = 0; i < configs.size(); ++i) {
      if (configs[i].name != stroke.stylus) continue;
      const StylusSample sample = stroke.keys.empty() ? sampleOf(stroke, tick) : sampleAt(stroke, time_s);
      if (sample.valid) samples[i] = sample;
    }
  }
  return samples;
}

namespace {

/// Checks the keys that samples need.
void checkTicks(const FileStrokes& file, Strokes& out) {
  out.tick_hz = file.tick_hz;
  out.ticks = static_cast<uint64_t>(file.ticks);
  out.recorded = file.recorded;
  for (const double tick : file.input_reset) out.input_reset.push_back(static_cast<uint64_t>(tick));
  const bool recorded = std::any_of(file.strokes.begin(), file.strokes.end(),
                                    [](const FileStroke& stroke) { return stroke.samples_line > 0; });
  if (recorded != (out.tick_hz > 0) || recorded != (out.ticks > 0))
    throw StrokesError(out.file + ": 'samples' need 'tick_hz' and 'ticks', and these need 'samples'");
  if (!std::is_sorted(out.input_reset.begin(), out.input_reset.end()))
    throw StrokesError(out.file + ": 'input_reset' must be increasing ticks");
  for (const Stroke& stroke : out.strokes) {
    if (!stroke.samples.empty() && stroke.samples.back().tick > out.ticks)
      throw StrokesError(out.file + ": stylus '" + stroke.stylus + "' has a sample of tick " +
                         std::to_string(stroke.samples.back().tick) + ", but 'ticks' is " + std::to_string(out.ticks));
  }
}

}  // namespace

Strokes parseStrokes(const std::string& yaml, const std::string& name) {
  const YamlSource source{name, {}};
  FileStrokes file;
  try {
    YamlReader::readMap(YAML::Load(yaml), "", source, file);
  } catch (const YAML::Exception& e) {
    throw StrokesError(yamlFault(name, e, yaml));
  } catch (const SceneError& e) {
    throw StrokesError(e.what());
  }
  Strokes out;
  out.file = name;
  for (size_t i = 0; i < file.strokes.size(); ++i) out.strokes.push_back(checked(file.strokes[i], i, name));
  checkTicks(file, out);
  for (const FileMark& mark : file.marks) {
    if (mark.name.empty() || mark.name.find('/') != std::string::npos) {
      throw StrokesError(lineOf(name, mark.line) + ": 'marks' need a 'name' without '/'");
    }
    out.marks.push_back({mark.name, mark.t_s});
  }
  if (out.strokes.empty()) throw StrokesError(name + ": 'strokes' must contain at least one stroke");
  return out;
}

Strokes loadStrokes(const std::string& path) {
  try {
    const std::string text = textOf(path, "strokes");
    return memoryFor<StrokesError>(path, [&] { return parseStrokes(text, path); });
  } catch (const SceneError& error) {
    throw StrokesError(error.what());
  }
}

}  // namespace viscera
