// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/gltf_tree.h"

namespace viscera {
namespace {

/// Largest nesting of arrays and objects. glTF itself has 7; libraries recurse once per level.
constexpr size_t kDeepestJson = 1000;
constexpr size_t kDeepestKept = 7;  ///< meshes[].primitives[].targets[].POSITION

/// Returns an item of a list that grows as needed.
template <class Item>
Item& itemAt(std::vector<Item>& list, size_t index) {
  if (list.size() <= index) list.resize(index + 1);
  return list[index];
}

}  // namespace

/// Returns the path of the next value, as in "nodes.*.children.*".
std::string GltfTreeReader::path() const {
  std::string out;
  for (const Level& level : levels_) out += (out.empty() ? "" : ".") + (level.is_array ? "*" : level.key);
  return out;
}

/// Handles the beginning of a value.
bool GltfTreeReader::value() {
  if (!levels_.empty() && levels_.back().is_array) ++levels_.back().index;
  return true;
}

bool GltfTreeReader::open(bool is_array) {
  value();
  if (levels_.size() == kDeepestJson) {
    fault = "its JSON is nested more than " + std::to_string(kDeepestJson) + " levels deep";
    return false;
  }
  // An empty node is a node too.
  if (levels_.size() == 2 && levels_[0].key == "nodes" && levels_[1].is_array) itemAt(tree_.nodes, at(1));
  levels_.push_back({is_array, 0, ""});
  return true;
}

bool GltfTreeReader::close() {
  levels_.pop_back();
  return true;
}

bool GltfTreeReader::key(string_t& name) {
  constexpr size_t kLongestKept = 64;  // longer keys are not glTF's own
  levels_.back().key = name.substr(0, kLongestKept);
  return true;
}

bool GltfTreeReader::string(string_t& text) {
  value();
  constexpr size_t kMostRequired = 64, kLongestName = 64;
  if (levels_.size() != 2) return true;
  const std::string where = path();
  if (where == "asset.version" && tree_.version.empty()) tree_.version = text;
  if (where == "extensionsRequired.*" && tree_.required.size() < kMostRequired)
    tree_.required.push_back(text.substr(0, kLongestName));
  return true;
}

bool GltfTreeReader::number_unsigned(number_unsigned_t number) {
  value();
  if (levels_.size() >= 3 && levels_.size() <= kDeepestKept) keep(number);
  return true;
}

bool GltfTreeReader::parse_error(std::size_t byte, const std::string&, const nlohmann::json::exception&) {
  fault = "its JSON is invalid at byte " + std::to_string(byte);
  return false;
}

void GltfTreeReader::keep(uint64_t number) {
  const std::string where = path();
  if (where == "nodes.*.children.*") itemAt(tree_.nodes, at(1)).children.push_back(number);
  if (where == "nodes.*.mesh") itemAt(tree_.nodes, at(1)).meshes.push_back(number);
  if (where == "scenes.*.nodes.*") itemAt(tree_.scenes, at(1)).push_back(number);
  if (where == "accessors.*.count") itemAt(tree_.accessor_counts, at(1)) = static_cast<double>(number);
  if (where == "accessors.*.componentType") itemAt(tree_.component_types, at(1)) = number;
  if (where == "buffers.*.byteLength") itemAt(tree_.buffer_bytes, at(1)) = static_cast<double>(number);
  if (where.rfind("meshes.*.primitives.*.", 0) == 0) keepOfMesh(number, where);
}

void GltfTreeReader::keepOfMesh(uint64_t number, const std::string& where) {
  GltfTree::Primitive& primitive = itemAt(itemAt(tree_.meshes, at(1)), at(3));
  const std::string inside = where.substr(std::string("meshes.*.primitives.*.").size());
  if (inside == "mode") primitive.mode = number;
  for (const char* real : {"attributes.POSITION", "attributes.NORMAL", "attributes.TANGENT", "attributes.TEXCOORD_"})
    if (inside.rfind(real, 0) == 0) primitive.reals.push_back(number);
  if (inside == "indices") primitive.indices = {number};
  if (inside == "indices" || inside.rfind("attributes.", 0) == 0) primitive.accessors.push_back(number);
  if (inside.rfind("targets.*.", 0) == 0) primitive.of_targets.push_back(number);
}

}  // namespace viscera
