// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/shader_text.h"

#include <algorithm>

#include "gpu/embedded_shaders.h"
#include "gpu/source_lines.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

namespace {

const EmbeddedShader* find(const std::string& name) {
  for (int i = 0; i < kEmbeddedShaderCount; ++i) {
    if (name == kEmbeddedShaders[i].name) return &kEmbeddedShaders[i];
  }
  return nullptr;
}

int fileNumber(ShaderFiles& files, const std::string& name) {
  for (size_t i = 0; i < files.size(); ++i) {
    if (files[i] == name) return static_cast<int>(i);
  }
  files.push_back(name);
  return static_cast<int>(files.size()) - 1;
}

/// Returns the file name of an #include line, without its folder, which only C++ needs.
std::string includedName(std::string_view line) {
  if (line.rfind("#include", 0) != 0) return "";
  const size_t open = line.find('"');
  const size_t close = line.rfind('"');
  if (open == std::string_view::npos || close == open) return "";
  const std::string_view path = line.substr(open + 1, close - open - 1);
  return std::string(path.substr(path.rfind('/') + 1));
}

/// Appends `#line`, from which the compiler counts on. @param file  its number
void appendLineNumber(int line, int file, std::string& out) {
  out += "#line " + std::to_string(line) + ' ' + std::to_string(file) + '\n';
}

void expand(const std::string& name, const std::string& from, ShaderFiles& files, std::string& out) {
  const EmbeddedShader* shader = find(name);
  if (!shader) throw GpuError("no shader '" + name + "'" + (from.empty() ? "" : ", included from " + from));
  const int number = fileNumber(files, name);
  appendLineNumber(1, number, out);
  SourceLines lines(shader->text);
  std::string_view line;
  for (int line_number = 1; lines.next(line); ++line_number) {
    const std::string included = includedName(line);
    if (included.empty()) {
      out.append(line) += '\n';
      continue;
    }
    if (std::find(files.begin(), files.end(), included) == files.end()) {  // every file at most once
      expand(included, name + ":" + std::to_string(line_number), files, out);
    }
    appendLineNumber(line_number + 1, number, out);
  }
}

}  // namespace

std::string expandedShader(const std::string& name, const std::vector<std::string>& defines, ShaderFiles& files) {
  std::string out = "#version 450 core\n";
  for (const std::string& define : defines) out += "#define " + define + '\n';
  expand(name, "", files, out);
  return out;
}

std::string filesLegend(const ShaderFiles& files) {
  std::string out;
  for (size_t i = 0; i < files.size(); ++i) out += (i ? ", " : "") + std::to_string(i) + " = " + files[i];
  return out;
}

}  // namespace viscera::gpu
