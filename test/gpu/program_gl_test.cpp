// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/program.h"

#include <gtest/gtest.h>

#include "gpu/buffer.h"
#include "gpu/gl.h"
#include "gpu/reflection.h"
#include "layout/bindings.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

namespace viscera::gpu {
namespace {

class Programs : public ::testing::Test {
 protected:
  ~Programs() override { checkDispatches(false); }
  /// What `call` says when it throws.
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

TEST_F(Programs, TakeUniformsByName) {
  const Program program = splitTriangles();
  program.set("count", 7u);
  GLuint value = 0;
  glGetUniformuiv(program.id(), glGetUniformLocation(program.id(), "count"), &value);
  EXPECT_EQ(value, 7u);
}

TEST_F(Programs, NameTheUniformThatTheyDoNotHave) {
  const Program program = splitTriangles();
  const std::string said = complaint([&] { program.set("conut", 7u); });
  EXPECT_NE(said.find("conut"), std::string::npos) << said;
  EXPECT_NE(said.find("split_triangles.comp"), std::string::npos) << said;
}

TEST_F(Programs, RefuseAUniformOfAnotherType) {
  const Program program = splitTriangles();
  EXPECT_NE(complaint([&] { program.set("count", 7.0f); }), "");
}

TEST_F(Programs, PassOverUniformsThatTheirFeaturesLeaveOut) {
  const Program fold = Program::compute("sum_impulses.comp", {"GROUP_SIZE 64"});
  fold.set("slot_count", 5u);  // of feature LEAVES
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_F(Programs, NameWhatNothingIsBoundTo) {
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
