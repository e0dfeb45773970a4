// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Constructs that shaders must avoid even if this machine's driver handles them (physics.md 2, 4).
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>

#include "support/source_folder.h"
#include "support/temporary_folder.h"

namespace viscera {
namespace {

/// Returns the names of the shaders with a match in their code, without comments.
std::vector<std::string> shadersThatSay(const std::string& pattern) {
  const std::regex comment("//[^\n]*"), wanted(pattern);
  std::vector<std::string> out;
  for (const char* folder : {"/shaders", "/bench", "/include/viscera/layout"}) {
    for (const auto& file : std::filesystem::recursive_directory_iterator(test::sourceFolder() + folder)) {
      const std::string kind = file.path().extension().string();
      if (kind != ".comp" && kind != ".vert" && kind != ".frag" && kind != ".glsl" && kind != ".h") continue;
      const std::string code = std::regex_replace(test::readFile(file.path().string()), comment, "");
      if (std::regex_search(code, wanted)) out.push_back(file.path().filename().string());
    }
  }
  return out;
}

using Names = std::vector<std::string>;

TEST(ShaderSources, AreFound) {
  const Names kernels = shadersThatSay("void main");
  EXPECT_GT(kernels.size(), 40u);
  for (const char* name : {"leapfrog.comp", "map_skin.comp", "tissue.frag", "gw_edge.comp", "bench_fma.comp"}) {
    EXPECT_EQ(std::count(kernels.begin(), kernels.end(), name), 1) << name;
  }
}

/// Drivers may flush or quieten bits that are no ordinary float, so a packed normal stays a uint (EGVE 3.2, VR05 2.6).
TEST(ShaderSources, KeepPackedNormalsOutOfFloats) {
  const Names with_normals = shadersThatSay("ackNormal");  // packNormal() and unpackNormal()
  EXPECT_GE(with_normals.size(), 2u);
  for (const std::string& name : shadersThatSay("BitsToFloat")) {
    EXPECT_EQ(std::count(with_normals.begin(), with_normals.end(), name), 0) << name;
  }
}

/// Compilers may assume that no number is NaN and remove the test.
TEST(ShaderSources, NeverAskIsnanOrIsinf) {
  EXPECT_EQ(shadersThatSay("\\bis(nan|inf)\\b"), Names{});
}

}  // namespace
}  // namespace viscera
