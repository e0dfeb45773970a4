// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Content of buffers that kernels read directly after creation, clearing and writing: a driver may do these on
// different engines.
#include "gpu/buffer.h"

#include <gtest/gtest.h>

#include <numeric>

#include "gpu/gl.h"
#include "gpu/program.h"
#include "viscera/gpu/context.h"

namespace viscera::gpu {
namespace {

constexpr const char* kCopy = R"(#version 450 core
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer From { uint from[]; };
layout(std430, binding = 1) writeonly buffer To { uint to[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < uint(from.length())) to[i] = from[i];
})";

/// Sizes below, at and above those at which drivers treat buffers differently.
class Buffers : public ::testing::TestWithParam<size_t> {
 protected:
  Buffers() {
    const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
    glShaderSource(shader, 1, &kCopy, nullptr);
    glCompileShader(shader);
    glAttachShader(program_, shader);
    glLinkProgram(program_);
    glDeleteShader(shader);
    std::iota(numbers_.begin(), numbers_.end(), 1u);
  }
  ~Buffers() override { glDeleteProgram(program_); }
  std::vector<uint32_t> seenByAKernel(const Buffer<uint32_t>& buffer) const {
    const Buffer<uint32_t> out(buffer.size());
    glUseProgram(program_);
    buffer.bindStorage(0);
    out.bindStorage(1);
    Program::dispatch(buffer.size(), 64);
    Program::storageBarrier();
    return out.read();
  }

  Context context_;
  GLuint program_ = glCreateProgram();
  std::vector<uint32_t> numbers_ = std::vector<uint32_t>(GetParam());
  std::vector<uint32_t> zeros_ = std::vector<uint32_t>(GetParam(), 0u);
};
constexpr int kTimes = 20;  // timing of the engines varies, so an error may not show each time

TEST_P(Buffers, HoldWhatTheyAreMadeOf) {
  for (int i = 0; i < kTimes; ++i) {
    ASSERT_EQ(seenByAKernel(Buffer<uint32_t>(numbers_)), numbers_);
    ASSERT_EQ(seenByAKernel(Buffer<uint32_t>(GetParam())), zeros_);
  }
}

TEST_P(Buffers, HoldWhatIsWrittenIntoNewOnesAndAfterAClear) {
  for (int i = 0; i < kTimes; ++i) {
    Buffer<uint32_t> buffer(GetParam());
    buffer.write(numbers_);
    ASSERT_EQ(seenByAKernel(buffer), numbers_);
    buffer.clear();
    ASSERT_EQ(seenByAKernel(buffer), zeros_);
    buffer.clear();
    buffer.write(numbers_);
    ASSERT_EQ(seenByAKernel(buffer), numbers_);
  }
}

INSTANTIATE_TEST_SUITE_P(OfWords, Buffers, ::testing::Values(3, 64, 1000, 16384, 16385, 300000));

}  // namespace
}  // namespace viscera::gpu
