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
#include "math/number_text.h"
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
  TextIn lines(shader->text);
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
  TextOut out;
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

/// One shader of a program.
struct ShaderStage {
  GLenum kind;
  uint32_t id;  ///< 0: the driver was not told to compile it yet
  std::string name;
  Files files;
  std::string source;  ///< until then
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

/// A uniform's value that was set before its program was compiled.
struct PendingValue {
  UniformName name;
  uint32_t type;
  size_t components, count;  ///< words of an element, elements
  std::vector<uint32_t> words;
};

}  // namespace

namespace {

/// Where programs that this thread makes are listed until they are finished.
thread_local std::set<UnfinishedProgram*>* listed = nullptr;

}  // namespace

/// What a Program needs until it is first used: its shaders, and the values set so far.
struct UnfinishedProgram {
  uint32_t id = 0;  ///< 0: the driver was not told to compile it yet
  std::string name;
  std::vector<ShaderStage> stages;
  std::vector<std::string> uniforms;  ///< that its shaders declare, as often as they like
  std::vector<PendingValue> values;

  UnfinishedProgram() {
    if (listed) listed->insert(this);
  }
  UnfinishedProgram(const UnfinishedProgram&) = delete;
  UnfinishedProgram& operator=(const UnfinishedProgram&) = delete;
  ~UnfinishedProgram() {
    if (listed) listed->erase(this);
    for (const ShaderStage& stage : stages) glDeleteShader(stage.id);
    if (id) glDeleteProgram(id);
  }
  void add(GLenum kind, const std::string& shader, const std::vector<std::string>& defines) {
    ShaderStage stage{kind, 0, shader, {}, {}};
    stage.source = expanded(shader, defines, stage.files);
    for (std::string& uniform : declaredUniforms(stage.source)) uniforms.push_back(std::move(uniform));
    stages.push_back(std::move(stage));
  }
  /// Tells the driver to compile and link it, once.
  void start() {
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
  countObject();  // now, whenever they are made: what runs later makes none that was not planned
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
        throw GpuError("program '" + name_ + "': uniform '" + name + "' needs another name");
    }
    uniforms_.push_back(uniform);
  }
  unfinished_->id = 0;  // it is this object's now
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
  for (const UnfinishedProgram* program : made_) {
    if (program->id) program->require();
  }
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
  refuseUnknown(name);
}

void Program::refuseUnknown(UniformName name) const {
  throw GpuError("program '" + name_ + "' has no uniform '" + name.text() + "'");
}

/// Keeps a value for the time when the program is compiled.
void Program::keep(UniformName name, uint32_t type, const void* value, size_t components, size_t count) const {
  const auto& declared = unfinished_->uniforms;
  if (std::find(declared.begin(), declared.end(), name.text()) == declared.end()) refuseUnknown(name);
  auto& values = unfinished_->values;
  const auto same = [name](const PendingValue& it) { return it.name.key() == name.key(); };
  auto kept = std::find_if(values.begin(), values.end(), same);
  if (kept == values.end()) kept = values.insert(values.end(), PendingValue{name, type, components, 0, {}});
  if (kept->type != type) throw GpuError("program '" + name_ + "': uniform '" + name.text() + "' is of another type");
  kept->count = std::max(kept->count, count);
  kept->words.resize(kept->count * components);
  std::memcpy(kept->words.data(), value, count * components * sizeof(uint32_t));
}

/// @param type  of OpenGL @param value  [count][components] words
void Program::set(UniformName name, uint32_t type, const void* value, size_t components, size_t count) const {
  if (unfinished_ && unfinished_->id == 0) return keep(name, type, value, components, count);
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
      throw GpuError("program '" + name_ + "': uniform '" + name.text() + "' is of a type that cannot be set");
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
