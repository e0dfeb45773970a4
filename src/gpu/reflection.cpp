// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/reflection.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "gpu/gl.h"
#include "gpu/source_lines.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

namespace {

constexpr GLsizei kLongestName = 256;

bool isTexture(GLenum type) {
  switch (type) {
    case GL_SAMPLER_2D:
    case GL_SAMPLER_BUFFER:
    case GL_INT_SAMPLER_BUFFER:
    case GL_UNSIGNED_INT_SAMPLER_BUFFER:
      return true;
    default:
      return false;
  }
}

std::string withoutIndex(const std::string& name) {
  return name.substr(0, name.find('['));
}

/// Returns all uniforms outside of blocks, including textures.
std::vector<ActiveUniform> looseUniforms(uint32_t program) {
  std::vector<ActiveUniform> out;
  GLint count = 0;
  glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
  for (GLint i = 0; i < count; ++i) {
    std::array<char, kLongestName> name{};
    GLint elements = 0;
    GLenum type = 0;
    glGetActiveUniform(program, static_cast<GLuint>(i), kLongestName, nullptr, &elements, &type, name.data());
    const GLint location = glGetUniformLocation(program, name.data());
    if (location >= 0) out.push_back({withoutIndex(name.data()), location, type, elements});
  }
  return out;
}

void appendBlocks(uint32_t program, GLenum interface, BindingKind kind, std::vector<Binding>& out) {
  GLint count = 0;
  glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
  for (GLint i = 0; i < count; ++i) {
    const auto index = static_cast<GLuint>(i);
    const GLenum wanted = GL_BUFFER_BINDING;
    GLint number = 0;
    std::array<char, kLongestName> name{};
    glGetProgramResourceiv(program, interface, index, 1, &wanted, 1, nullptr, &number);
    glGetProgramResourceName(program, interface, index, kLongestName, nullptr, name.data());
    out.push_back({kind, static_cast<uint32_t>(number), name.data()});
  }
}

bool isBound(const Binding& binding) {
  GLint bound = 0;
  if (binding.kind == BindingKind::kStorage) {
    glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, binding.number, &bound);
  } else if (binding.kind == BindingKind::kUniform) {
    glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, binding.number, &bound);
  } else {
    GLint unit_before = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &unit_before);
    glActiveTexture(GL_TEXTURE0 + binding.number);
    for (const GLenum target : {GL_TEXTURE_BINDING_BUFFER, GL_TEXTURE_BINDING_2D}) {
      if (!bound) glGetIntegerv(target, &bound);
    }
    glActiveTexture(static_cast<GLenum>(unit_before));
  }
  return bound != 0;
}

}  // namespace

std::vector<ActiveUniform> activeUniforms(uint32_t program) {
  std::vector<ActiveUniform> out;
  for (ActiveUniform& uniform : looseUniforms(program)) {
    if (!isTexture(uniform.type)) out.push_back(std::move(uniform));
  }
  return out;
}

std::vector<std::string> declaredUniforms(const std::string& source) {
  std::vector<std::string> out;
  SourceLines lines(source);
  for (std::string_view line; lines.next(line);) {
    const std::string_view code = line.substr(0, line.find("//"));
    const size_t word = code.find("uniform ");
    const size_t end = code.rfind(';');
    if (word == std::string_view::npos || end == std::string_view::npos || code.find('{') != std::string_view::npos)
      continue;
    std::string_view names = code.substr(word, end - word);
    takeWord(names);  // "uniform"
    takeWord(names);  // its type
    while (!names.empty()) {
      std::string_view one = names.substr(0, names.find(','));
      names.remove_prefix(std::min(one.size() + 1, names.size()));
      out.push_back(withoutIndex(std::string(takeWord(one))));
    }
  }
  return out;
}

std::vector<Binding> bindingsOf(uint32_t program) {
  std::vector<Binding> out;
  appendBlocks(program, GL_SHADER_STORAGE_BLOCK, BindingKind::kStorage, out);
  appendBlocks(program, GL_UNIFORM_BLOCK, BindingKind::kUniform, out);
  for (const ActiveUniform& uniform : looseUniforms(program)) {
    if (!isTexture(uniform.type)) continue;
    GLint unit = 0;
    glGetUniformiv(program, uniform.location, &unit);
    out.push_back({BindingKind::kTexture, static_cast<uint32_t>(unit), uniform.name});
  }
  return out;
}

void refuseSharedNumbers(const std::vector<Binding>& bindings, const std::string& program) {
  for (size_t i = 0; i < bindings.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      if (bindings[i].kind != bindings[j].kind || bindings[i].number != bindings[j].number) continue;
      throw GpuError("program '" + program + "': " + bindings[j].name + " and " + bindings[i].name +
                     " have the same binding, " + std::to_string(bindings[i].number));
    }
  }
}

std::vector<std::string> unboundNow(const std::vector<Binding>& bindings) {
  std::vector<std::string> out;
  for (const Binding& binding : bindings) {
    if (!isBound(binding)) out.push_back(binding.name);
  }
  return out;
}

}  // namespace viscera::gpu
