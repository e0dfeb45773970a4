// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/gw/gw_blend.h"

#include <GL/glew.h>

#include <cmath>
#include <utility>

#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

namespace viscera::bench {

namespace {

constexpr double kFixedZero = 128.0 / 255;

GLenum internalFormat(BlendFormat format) {
  switch (format) {
    case BlendFormat::kFixed8:
      return GL_RGBA8;
    case BlendFormat::kFloat16:
      return GL_RGBA16F;
    default:
      return GL_RGBA32F;
  }
}

}  // namespace

TexelArray::TexelArray(uint32_t buffer, uint32_t format) {
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &id_);
  glTextureBuffer(id_, format, buffer);
  gpu::checkErrors("a buffer as a texture");
}

TexelArray::~TexelArray() {
  if (id_) glDeleteTextures(1, &id_);
}

TexelArray::TexelArray(TexelArray&& other) noexcept : id_(std::exchange(other.id_, 0)) {}

TexelArray& TexelArray::operator=(TexelArray&& other) noexcept {
  std::swap(id_, other.id_);
  return *this;
}

void TexelArray::bind(uint32_t unit) const {
  glBindTextureUnit(unit, id_);
}

const char* nameOf(BlendFormat format) {
  switch (format) {
    case BlendFormat::kFixed8:
      return "8 bit fixed";
    case BlendFormat::kFloat16:
      return "16 bit float";
    default:
      return "32 bit float";
  }
}

double scaleOf(double largest_sum_n) {
  return std::exp2(1 + std::ceil(std::log2(largest_sum_n)));
}

BlendTarget::BlendTarget(BlendFormat format, size_t slots, double scale_n)
    : format_(format),
      slots_(slots),
      scale_n_(scale_n),
      width_(static_cast<uint32_t>(std::ceil(std::sqrt(static_cast<double>(slots))))),
      height_(static_cast<uint32_t>((slots + width_ - 1) / width_)),
      program_(gpu::Program::graphics("gw_scatter.vert", "gw_scatter.frag")) {
  glCreateVertexArrays(1, &vertices_);
  glCreateTextures(GL_TEXTURE_2D, 1, &texture_);
  glTextureStorage2D(texture_, 1, internalFormat(format), static_cast<GLsizei>(width_), static_cast<GLsizei>(height_));
  glTextureParameteri(texture_, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glCreateFramebuffers(1, &framebuffer_);
  glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT0, texture_, 0);
  if (glCheckNamedFramebufferStatus(framebuffer_, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return;
  throw GpuError(std::string("no framebuffer of ") + nameOf(format) + " to blend into");
}

BlendTarget::~BlendTarget() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &texture_);
  glDeleteVertexArrays(1, &vertices_);
}

double BlendTarget::zero() const {
  return format_ == BlendFormat::kFixed8 ? kFixedZero : 0;
}

void BlendTarget::bindTexture(uint32_t unit) const {
  glBindTextureUnit(unit, texture_);
}

void BlendTarget::draw(size_t springs, uint32_t end, double sign) const {
  const double at_end = end == 0 ? 1 : -1;  // the forces on both ends are opposite
  program_.set("end", end);
  program_.set("factor", static_cast<float>(at_end * sign / scale_n_));
  glBlendEquation(sign > 0 ? GL_FUNC_ADD : GL_FUNC_REVERSE_SUBTRACT);
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(springs));
}

void BlendTarget::add(size_t springs) {
  const auto zero = static_cast<float>(this->zero());
  const float clear[] = {zero, zero, zero, 0};
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, static_cast<GLsizei>(width_), static_cast<GLsizei>(height_));
  glClearBufferfv(GL_COLOR, 0, clear);
  glBindVertexArray(vertices_);
  program_.use();
  program_.set("size", width_, height_);
  glEnable(GL_BLEND);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glBlendFunc(GL_ONE, GL_ONE);
  for (uint32_t end : {0u, 1u}) {
    draw(springs, end, 1);
    // Fixed point has no negative colours: they were drawn as 0 and are now subtracted as positive ones.
    if (format_ == BlendFormat::kFixed8) draw(springs, end, -1);
  }
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_PROGRAM_POINT_SIZE);
  glDisable(GL_BLEND);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
}

Field BlendTarget::forces() const {
  std::vector<float> values(size_t{4} * width_ * height_);
  glGetTextureImage(texture_, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(values.size() * sizeof(float)), values.data());
  Field out;
  for (size_t i = 0; i < slots_; ++i) {
    const Vector3d value(values[4 * i], values[4 * i + 1], values[4 * i + 2]);
    out.push_back(scale_n_ * (value - Vector3d::Constant(zero())));
  }
  return out;
}

}  // namespace viscera::bench
