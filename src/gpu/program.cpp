// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/gpu/program.h"

#include <algorithm>
#include <cstring>
#include <sstream>
#include <utility>

#include "gpu/embedded_shaders.h"
#include "gpu/gl.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

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

uint32_t compileStage(GLenum stage, const std::string& name, const std::vector<std::string>& defines) {
  Files files;
  const std::string source = expanded(name, defines, files);
  const char* text = source.c_str();
  const uint32_t shader = glCreateShader(stage);
  countObject();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint ok = 0, length = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok) return shader;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<size_t>(length) + 1, '\0');
  glGetShaderInfoLog(shader, length, nullptr, log.data());
  glDeleteShader(shader);
  throw GpuError("shader '" + name + "' does not compile (files: " + filesLegend(files) + "):\n" + log.c_str());
}

uint32_t link(const std::vector<uint32_t>& stages, const std::string& name) {
  const uint32_t program = glCreateProgram();
  countObject();
  for (uint32_t stage : stages) glAttachShader(program, stage);
  glLinkProgram(program);
  for (uint32_t stage : stages) glDeleteShader(stage);
  GLint ok = 0, length = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &ok);
  if (ok) return program;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<size_t>(length) + 1, '\0');
  glGetProgramInfoLog(program, length, nullptr, log.data());
  glDeleteProgram(program);
  throw GpuError("program '" + name + "' does not link:\n" + log.c_str());
}

}  // namespace

std::string shaderSource(const std::string& name, const std::vector<std::string>& defines) {
  Files files;
  return expanded(name, defines, files);
}

Program Program::compute(const std::string& name, const std::vector<std::string>& defines) {
  Program out;
  out.id_ = link({compileStage(GL_COMPUTE_SHADER, name, defines)}, name);
  return out;
}

Program Program::graphics(const std::string& vertex, const std::string& fragment,
                          const std::vector<std::string>& defines) {
  const uint32_t first = compileStage(GL_VERTEX_SHADER, vertex, defines);
  Program out;
  out.id_ = link({first, compileStage(GL_FRAGMENT_SHADER, fragment, defines)}, vertex + " + " + fragment);
  return out;
}

Program::~Program() {
  if (id_) glDeleteProgram(id_);
}

Program::Program(Program&& other) noexcept : id_(std::exchange(other.id_, 0)), uniforms_(std::move(other.uniforms_)) {}

Program& Program::operator=(Program&& other) noexcept {
  std::swap(id_, other.id_);
  uniforms_.swap(other.uniforms_);
  return *this;
}

void Program::use() const {
  glUseProgram(id_);
}

void Program::dispatch(size_t invocations, uint32_t group_size) {
  if (invocations == 0) return;
  // One dimension of groups holds at least 65,535; more are folded into the second, which kernels undo (globalIndex()).
  constexpr size_t kMaxGroups = 65535;
  const size_t groups = (invocations + group_size - 1) / group_size;
  const size_t rows = (groups + kMaxGroups - 1) / kMaxGroups;
  glDispatchCompute(static_cast<GLuint>(rows == 1 ? groups : kMaxGroups), static_cast<GLuint>(rows), 1);
}

void Program::storageBarrier() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

int Program::location(const char* uniform) const {
  return glGetUniformLocation(id_, uniform);
}

/// Notes the value. OpenGL's own start, zero, is known too.
bool Program::changes(int location, const void* value, size_t bytes) const {
  const size_t at = static_cast<size_t>(location);
  if (at >= uniforms_.size()) uniforms_.resize(at + 1);
  if (std::memcmp(uniforms_[at].data(), value, bytes) == 0) return false;
  std::memcpy(uniforms_[at].data(), value, bytes);
  return true;
}

void Program::set(int location, uint32_t value) const {
  if (changes(location, &value, sizeof value)) glProgramUniform1ui(id_, location, value);
}

void Program::set(int location, float value) const {
  if (changes(location, &value, sizeof value)) glProgramUniform1f(id_, location, value);
}

void Program::setVector(int location, const float* value, size_t components) const {
  if (!changes(location, value, components * sizeof *value)) return;
  (components == 3 ? glProgramUniform3fv : glProgramUniform4fv)(id_, location, 1, value);
}

}  // namespace viscera::gpu
