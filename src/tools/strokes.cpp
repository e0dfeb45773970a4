// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/strokes.h"

#include <algorithm>
#include <sstream>

#include "math/memory_for.h"
#include "model/scene/yaml_reader.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr double kLongestStrokeS = 3600;
constexpr double kMostKeys = 1e6;

/// A key as it stands in the file; what is left out is zero or released.
struct FileKey {
  int line = 0;
  double t_s = 0;
  Vector3d position_m = Vector3d::Zero();
  Vector3d rotation_deg = Vector3d::Zero();
  bool button1 = false, button2 = false;
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
};
struct FileMark {
  int line = 0;
  std::string name;
  double t_s = 0;
};
struct FileStrokes {
  std::vector<FileStroke> strokes;
  std::vector<FileMark> marks;
};

void visitFields(YamlReader& v, FileKey& c) {
  c.line = v.line();
  v.number("t_s", c.t_s, {0, kLongestStrokeS}, "s", "time from the start");
  v.vector("position_m", c.position_m, {-100, 100}, "m", "stylus tip, tissue frame");
  v.vector("rotation_deg", c.rotation_deg, {-360, 360}, "deg", "turns about the fixed x, then y, then z axis");
  v.boolean("button1", c.button1, "");
  v.boolean("button2", c.button2, "");
}

void visitFields(YamlReader& v, FileAnchor& c) {
  v.vector("from_m", c.from_m, {-100, 100}, "m", "start of the ray, tissue frame");
  v.vector("towards_m", c.towards_m, {-100, 100}, "m", "a point that the ray goes through");
}

void visitFields(YamlReader& v, FileStroke& c) {
  c.line = v.line();
  c.anchored = v.has("anchor");
  v.group("anchor", c.anchor, "keys are relative to where this ray meets the skin");
  v.text("stylus", c.stylus, "name of a stylus of the scene");
  v.list("keys", c.keys, kMostKeys, "");
}

void visitFields(YamlReader& v, FileMark& c) {
  c.line = v.line();
  v.text("name", c.name, "of the picture");
  v.number("t_s", c.t_s, {0, kLongestStrokeS}, "s", "time from the start");
}

void visitFields(YamlReader& v, FileStrokes& c) {
  v.list("strokes", c.strokes, 16, "recorded strokes");
  v.list("marks", c.marks, 1000, "moments worth a picture");
}

std::string lineOf(const std::string& name, int line) {
  return name + ":" + std::to_string(line);
}

Stroke checked(const FileStroke& file, size_t index, const std::string& name) {
  const std::string item = ": strokes[" + std::to_string(index) + "]", where = lineOf(name, file.line) + item;
  if (file.stylus.empty()) throw StrokesError(where + ": 'stylus' must name a stylus");
  if (file.keys.empty()) throw StrokesError(where + ": 'keys' must hold at least one key");
  Stroke stroke{file.stylus, {}, {}};
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
    stroke.keys.push_back({key.t_s, {key.position_m, rotationFromDegrees(key.rotation_deg)}, key.button1, key.button2});
  }
  return stroke;
}

StylusSample sampleAt(const Stroke& stroke, double time_s) {
  const auto after = std::upper_bound(stroke.keys.begin(), stroke.keys.end(), time_s,
                                      [](double t, const Stroke::Key& key) { return t < key.time_s; });
  if (after == stroke.keys.begin()) return {};
  const Stroke::Key& last = *(after - 1);
  Pose pose = last.pose;
  if (after != stroke.keys.end()) {
    pose = interpolate(last.pose, after->pose, (time_s - last.time_s) / (after->time_s - last.time_s));
  }
  return {true, pose, last.button1, last.button2};
}

}  // namespace

double Strokes::duration_s() const {
  double end = 0;
  for (const Stroke& stroke : strokes) end = std::max(end, stroke.keys.back().time_s);
  return end;
}

bool Strokes::anchored() const {
  return std::any_of(strokes.begin(), strokes.end(), [](const Stroke& s) { return s.anchor.has_value(); });
}

StylusSamples Strokes::at(double time_s, const std::vector<StylusConfig>& configs) const {
  StylusSamples samples;
  for (const Stroke& stroke : strokes) {
    for (size_t i = 0; i < configs.size(); ++i) {
      if (configs[i].name != stroke.stylus) continue;
      const StylusSample sample = sampleAt(stroke, time_s);
      if (sample.valid) samples[i] = sample;
    }
  }
  return samples;
}

Strokes parseStrokes(const std::string& yaml, const std::string& name) {
  const YamlSource source{name, {}};
  FileStrokes file;
  try {
    YamlReader::readMap(YAML::Load(yaml), "", source, file);
  } catch (const YAML::Exception& e) {
    throw StrokesError(yamlFault(name, e));
  } catch (const SceneError& e) {
    throw StrokesError(e.what());
  }
  Strokes out;
  out.file = name;
  for (size_t i = 0; i < file.strokes.size(); ++i) out.strokes.push_back(checked(file.strokes[i], i, name));
  for (const FileMark& mark : file.marks) {
    if (mark.name.empty() || mark.name.find('/') != std::string::npos) {
      throw StrokesError(lineOf(name, mark.line) + ": 'marks' need a 'name' without '/'");
    }
    out.marks.push_back({mark.name, mark.t_s});
  }
  if (out.strokes.empty()) throw StrokesError(name + ": 'strokes' must hold at least one stroke");
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
