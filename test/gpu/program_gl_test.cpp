// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/program.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/gl.h"
#include "gpu/limits.h"
#include "gpu/reflection.h"
#include "layout/bindings.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

namespace viscera::gpu {
namespace {

/// Programs of a driver that compiles ahead, and of a driver that compiles a program at its first use.
class Programs : public ::testing::TestWithParam<bool> {
 protected:
  Programs() {
    Limits limits = driverLimits();
    limits.compiles_ahead = GetParam();
    pretendDriverLimits(limits);
  }
  ~Programs() override {
    checkDispatches(false);
    clearDriverLimits();
  }
  /// Returns the message that `call` throws.
  template <class Call>
  static std::string complaint(Call call) {
    try {
      call();
    } catch (const GpuError& e) {
      return e.what();
    }
    return "";
  }
  static Program splitTriangles() { return Program::compute("split_triangles.comp", {"GROUP_SIZE 64", "NETWORK"}); }
  Context context_;
};

INSTANTIATE_TEST_SUITE_P(Compiled, Programs, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "Ahead" : "AtFirstUse"; });

TEST_P(Programs, TakeUniformsByName) {
  const Program program = splitTriangles();
  program.set("count", 7u);
  GLuint value = 0;
  glGetUniformuiv(program.id(), glGetUniformLocation(program.id(), "count"), &value);
  EXPECT_EQ(value, 7u);
}

TEST_P(Programs, TakeTheFirstOfAnArrayAfterAllOfIt) {
  const Program program = Program::graphics("mesh.vert", "tissue.frag");
  const float tips[] = {1, 2, 3, 4, 5, 6, 7, 8}, first[] = {9, 10, 11, 12};
  program.setVectors("shaft_tips", tips, 4, 2);
  program.setVectors("shaft_tips", first, 4, 1);
  const auto valueOf = [&](const char* element) {
    std::array<float, 4> out{};
    glGetUniformfv(program.id(), glGetUniformLocation(program.id(), element), out.data());
    return out;
  };
  EXPECT_EQ(valueOf("shaft_tips[0]"), (std::array<float, 4>{9, 10, 11, 12}));
  EXPECT_EQ(valueOf("shaft_tips[1]"), (std::array<float, 4>{5, 6, 7, 8}));
}

TEST_P(Programs, OfTheWrongSourceAreRefusedWhenUsedAtTheLatest) {
  const Program broken = Program::compute("lattice.glsl", {"kBrickEdge broken("});
  EXPECT_TRUE(broken);
  EXPECT_NE(complaint([&] { broken.use(); }).find("layout.h"), std::string::npos);
}

TEST(ProgramsOfSoftware, AreNotCompiledUntilTheyAreUsed) {
  const Context context;
  if (driverLimits().compiles_ahead) GTEST_SKIP() << "a driver that compiles ahead";
  const MadePrograms made;
  const Program broken = Program::compute("lattice.glsl", {"kBrickEdge broken("});
  EXPECT_NO_THROW(made.require());
}

TEST(DeclaredUniforms, AreAllNamesOfADeclaration) {
  const std::string source =
      "uniform uint first_item, count;  // of nodes\nuniform vec4 tips[4] , ends[4];\nlayout(binding = 3) uniform "
      "samplerBuffer rest;\nlayout(std140) uniform Bodies { vec4 a; };\n";
  EXPECT_EQ(declaredUniforms(source), (std::vector<std::string>{"first_item", "count", "tips", "ends", "rest"}));
}

TEST_P(Programs, NameTheUniformThatTheyDoNotHave) {
  const Program program = splitTriangles();
  const std::string said = complaint([&] { program.set("conut", 7u); });
  EXPECT_NE(said.find("conut"), std::string::npos) << said;
  EXPECT_NE(said.find("split_triangles.comp"), std::string::npos) << said;
}

TEST_P(Programs, RefuseAUniformOfAnotherType) {
  const Program program = splitTriangles();
  const std::string said = complaint([&] {
    program.set("count", 7.0f);
    program.use();
  });
  EXPECT_NE(said.find("another type"), std::string::npos) << said;
}

TEST_P(Programs, PassOverUniformsThatTheirFeaturesLeaveOut) {
  const Program fold = Program::compute("sum_impulses.comp", {"GROUP_SIZE 64"});
  fold.set("slot_count", 5u);  // of feature LEAVES
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_P(Programs, NameWhatNothingIsBoundTo) {
  checkDispatches(true);
  const Program fold = Program::compute("sum_impulses.comp", {"GROUP_SIZE 64"});
  const Buffer<uint32_t> partials(64), stats(64);
  fold.use();
  partials.bindStorage(layout::kBindPartials);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, layout::kBindStats, 0);
  const std::string said = complaint([] { Program::dispatch(1, 64); });
  EXPECT_NE(said.find("StatsBuffer"), std::string::npos) << said;
  EXPECT_EQ(said.find("PartialsBuffer"), std::string::npos) << said;
}

TEST(Bindings, OfOneKindMayNotShareANumber) {
  const Binding nodes{BindingKind::kStorage, 3, "Nodes"}, rest{BindingKind::kTexture, 3, "rest"};
  EXPECT_NO_THROW(refuseSharedNumbers({nodes, rest}, "x.comp"));
  EXPECT_THROW(refuseSharedNumbers({nodes, rest, {BindingKind::kStorage, 3, "Links"}}, "x.comp"), GpuError);
}

TEST(DeclaredUniforms, AreFoundWhateverStandsBeforeAndBehind) {
  EXPECT_EQ(declaredUniforms("uniform vec3 tips[2];  // uniform float no;\n"
                             "layout(binding = 3) uniform samplerBuffer mass;\n"
                             "layout(std140, binding = 8) uniform Block { float x; };\n"
                             "float y = 1.0;\n"),
            (std::vector<std::string>{"tips", "mass"}));
}

}  // namespace
}  // namespace viscera::gpu
