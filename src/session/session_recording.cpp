// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_recording.h"

#include <filesystem>

#include "model/scene/scene_yaml.h"
#include "session/state_file.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"
#include "viscera/tools/stylus.h"

namespace viscera {

namespace {

constexpr char kProgram[] = "viscera, states of version ";

Archive archiveOf(std::vector<char> bytes) {
  Archive archive({{"chunk", std::move(bytes)}});
  archive.section("chunk");
  return archive;
}

Archive emptyArchive() {
  Archive archive;
  archive.section("chunk");
  return archive;
}

}  // namespace

void RecordedScene::persist(Archive& archive) {
  for (std::string* text : {&version, &folder, &yaml, &stepped_by}) archive.list(*text);
  archive.value(tick_hz);
  archive.value(styluses);
  archive.value(sample_bytes);
}

RecordedScene RecordedScene::of(const Scene& scene, const std::string& stepped_by) {
  return {kProgram + std::to_string(kStateVersion),
          std::filesystem::absolute(scene.folder.empty() ? "." : scene.folder).string(),
          resolvedYaml(scene),
          stepped_by,
          scene.solver.tick_hz,
          static_cast<uint32_t>(scene.styluses.size()),
          sizeof(StylusSample)};
}

std::vector<char> RecordedScene::bytes() {
  Archive archive = emptyArchive();
  persist(archive);
  return std::move(archive.take()[0].bytes);
}

RecordedScene RecordedScene::from(std::vector<char> bytes) {
  Archive archive = archiveOf(std::move(bytes));
  RecordedScene out;
  out.persist(archive);
  archive.end();
  const std::string here = kProgram + std::to_string(kStateVersion);
  if (out.version != here || out.sample_bytes != sizeof(StylusSample))
    throw Error("was recorded by another version: '" + out.version + "', stylus samples of " +
                std::to_string(out.sample_bytes) + " bytes; this program is '" + here + "', " +
                std::to_string(sizeof(StylusSample)) + " bytes");
  if (!(out.tick_hz > 0)) throw Error("contains a scene without ticks");
  return out;
}

Scene RecordedScene::scene(const std::string& name, const Overrides& overrides) const {
  Scene out = parseScene(yaml, name, overrides);
  out.folder = folder;
  out.file = name;
  return out;
}

void RecordedState::persist(Archive& archive) {
  uint8_t leap = leaps ? 1 : 0;
  archive.value(leap);
  leaps = leap != 0;
  archive.value(tick);
  archive.value(hash);
  uint64_t count = sections.size();
  archive.value(count);
  for (uint64_t s = 0; s < count; ++s) {
    if (archive.reads()) sections.emplace_back();
    archive.list(sections[s].name);
    archive.list(sections[s].bytes);
  }
}

std::vector<char> RecordedState::bytes() {
  constexpr size_t kHeads = 200;  // bytes for lengths and the name of a section, in addition to the state
  size_t size = kHeads;
  for (const Archive::Section& section : sections) size += kHeads + section.bytes.size();
  Archive archive = emptyArchive();
  archive.reserve(size);
  persist(archive);
  return std::move(archive.take()[0].bytes);
}

RecordedState RecordedState::from(std::vector<char> bytes) {
  Archive archive = archiveOf(std::move(bytes));
  RecordedState out;
  out.persist(archive);
  archive.end();
  return out;
}

}  // namespace viscera
