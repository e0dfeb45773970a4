// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/yaml/renamed_keys.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <set>

namespace viscera {

namespace {

struct Renamed {
  const char* path;  ///< old names, without indices
  const char* name;  ///< new name of its last key
};

/// Keys of scene and strokes files that had another name before 1.0.
constexpr Renamed kRenamed[] = {
    {"threads", "sutures"},
    {"threads.drag_per_s", "mass_damping_per_s"},
    {"sutures.drag_per_s", "mass_damping_per_s"},
    {"solver.governor", "stability_monitor"},
    {"bodies.material.drag_per_s", "mass_damping_per_s"},
    {"bodies.material.dashpot_ratio", "stiffness_damping_ratio"},
    {"bodies.mottling", "color_variation"},
    {"bodies.wetness", "specular_wetness"},
    {"bodies.wall_grain", "cut_wall_texture"},
    {"hands_anew", "input_reset"},
};

struct Edit {
  size_t at, length;
  std::string name;
};

/// Finds the keys of a text that have another name now.
class Search {
 public:
  explicit Search(const std::string& text) : text_(text) {}

  /// @param path  of the node, with the names in the file
  void visit(const YAML::Node& node, const std::string& path) {
    // An alias is the same place of the text as its anchor, and may contain itself.
    if (!node.IsDefined() || node.IsScalar() || !visited_.insert(node.Mark().pos).second) return;
    if (node.IsSequence()) {
      for (size_t i = 0; i < node.size(); ++i) visit(node[i], path + '[' + std::to_string(i) + ']');
    } else if (node.IsMap()) {
      for (const auto& entry : node) {
        if (!entry.first.IsScalar()) continue;
        const std::string& key = entry.first.Scalar();
        // Plans of sweeps have whole paths as keys.
        const std::string whole = path.empty() || key.find('.') != std::string::npos ? key : path + '.' + key;
        const std::string renamed = withNewNames(whole);
        if (lastKeys(renamed, key) != key) record(entry.first, whole, renamed);
        visit(entry.second, whole);
      }
    }
  }
  UpgradedText upgraded() {
    std::sort(edits_.begin(), edits_.end(), [](const Edit& a, const Edit& b) { return a.at > b.at; });
    UpgradedText out{text_, notes_};
    for (const Edit& edit : edits_) out.text.replace(edit.at, edit.length, edit.name);
    return out;
  }

 private:
  /// Returns as many keys from the end of a path as `key` has.
  static std::string lastKeys(const std::string& path, const std::string& key) {
    size_t at = path.size();
    for (auto keys = 1 + std::count(key.begin(), key.end(), '.'); keys > 0 && at != std::string::npos; --keys)
      at = at == 0 ? std::string::npos : path.rfind('.', at - 1);
    return at == std::string::npos ? path : path.substr(at + 1);
  }
  void record(const YAML::Node& key, const std::string& old_path, const std::string& new_path) {
    const std::string& name = key.Scalar();
    const size_t at =
        text_.find(name, static_cast<size_t>(key.Mark().pos));  // behind a quotation mark, if there is one
    if (at == std::string::npos) return;
    edits_.push_back({at, name.size(), lastKeys(new_path, name)});
    notes_.push_back(old_path + " -> " + new_path);
  }

  const std::string& text_;
  std::set<int> visited_;  ///< positions of the maps and lists that were searched
  std::vector<Edit> edits_;
  std::vector<std::string> notes_;
};

}  // namespace

std::string withNewNames(const std::string& path) {
  std::string old_names, out;
  for (size_t at = 0; at < path.size();) {
    const size_t end = std::min(path.find('.', at), path.size());
    const std::string step = path.substr(at, end - at), key = step.substr(0, step.find('['));
    old_names += (at > 0 ? "." : "") + key;
    const auto* found = std::find_if(std::begin(kRenamed), std::end(kRenamed),
                                     [&](const Renamed& one) { return old_names == one.path; });
    out += (at > 0 ? "." : "") + (found == std::end(kRenamed) ? key : found->name) + step.substr(key.size());
    at = end + 1;
  }
  return out;
}

UpgradedText upgradedText(const std::string& text) {
  Search search(text);
  for (const YAML::Node& document : YAML::LoadAll(text)) search.visit(document, "");
  return search.upgraded();
}

}  // namespace viscera
