// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The driver's offsets of struct members that C++ and GLSL share (those of C++: src/gpu/layout_check.cpp).
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "gpu/gl.h"
#include "gpu/program.h"
#include "layout/network_skin.h"
#include "viscera/gpu/context.h"
#include "viscera/layout/nodes.h"
#include "viscera/layout/skin.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/layout/tool_motion.h"

namespace viscera::gpu {
namespace {

/// Returns the offset within its block in bytes; -1 if the driver knows no such variable.
int offsetOf(const Program& program, GLenum interface, const std::string& variable) {
  const GLuint index = glGetProgramResourceIndex(program.id(), interface, variable.c_str());
  if (index == GL_INVALID_INDEX) return -1;
  const GLenum wanted = GL_OFFSET;
  GLint offset = -1;
  glGetProgramResourceiv(program.id(), interface, index, 1, &wanted, 1, nullptr, &offset);
  return offset;
}

class Layout : public ::testing::Test {
 protected:
  Context context_;
};

struct Member {
  const char* name;
  size_t offset;
};
#define MEMBER(Struct, name)              \
  Member {                                \
#name, offsetof(layout::Struct, name) \
  }

void expectStorage(const Program& program, const std::string& element, const std::vector<Member>& members) {
  for (const Member& member : members) {
    EXPECT_EQ(offsetOf(program, GL_BUFFER_VARIABLE, element + "." + member.name), static_cast<int>(member.offset))
        << element << "." << member.name;
  }
}

TEST_F(Layout, OfMeasurements) {
  const Program program = Program::compute("sum_impulses.comp", {"GROUP_SIZE 64"});
  expectStorage(program, "stats",
                {{"impulse[0]", offsetof(layout::TickStats, impulse)},
                 {"angular[0]", offsetof(layout::TickStats, angular)},
                 MEMBER(TickStats, springs_cut),
                 MEMBER(TickStats, max_speed_bits),
                 {"grabbed[0]", offsetof(layout::TickStats, grabbed)},
                 {"touched[0]", offsetof(layout::TickStats, touched)},
                 MEMBER(TickStats, kinetic_j),
                 MEMBER(TickStats, inverted),
                 MEMBER(TickStats, crowded)});
}

TEST_F(Layout, OfSkins) {
  const Program program = Program::compute("map_skin.comp", {"GROUP_SIZE 64", "CURVED", "NORMALS"});
  expectStorage(program, "skin[0]",
                {MEMBER(SkinBinding, slot2), MEMBER(SkinBinding, springs), MEMBER(SkinBinding, weights),
                 MEMBER(SkinBinding, offset_interpolated), MEMBER(SkinBinding, normal_interpolated)});
  const Program normal = Program::compute("node_normal.comp", {"GROUP_SIZE 64"});
  expectStorage(normal, "nodes[0]", {MEMBER(NodeBits, lo), MEMBER(NodeBits, hi)});
}

TEST_F(Layout, OfNetworksSkins) {
  const Program program = Program::compute("split_triangles.comp", {"GROUP_SIZE 64", "NETWORK"});
  expectStorage(program, "split_triangles[0]",
                {MEMBER(SplitTriangle, triangle),
                 {"springs[0]", offsetof(layout::SplitTriangle, springs)},
                 {"vertices[0]", offsetof(layout::SplitTriangle, vertices)},
                 {"slots[0]", offsetof(layout::SplitTriangle, slots)}});
}

TEST_F(Layout, OfUniformBlocks) {
  const Program program = Program::compute("cut.comp", {"GROUP_SIZE 64", "LATTICE", "TEXELS"});
  for (const Member& member : {MEMBER(ToolMotion, to), MEMBER(ToolMotion, blade_to), MEMBER(ToolMotion, info)}) {
    const std::string name = std::string("tool_motions[1].") + member.name;
    EXPECT_EQ(offsetOf(program, GL_UNIFORM, name), static_cast<int>(sizeof(layout::ToolMotion) + member.offset))
        << name;
  }
  const std::string bulk = "bodies[1].bulk_j";
  EXPECT_EQ(offsetOf(program, GL_UNIFORM, bulk),
            static_cast<int>(sizeof(layout::BodyParams) + offsetof(layout::BodyParams, bulk_j)));
}

}  // namespace
}  // namespace viscera::gpu
