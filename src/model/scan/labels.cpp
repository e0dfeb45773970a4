// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/labels.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "math/number_text.h"
#include "model/scan/text_header.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr size_t kMostLabels = 255;
constexpr float kLargestValue = 1 << 24;  ///< above it, float32 does not resolve integers
constexpr size_t kMostListed = 20;        ///< labels listed in an error
constexpr char kGreyScan[] = "; a grey scan needs viscera import --window LOW,HIGH";

using Key = std::pair<int, int64_t>;  ///< layer, value

/// Returns the file of names next to a scan, its name with another ending; empty: there is none.
std::string namesBeside(const std::string& path) {
  std::string stem = path;
  for (const char* end : {".gz", ".nii", ".nrrd", ".nhdr", ".seg", ".mhd", ".mha"}) {
    const size_t length = std::string(end).size();
    if (stem.size() > length && lower(stem.substr(stem.size() - length)) == end) stem.resize(stem.size() - length);
  }
  for (const char* end : {".label", ".yaml", ".txt"}) {
    std::error_code error;
    if (std::filesystem::is_regular_file(stem + end, error)) return stem + end;
  }
  return "";
}

/// Returns the file's own segments, with the names that a table gives to values.
std::vector<Segment> namedSegments(const std::string& path, const LabelOptions& options, const ScanSource& source) {
  std::vector<Segment> segments = source.segments();
  const bool given = !options.names_file.empty();
  const std::string table = given ? options.names_file : segments.empty() ? namesBeside(path) : "";
  if (table.empty()) return segments;
  std::vector<LabelName> names;
  try {
    names = readLabelNames(table);
  } catch (const SceneError& error) {
    if (given) throw SceneError(std::string("names of labels: ") + error.what());
    if (options.notes)
      options.notes->push_back(std::string("the file next to the scan has no names of labels: ") + error.what());
  }
  for (const LabelName& name : names) {
    bool known = false;
    for (Segment& segment : segments)
      if (segment.label.value == name.value) {
        segment.label.name = name.name;
        if (name.color) segment.label.color = name.color;
        known = true;
      }
    if (!known) segments.push_back({0, name});
  }
  return segments;
}

std::string listed(const std::vector<Segment>& segments) {
  std::string text;
  for (size_t n = 0; n < segments.size() && n < kMostListed; ++n) {
    text += (n ? ", " : "") + std::to_string(segments[n].label.value);
    if (!segments[n].label.name.empty()) text += " (" + segments[n].label.name + ")";
  }
  if (segments.size() > kMostListed) text += " and " + std::to_string(segments.size() - kMostListed) + " more";
  return text.empty() ? "none" : text;
}

constexpr size_t kMostNumbers = 65536;  ///< distinct values that are kept for errors

/// Returns the nearest integer; none: it is too large, or no number.
std::optional<int64_t> wholeOf(float value) {
  if (!(std::abs(value) <= kLargestValue)) return {};
  return std::llround(value);
}

/// Returns the values in a scan, for an error that was found before it was read.
std::map<Key, int64_t> valuesOf(const std::string& path, const LabelOptions& options) {
  std::map<Key, int64_t> met;
  try {
    ScanOptions quiet = options;
    quiet.progress = nullptr;
    quiet.notes = nullptr;
    const auto source = openScan(path, quiet);
    std::vector<float> values;
    for (int k = 0; k < source->frame().size.z(); ++k) {
      source->next(values);
      for (const float value : values) {
        const auto whole = wholeOf(value);
        if (whole && *whole != 0 && met.size() < kMostNumbers) ++met[{0, *whole}];
      }
    }
  } catch (const SceneError&) {  // the original error matters more
    met.clear();
  }
  return met;
}

/// Numbers of labels. Those of requested labels are known in advance; all others get numbers in order of appearance.
class Numbering {
 public:
  Numbering(const std::string& path, const LabelOptions& options, std::vector<Segment> segments)
      : path_(path), all_(options.labels.empty()), segments_(std::move(segments)), options_(options) {
    for (const std::string& asked : options.labels) add(trimmed(asked));
  }

  uint8_t of(int layer, float value) {
    if (value == last_value_ && layer == last_layer_) return last_;
    last_value_ = value;
    last_layer_ = layer;
    return last_ = find(layer, value);
  }
  bool all() const { return all_; }
  size_t count() const { return labels_.size(); }
  const Segment& label(size_t number) const { return labels_[number - 1]; }
  const std::map<Key, int64_t>& met() const { return met_; }
  /// Checks that all requested labels occur.
  /// @throws SceneError  a value that is no label, or no voxel of a requested label
  void requireMet() const {
    if (farthest_ > kNearlyWhole) {
      TextOut out;
      out << path_ << ": is not a label map: a voxel has the value " << farthest_value_;
      if (std::isfinite(farthest_)) out << ", " << farthest_ << " from a whole number";
      out << "; accepted: whole numbers, at most 2^24, within " << kNearlyWhole << kGreyScan;
      throw SceneError(out.str());
    }
    for (const Segment& label : labels_)
      if (!met_.count({label.layer, label.label.value}))
        refuse("no voxel has label " + std::to_string(label.label.value));
    if (labels_.empty()) refuse("no voxel has a label");
  }
  /// Returns a note on changes to values; empty: none.
  std::string note() const {
    if (farthest_ == 0) return "";
    TextOut out;
    out << path_ << ": values were rounded to labels, by up to " << farthest_;
    return out.str();
  }
  /// Sorts the numbers of all labels by value and layer. @returns [old number] new number
  std::vector<uint8_t> sorted() {
    std::vector<size_t> order(labels_.size());
    for (size_t n = 0; n < order.size(); ++n) order[n] = n;
    const auto key = [&](size_t n) { return Key(labels_[n].layer, labels_[n].label.value); };
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return key(a) < key(b); });
    std::vector<uint8_t> number(labels_.size() + 1, 0);
    std::vector<Segment> sorted;
    for (const size_t n : order) {
      sorted.push_back(labels_[n]);
      number[n + 1] = static_cast<uint8_t>(sorted.size());
    }
    labels_ = sorted;
    return number;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    std::vector<Segment> known = segments_;
    for (const auto& [key, count] : met_.empty() ? valuesOf(path_, options_) : met_) {
      const auto same = [&](const Segment& s) { return s.layer == key.first && s.label.value == key.second; };
      if (std::none_of(known.begin(), known.end(), same)) known.push_back({key.first, {key.second, ""}});
    }
    throw SceneError(path_ + ": " + what + "; accepted: " + listed(known));
  }

  void add(const std::string& asked) {
    const size_t before = labels_.size();
    for (const Segment& segment : segments_)
      if (segment.label.name == asked) take(segment);
    int64_t value = 0;
    if (labels_.size() == before && parseInteger(asked, value)) {
      for (const Segment& segment : segments_)
        if (segment.label.value == value) take(segment);
      if (labels_.size() == before) take({0, {value, ""}});
    }
    if (labels_.size() == before) refuse("there is no label '" + asked + "'");
    if (labels_.size() > before + 1) refuse("'" + asked + "' is the name or number of several labels");
  }

  void take(const Segment& segment) {
    if (segment.label.value == 0) refuse("label 0 is the background");
    if (!numbers_.emplace(Key(segment.layer, segment.label.value), labels_.size() + 1).second)
      refuse("label " + std::to_string(segment.label.value) + " is requested twice");
    labels_.push_back(segment);
    if (labels_.size() > kMostLabels)
      throw SceneError(path_ + ": has more than 255 labels; choose at most 255 of them" + kGreyScan);
  }

  uint8_t find(int layer, float value) {
    if (value == 0) return 0;
    const auto whole = wholeOf(value);
    const float off = whole ? std::abs(value - static_cast<float>(*whole)) : INFINITY;
    if (off > farthest_) {
      farthest_ = off;
      farthest_value_ = value;
    }
    if (off > kNearlyWhole || *whole == 0) return 0;
    const Key key(layer, *whole);
    if (met_.size() < kMostNumbers) ++met_[key];
    const auto known = numbers_.find(key);
    if (known != numbers_.end()) return static_cast<uint8_t>(known->second);
    if (!all_) return 0;
    Segment segment{layer, {key.second, ""}};
    for (const Segment& named : segments_)
      if (named.layer == layer && named.label.value == key.second) segment = named;
    take(segment);
    return static_cast<uint8_t>(labels_.size());
  }

  const std::string path_;
  const bool all_;
  std::vector<Segment> segments_;
  const LabelOptions& options_;
  std::vector<Segment> labels_;  ///< [number - 1]
  std::map<Key, size_t> numbers_;
  std::map<Key, int64_t> met_;
  float last_value_ = 0;
  int last_layer_ = 0;
  uint8_t last_ = 0;
  float farthest_ = 0, farthest_value_ = 0;  ///< largest distance from an integer, and its value
};

/// Labels the voxels of one layer. @returns number of voxels that already had a label
size_t readLayer(ScanSource& source, int layer, Numbering& numbering, std::vector<uint8_t>& labels) {
  std::vector<float> values;
  size_t overlaps = 0, voxel = 0;
  for (int k = 0; k < source.frame().size.z(); ++k) {
    source.next(values);
    for (const float value : values) {
      uint8_t& label = labels[voxel++];
      const uint8_t here = numbering.of(layer, value);
      if (here == 0) continue;
      overlaps += label != 0;
      if (label == 0 || here < label) label = here;
    }
  }
  return overlaps;
}

}  // namespace

LabelVolume readLabels(const std::string& path, const LabelOptions& options) {
  auto source = openScan(path, options);
  Numbering numbering(path, options, namedSegments(path, options, *source));
  LabelVolume volume;
  volume.frame = source->frame();
  const int layers = source->layers();
  if (layers > 1 && options.volume >= 0)
    throw SceneError(path + ": labels are read from all its layers; remove the key volume");
  size_t overlaps = 0;
  volume.labels.assign(volume.frame.voxels(), 0);
  for (int layer = 0; layer < layers; ++layer) {
    if (layer > 0) {
      ScanOptions of_layer = options;
      of_layer.volume = layer;
      source = openScan(path, of_layer);
    }
    overlaps += readLayer(*source, layer, numbering, volume.labels);
  }
  numbering.requireMet();
  if (options.notes && !numbering.note().empty()) options.notes->push_back(numbering.note());
  if (numbering.all()) {
    const std::vector<uint8_t> number = numbering.sorted();
    for (uint8_t& label : volume.labels) label = number[label];
  }
  volume.names.push_back({0, ""});
  for (size_t n = 1; n <= numbering.count(); ++n) volume.names.push_back(numbering.label(n).label);
  if (overlaps > 0 && options.notes)
    options.notes->push_back(path + ": " + std::to_string(overlaps) +
                             " voxels have several labels; they get the first requested one");
  return volume;
}

}  // namespace viscera
