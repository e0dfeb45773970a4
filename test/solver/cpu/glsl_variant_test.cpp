// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// One text, compiled as C++ with features in either order: no definitions leak from one variant into the next.
#include <gtest/gtest.h>

#include <type_traits>

#include "solver/cpu/kernels/glsl_kernel.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/layout/tool_motion.h"

namespace viscera::glsl {
namespace {

struct ToolKernel : Kernel {
  using Kernel::Kernel;
  uint stylus = 0;
  vec4 tip = vec4(0), orientation = vec4(0);
  float release_speed = 0, above = -1;
  TickStats stats{};
};

#define VARIANT_NAME ReleaseFirst
#define VARIANT_BASE ToolKernel
#define VARIANT_TEXT "shaders/solver/tools/grab.comp"
#define VARIANT_FEATURES WITH_RELEASE | WITH_TOOLS
#define VARIANT_MEMBERS                    \
  uint beside() {                          \
    return neighborSlot(stylus, ivec3(1)); \
  }
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME Hold
#define VARIANT_BASE ToolKernel
#define VARIANT_TEXT "shaders/solver/tools/grab.comp"
#define VARIANT_FEATURES WITH_TOOLS
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME ReleaseAfterwards
#define VARIANT_BASE ToolKernel
#define VARIANT_TEXT "shaders/solver/tools/grab.comp"
#define VARIANT_FEATURES WITH_TOOLS | WITH_RELEASE
#include "solver/cpu/kernels/glsl_variant.inc"

#if defined(TOOLS) || defined(RELEASE) || defined(LATTICE) || defined(NETWORK) || defined(INOUT) ||       \
    defined(precise) || defined(FOR_EACH_SPRING) || defined(VARIANT_NAME) || defined(VARIANT_FEATURES) || \
    defined(VARIANT_MEMBERS)
#error "a variant has left macros behind"
#endif

/// Whether a variant has a function takeHold(), as a kernel without feature RELEASE; variant ReleaseFirst has
/// `beside()`.
template <class Variant, class = void>
struct Holds : std::false_type {};
template <class Variant>
struct Holds<Variant, std::void_t<decltype(&Variant::takeHold)>> : std::true_type {};
template <class Variant, class = void>
struct HasBeside : std::false_type {};
template <class Variant>
struct HasBeside<Variant, std::void_t<decltype(&Variant::beside)>> : std::true_type {};

TEST(GlslVariant, HasItsOwnFeaturesWhateverStandsBefore) {
  EXPECT_FALSE(Holds<ReleaseFirst>::value);
  EXPECT_TRUE(Holds<Hold>::value);
  EXPECT_FALSE(Holds<ReleaseAfterwards>::value);
}

TEST(GlslVariant, HasItsOwnMembersAlone) {
  EXPECT_TRUE(HasBeside<ReleaseFirst>::value);
  EXPECT_FALSE(HasBeside<Hold>::value);
  EXPECT_FALSE(HasBeside<ReleaseAfterwards>::value);
}

}  // namespace
}  // namespace viscera::glsl
