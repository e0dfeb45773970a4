// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/shader_text.h"

#include <algorithm>
#include <sstream>

#include "gpu/embedded_shaders.h"
#include "math/number_text.h"
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
std::string includedName(const std::string& line) {
  if (line.rfind("#include", 0) != 0) return "";
  const size_t open = line.find('"');
  const size_t close = line.rfind('"');
  if (open == std::string::npos || close == open) return "";
  const std::string path = line.substr(open + 1, close - open - 1);
  return path.substr(path.rfind('/') + 1);
}

void expand(const std::string& name, const std::string& from, ShaderFiles& files, std::ostringstream& out) {
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

}  // namespace

std::string expandedShader(const std::string& name, const std::vector<std::string>& defines, ShaderFiles& files) {
  TextOut out;
  out << "#version 450 core\n";
  for (const std::string& define : defines) out << "#define " << define << '\n';
  expand(name, "", files, out);
  return out.str();
}

std::string filesLegend(const ShaderFiles& files) {
  std::string out;
  for (size_t i = 0; i < files.size(); ++i) out += (i ? ", " : "") + std::to_string(i) + " = " + files[i];
  return out;
}

}  // namespace viscera::gpu
