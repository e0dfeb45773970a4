// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/program.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <utility>

#include "gpu/buffer.h"
#include "gpu/gl.h"
#include "gpu/limits.h"
#include "gpu/reflection.h"
#include "gpu/storage_blocks.h"
#include "gpu/unfinished_program.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

/// Name of a program in messages.
struct ProgramLabel {
  explicit ProgramLabel(std::string of) : name(std::move(of)) {}
  std::string name;
  std::atomic<bool> has_run{false};  ///< its first dispatch was checked: a check after each would cost time
};

namespace {

uint32_t keyOf(const std::string& name) {
  uint32_t key = UniformName::kKeyStart;
  for (const char c : name) key = UniformName::keyStep(key, c);
  return key;
}

/// 32-bit words of one element of a uniform.
size_t wordsOf(GLenum type) {
  switch (type) {
    case GL_FLOAT_VEC2:
    case GL_UNSIGNED_INT_VEC2:
      return 2;
    case GL_FLOAT_VEC3:
      return 3;
    case GL_FLOAT_VEC4:
      return 4;
    case GL_FLOAT_MAT4:
      return 16;
    default:
      return 1;
  }
}

/// Programs to check at their first run; used only where tests ask for it.
std::atomic<bool> checks_dispatches{false};
std::mutex unchecked_mutex;
std::set<uint32_t> unchecked;

/// Label of the program that this thread uses. One per name, kept until the process ends.
thread_local ProgramLabel* in_use = nullptr;

ProgramLabel* labelOf(const std::string& name) {
  static std::mutex mutex;
  static std::map<std::string, ProgramLabel> labels;
  const std::lock_guard<std::mutex> lock(mutex);
  return &labels.try_emplace(name, name).first->second;
}

void refuseUnbound() {
  GLint program = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  {
    const std::lock_guard<std::mutex> lock(unchecked_mutex);
    if (unchecked.erase(static_cast<uint32_t>(program)) == 0) return;
  }
  std::string missing;
  for (const std::string& name : unboundNow(bindingsOf(static_cast<uint32_t>(program)))) missing += " " + name;
  if (!missing.empty())
    throw GpuError("kernel '" + (in_use ? in_use->name : "") + "' runs without a binding for:" + missing);
}

}  // namespace

std::vector<std::string> withLoads(const std::string& name, const std::vector<std::string>& defines) {
  const bool has_texels = std::find(defines.begin(), defines.end(), "TEXELS") != defines.end();
  if (!has_texels || !driverLimits().loads) return defines;
  std::vector<std::string> out = defines;
  out.push_back("LOADS");
  return declaredStorageBlocks(shaderSource(name, out)) <= driverLimits().storage_blocks ? out : defines;
}

std::string shaderSource(const std::string& name, const std::vector<std::string>& defines) {
  ShaderFiles files;
  return expandedShader(name, defines, files);
}

Program Program::compute(const std::string& name, const std::vector<std::string>& features) {
  const std::vector<std::string> defines = withLoads(name, features);
  requireStorageBlocks(driverLimits(), name, declaredStorageBlocks(shaderSource(name, defines)));
  Program out(name);
  out.unfinished_->add(GL_COMPUTE_SHADER, name, defines);
  out.begin();
  return out;
}

Program Program::graphics(const std::string& vertex, const std::string& fragment,
                          const std::vector<std::string>& defines) {
  Program out(vertex + " + " + fragment);
  out.unfinished_->add(GL_VERTEX_SHADER, vertex, defines);
  out.unfinished_->add(GL_FRAGMENT_SHADER, fragment, defines);
  out.begin();
  return out;
}

Program::Program(std::string name)
    : name_(std::move(name)), label_(labelOf(name_)), unfinished_(std::make_unique<UnfinishedProgram>()) {
  unfinished_->name = name_;
}

void Program::begin() {
  countObject();  // counted now, whenever it is made: later calls make none that was not planned
  for (size_t i = 0; i < unfinished_->stages.size(); ++i) countObject();
  if (driverLimits().compiles_ahead) unfinished_->start();
}

void Program::finish() const {
  if (!unfinished_) return;
  unfinished_->start();
  unfinished_->require();
  id_ = unfinished_->id;
  refuseSharedNumbers(bindingsOf(id_), name_);
  if (checks_dispatches) {
    const std::lock_guard<std::mutex> lock(unchecked_mutex);
    unchecked.insert(id_);
  }
  std::map<std::string, Uniform> by_name;
  for (const std::string& name : unfinished_->uniforms) by_name[name] = {keyOf(name), -1, 0, 0, 0};
  size_t words = 0;
  for (const ActiveUniform& active : activeUniforms(id_)) {
    const size_t own = wordsOf(active.type) * static_cast<size_t>(active.count);
    by_name[active.name] = {keyOf(active.name), active.location, active.type, words, own};
    words += own;
  }
  values_.assign(words, 0);
  for (const auto& [name, uniform] : by_name) {
    for (const Uniform& other : uniforms_) {
      if (other.key == uniform.key)
        throw GpuError("program '" + name_ + "': uniform '" + name + "' has the same hash as another one; rename it");
    }
    uniforms_.push_back(uniform);
  }
  unfinished_->id = 0;  // this object owns it now
  const std::vector<PendingValue> values = std::move(unfinished_->values);
  unfinished_.reset();
  for (const PendingValue& it : values) set(it.name, it.type, it.words.data(), it.components, it.count);
}

Program::Program() = default;

Program::~Program() {
  if (id_) glDeleteProgram(id_);
}

Program::Program(Program&& other) noexcept
    : id_(std::exchange(other.id_, 0)),
      name_(std::move(other.name_)),
      label_(std::exchange(other.label_, nullptr)),
      unfinished_(std::move(other.unfinished_)),
      uniforms_(std::move(other.uniforms_)),
      values_(std::move(other.values_)) {}

Program& Program::operator=(Program&& other) noexcept {
  std::swap(id_, other.id_);
  name_.swap(other.name_);
  std::swap(label_, other.label_);
  unfinished_.swap(other.unfinished_);
  uniforms_.swap(other.uniforms_);
  values_.swap(other.values_);
  return *this;
}

void Program::use() const {
  finish();
  glUseProgram(id_);
  in_use = label_;
}

namespace {

void checkFirstRun() {
  if (!in_use || in_use->has_run) return;
  in_use->has_run = true;
  checkErrors(("the first run of kernel '" + in_use->name + "'").c_str());
}

}  // namespace

void Program::dispatch(size_t invocations, uint32_t group_size) {
  if (invocations == 0) return;
  if (checks_dispatches) refuseUnbound();
  // One dimension has at least 65,535 groups; more are folded into the second, which kernels undo (globalIndex()).
  constexpr size_t kMaxGroups = 65535;
  const size_t groups = (invocations + group_size - 1) / group_size;
  const size_t rows = (groups + kMaxGroups - 1) / kMaxGroups;
  glDispatchCompute(static_cast<GLuint>(rows == 1 ? groups : kMaxGroups), static_cast<GLuint>(rows), 1);
  checkFirstRun();
}

void Program::dispatchIndirect(const RawBuffer& groups) {
  if (checks_dispatches) refuseUnbound();
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, groups.id());
  glDispatchComputeIndirect(0);
  checkFirstRun();
}

std::string lastKernel() {
  return in_use ? in_use->name : "none";
}

void Program::storageBarrier() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                  GL_COMMAND_BARRIER_BIT);
}

/// Stores a value if it is new; OpenGL's initial value, zero, counts as stored. @return null: nothing to do
const Program::Uniform* Program::changed(UniformName name, uint32_t type, const void* value, size_t words) const {
  finish();
  for (const Uniform& uniform : uniforms_) {
    if (uniform.key != name.key()) continue;
    if (uniform.location < 0) return nullptr;
    if (uniform.type != type) throw GpuError("program '" + name_ + "': uniform '" + name.text() + "' has another type");
    const size_t bytes =
        std::min(words, uniform.words) * sizeof(uint32_t);  // of an array the driver keeps the used elements
    if (std::memcmp(&values_[uniform.first], value, bytes) == 0) return nullptr;
    std::memcpy(&values_[uniform.first], value, bytes);
    return &uniform;
  }
  throw GpuError("program '" + name_ + "' has no uniform '" + name.text() + "'");
}

/// Sets a uniform. @param type  of OpenGL @param value  [count][components] words
void Program::set(UniformName name, uint32_t type, const void* value, size_t components, size_t count) const {
  if (unfinished_ && unfinished_->id == 0) return unfinished_->keep(name, type, value, components, count);
  const Uniform* u = changed(name, type, value, components * count);
  if (!u) return;
  const auto n = static_cast<GLsizei>(count);
  const auto* const floats = static_cast<const GLfloat*>(value);
  const auto* const words = static_cast<const GLuint*>(value);
  switch (type) {
    case GL_UNSIGNED_INT:
      return glProgramUniform1uiv(id_, u->location, n, words);
    case GL_UNSIGNED_INT_VEC2:
      return glProgramUniform2uiv(id_, u->location, n, words);
    case GL_INT:
      return glProgramUniform1iv(id_, u->location, n, static_cast<const GLint*>(value));
    case GL_FLOAT:
      return glProgramUniform1fv(id_, u->location, n, floats);
    case GL_FLOAT_VEC2:
      return glProgramUniform2fv(id_, u->location, n, floats);
    case GL_FLOAT_VEC3:
      return glProgramUniform3fv(id_, u->location, n, floats);
    case GL_FLOAT_VEC4:
      return glProgramUniform4fv(id_, u->location, n, floats);
    case GL_FLOAT_MAT4:
      return glProgramUniformMatrix4fv(id_, u->location, n, GL_FALSE, floats);
    default:
      throw GpuError("program '" + name_ + "': uniform '" + name.text() + "' has a type that cannot be set");
  }
}

void Program::set(UniformName name, uint32_t value) const {
  set(name, GL_UNSIGNED_INT, &value, 1, 1);
}

void Program::set(UniformName name, int32_t value) const {
  set(name, GL_INT, &value, 1, 1);
}

void Program::set(UniformName name, float value) const {
  set(name, GL_FLOAT, &value, 1, 1);
}

void Program::set(UniformName name, uint32_t x, uint32_t y) const {
  const uint32_t value[] = {x, y};
  set(name, GL_UNSIGNED_INT_VEC2, value, 2, 1);
}

void Program::setMatrix(UniformName name, const float* values) const {
  set(name, GL_FLOAT_MAT4, values, 16, 1);
}

void Program::setVectors(UniformName name, const float* values, size_t components, size_t count) const {
  const GLenum type = components == 2 ? GL_FLOAT_VEC2 : components == 3 ? GL_FLOAT_VEC3 : GL_FLOAT_VEC4;
  set(name, type, values, components, count);
}

void checkDispatches(bool check) {
  checks_dispatches = check;
}

}  // namespace viscera::gpu
