// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera::gpu {

/// The files of one shader in the order of their numbers in #line, to translate logs.
using ShaderFiles = std::vector<std::string>;

/// Returns the source of an embedded shader with its #include lines expanded (#line kept), after `#version 450 core`
/// and defines. @param files  its files   @throws GpuError  no such shader
std::string expandedShader(const std::string& name, const std::vector<std::string>& defines, ShaderFiles& files);

/// Returns a legend of the numbers in #line.
std::string filesLegend(const ShaderFiles& files);

}  // namespace viscera::gpu
