// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/unfinished_program.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <utility>

#include "gpu/reflection.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

namespace {

/// List of the programs of this thread until they are finished.
thread_local std::set<UnfinishedProgram*>* listed = nullptr;

/// Finishes a stage. @throws GpuError  it does not compile
void finishStage(const ShaderStage& stage) {
  GLint ok = 0, length = 0;
  glGetShaderiv(stage.id, GL_COMPILE_STATUS, &ok);
  if (ok) return;
  glGetShaderiv(stage.id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<size_t>(length) + 1, '\0');
  glGetShaderInfoLog(stage.id, length, nullptr, log.data());
  throw GpuError("shader '" + stage.name + "' does not compile (files: " + filesLegend(stage.files) + "):\n" +
                 log.c_str());
}

}  // namespace

UnfinishedProgram::UnfinishedProgram() {
  if (listed) listed->insert(this);
}

UnfinishedProgram::~UnfinishedProgram() {
  if (listed) listed->erase(this);
  for (const ShaderStage& stage : stages) glDeleteShader(stage.id);
  if (id) glDeleteProgram(id);
}

void UnfinishedProgram::add(GLenum kind, const std::string& shader, const std::vector<std::string>& defines) {
  ShaderStage stage{kind, 0, shader, {}, {}};
  stage.source = expandedShader(shader, defines, stage.files);
  for (std::string& uniform : declaredUniforms(stage.source)) uniforms.push_back(std::move(uniform));
  stages.push_back(std::move(stage));
}

void UnfinishedProgram::start() {
  if (id) return;
  id = glCreateProgram();
  for (ShaderStage& stage : stages) {
    const char* text = stage.source.c_str();
    stage.id = glCreateShader(stage.kind);
    glShaderSource(stage.id, 1, &text, nullptr);
    glCompileShader(stage.id);
    glAttachShader(id, stage.id);
    stage.source.clear();
  }
  glLinkProgram(id);
}

void UnfinishedProgram::require() const {
  for (const ShaderStage& stage : stages) finishStage(stage);
  GLint ok = 0, length = 0;
  glGetProgramiv(id, GL_LINK_STATUS, &ok);
  if (ok) return;
  glGetProgramiv(id, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<size_t>(length) + 1, '\0');
  glGetProgramInfoLog(id, length, nullptr, log.data());
  throw GpuError("program '" + name + "' does not link:\n" + log.c_str());
}

void UnfinishedProgram::keep(UniformName uniform, uint32_t type, const void* value, size_t components, size_t count) {
  if (std::find(uniforms.begin(), uniforms.end(), uniform.text()) == uniforms.end())
    throw GpuError("program '" + name + "' has no uniform '" + uniform.text() + "'");
  const auto same = [uniform](const PendingValue& it) { return it.name.key() == uniform.key(); };
  auto kept = std::find_if(values.begin(), values.end(), same);
  if (kept == values.end()) kept = values.insert(values.end(), PendingValue{uniform, type, components, 0, {}});
  if (kept->type != type) throw GpuError("program '" + name + "': uniform '" + uniform.text() + "' has another type");
  kept->count = std::max(kept->count, count);
  kept->words.resize(kept->count * components);
  std::memcpy(kept->words.data(), value, count * components * sizeof(uint32_t));
}

MadePrograms::MadePrograms() : before_(std::exchange(listed, &made_)) {}

MadePrograms::~MadePrograms() {
  listed = before_;
}

void MadePrograms::require() const {
  for (const UnfinishedProgram* program : made_) {
    if (program->id) program->require();
  }
}

}  // namespace viscera::gpu
