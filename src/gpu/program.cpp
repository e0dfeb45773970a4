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
#include <sstream>
#include <utility>

#include "gpu/buffer.h"
#include "gpu/embedded_shaders.h"
#include "gpu/gl.h"
#include "gpu/limits.h"
#include "gpu/reflection.h"
#include "gpu/storage_blocks.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

/// What messages say of a program.
struct ProgramLabel {
  explicit ProgramLabel(std::string of) : name(std::move(of)) {}
  std::string name;
  std::atomic<bool> has_run{false};  ///< a dispatch of it has been looked at: asking after each would cost
};

namespace {

const EmbeddedShader* find(const std::string& name) {
  for (int i = 0; i < kEmbeddedShaderCount; ++i) {
    if (name == kEmbeddedShaders[i].name) return &kEmbeddedShaders[i];
  }
  return nullptr;
}

/// The files of one program in the order of their numbers in #line, so that a log can be read back.
using Files = std::vector<std::string>;

int fileNumber(Files& files, const std::string& name) {
  for (size_t i = 0; i < files.size(); ++i) {
    if (files[i] == name) return static_cast<int>(i);
  }
  files.push_back(name);
  return static_cast<int>(files.size()) - 1;
}

/// What an #include line names, without its folder: that is for C++.
std::string includedName(const std::string& line) {
  if (line.rfind("#include", 0) != 0) return "";
  const size_t open = line.find('"');
  const size_t close = line.rfind('"');
  if (open == std::string::npos || close == open) return "";
  const std::string path = line.substr(open + 1, close - open - 1);
  return path.substr(path.rfind('/') + 1);
}

void expand(const std::string& name, const std::string& from, Files& files, std::ostringstream& out) {
  const EmbeddedShader* shader = find(name);
  if (!shader) throw GpuError("no shader '" + name + "'" + (from.empty() ? "" : ", included from " + from));
  const int number = fileNumber(files, name);
  out << "#line 1 " << number << '\n';
  std::istringstream lines(shader->text);
  std::string line;
  for (int line_number = 1; std::getline(lines, line); ++line_number) {
    const std::string included = includedName(line);
    if (included.empty()) {
      out << line << '\n';
      continue;
    }
    if (std::find(files.begin(), files.end(), included) == files.end()) {  // every file at most once
      expand(included, name + ":" + std::to_string(line_number), files, out);
    }
    out << "#line " << line_number + 1 << ' ' << number << '\n';
  }
}

std::string expanded(const std::string& name, const std::vector<std::string>& defines, Files& files) {
  std::ostringstream out;
  out << "#version 450 core\n";
  for (const std::string& define : defines) out << "#define " << define << '\n';
  expand(name, "", files, out);
  return out.str();
}

std::string filesLegend(const Files& files) {
  std::string out;
  for (size_t i = 0; i < files.size(); ++i) out += (i ? ", " : "") + std::to_string(i) + " = " + files[i];
  return out;
}

/// A shader that the driver has been told to compile.
struct ShaderStage {
  uint32_t id;
  std::string name;
  Files files;
};

/// @throws GpuError  it does not compile
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

namespace {

/// Where programs that this thread makes are listed until they are finished.
thread_local std::set<UnfinishedProgram*>* listed = nullptr;

}  // namespace

/// Of a program that was not used yet.
struct UnfinishedProgram {
  uint32_t id = 0;
  std::string name;
  std::vector<ShaderStage> stages;
  std::vector<std::string> uniforms;  ///< that its shaders declare, as often as they like

  UnfinishedProgram() {
    if (listed) listed->insert(this);
  }
  UnfinishedProgram(const UnfinishedProgram&) = delete;
  UnfinishedProgram& operator=(const UnfinishedProgram&) = delete;
  ~UnfinishedProgram() {
    if (listed) listed->erase(this);
    for (const ShaderStage& stage : stages) glDeleteShader(stage.id);
  }
  void compile(GLenum kind, const std::string& name, const std::vector<std::string>& defines) {
    ShaderStage stage{0, name, {}};
    const std::string source = expanded(name, defines, stage.files);
    for (std::string& uniform : declaredUniforms(source)) uniforms.push_back(std::move(uniform));
    const char* text = source.c_str();
    stage.id = glCreateShader(kind);
    countObject();
    glShaderSource(stage.id, 1, &text, nullptr);
    glCompileShader(stage.id);
    stages.push_back(std::move(stage));
  }
  /// @throws GpuError  it does not compile or link
  void require() const {
    for (const ShaderStage& stage : stages) finishStage(stage);
    GLint ok = 0, length = 0;
    glGetProgramiv(id, GL_LINK_STATUS, &ok);
    if (ok) return;
    glGetProgramiv(id, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<size_t>(length) + 1, '\0');
    glGetProgramInfoLog(id, length, nullptr, log.data());
    throw GpuError("program '" + name + "' does not link:\n" + log.c_str());
  }
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

/// Programs that are to be looked at when they first run; only used where tests ask for it.
std::atomic<bool> checks_dispatches{false};
std::mutex unchecked_mutex;
std::set<uint32_t> unchecked;

/// Of the program that this thread uses; kept as long as the process lives, one for each name.
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
    throw GpuError("kernel '" + (in_use ? in_use->name : "") + "' runs with nothing bound to:" + missing);
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
  Files files;
  return expanded(name, defines, files);
}

Program Program::compute(const std::string& name, const std::vector<std::string>& features) {
  const std::vector<std::string> defines = withLoads(name, features);
  Program out;
  out.name_ = name;
  requireStorageBlocks(driverLimits(), name, declaredStorageBlocks(shaderSource(name, defines)));
  out.unfinished_ = std::make_unique<UnfinishedProgram>();
  out.unfinished_->compile(GL_COMPUTE_SHADER, name, defines);
  out.link();
  return out;
}

Program Program::graphics(const std::string& vertex, const std::string& fragment,
                          const std::vector<std::string>& defines) {
  Program out;
  out.name_ = vertex + " + " + fragment;
  out.unfinished_ = std::make_unique<UnfinishedProgram>();
  out.unfinished_->compile(GL_VERTEX_SHADER, vertex, defines);
  out.unfinished_->compile(GL_FRAGMENT_SHADER, fragment, defines);
  out.link();
  return out;
}

void Program::link() {
  id_ = glCreateProgram();
  countObject();
  unfinished_->id = id_;
  unfinished_->name = name_;
  for (const ShaderStage& stage : unfinished_->stages) glAttachShader(id_, stage.id);
  glLinkProgram(id_);
  label_ = labelOf(name_);
}

void Program::finish() const {
  if (!unfinished_) return;
  unfinished_->require();
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
        throw GpuError("program '" + name_ + "': uniform '" + name + "' needs another name");
    }
    uniforms_.push_back(uniform);
  }
  unfinished_.reset();
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
  // One dimension of groups holds at least 65,535; more are folded into the second, which kernels undo (globalIndex()).
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

MadePrograms::MadePrograms() : before_(std::exchange(listed, &made_)) {}

MadePrograms::~MadePrograms() {
  listed = before_;
}

void MadePrograms::require() const {
  for (const UnfinishedProgram* program : made_) program->require();
}

std::string lastKernel() {
  return in_use ? in_use->name : "none";
}

void Program::storageBarrier() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                  GL_COMMAND_BARRIER_BIT);
}

/// Notes a value. OpenGL's own start, zero, is known too. @return null: nothing is to be done
const Program::Uniform* Program::changed(UniformName name, uint32_t type, const void* value, size_t words) const {
  finish();
  for (const Uniform& uniform : uniforms_) {
    if (uniform.key != name.key()) continue;
    if (uniform.location < 0) return nullptr;
    if (uniform.type != type)
      throw GpuError("program '" + name_ + "': uniform '" + name.text() + "' is of another type");
    const size_t bytes =
        std::min(words, uniform.words) * sizeof(uint32_t);  // of an array the driver keeps what is used
    if (std::memcmp(&values_[uniform.first], value, bytes) == 0) return nullptr;
    std::memcpy(&values_[uniform.first], value, bytes);
    return &uniform;
  }
  throw GpuError("program '" + name_ + "' has no uniform '" + name.text() + "'");
}

void Program::set(UniformName name, uint32_t value) const {
  if (const Uniform* u = changed(name, GL_UNSIGNED_INT, &value, 1)) glProgramUniform1ui(id_, u->location, value);
}

void Program::set(UniformName name, int32_t value) const {
  if (const Uniform* u = changed(name, GL_INT, &value, 1)) glProgramUniform1i(id_, u->location, value);
}

void Program::set(UniformName name, float value) const {
  if (const Uniform* u = changed(name, GL_FLOAT, &value, 1)) glProgramUniform1f(id_, u->location, value);
}

void Program::set(UniformName name, uint32_t x, uint32_t y) const {
  const uint32_t value[] = {x, y};
  if (const Uniform* u = changed(name, GL_UNSIGNED_INT_VEC2, value, 2))
    glProgramUniform2uiv(id_, u->location, 1, value);
}

void Program::setMatrix(UniformName name, const float* values) const {
  const Uniform* u = changed(name, GL_FLOAT_MAT4, values, 16);
  if (u) glProgramUniformMatrix4fv(id_, u->location, 1, GL_FALSE, values);
}

void Program::setVectors(UniformName name, const float* values, size_t components, size_t count) const {
  const GLenum type = components == 2 ? GL_FLOAT_VEC2 : components == 3 ? GL_FLOAT_VEC3 : GL_FLOAT_VEC4;
  const Uniform* u = changed(name, type, values, components * count);
  if (!u) return;
  const auto set = components == 2 ? glProgramUniform2fv : components == 3 ? glProgramUniform3fv : glProgramUniform4fv;
  set(id_, u->location, static_cast<GLsizei>(count), values);
}

void checkDispatches(bool check) {
  checks_dispatches = check;
}

}  // namespace viscera::gpu
