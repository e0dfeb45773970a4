// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/render_target.h"

#include <cassert>
#include <string>
#include <utility>

#include "gpu/gl.h"
#include "render/renderbuffer.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

uint32_t makeFramebuffer(uint32_t color, uint32_t depth) {
  uint32_t id = 0;
  glCreateFramebuffers(1, &id);
  gpu::countObject();
  glNamedFramebufferRenderbuffer(id, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
  if (depth) glNamedFramebufferRenderbuffer(id, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  return id;
}

bool isComplete(uint32_t framebuffer) {
  return glCheckNamedFramebufferStatus(framebuffer, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

}  // namespace

RenderTarget::RenderTarget(int width, int height, int supersampling) : RenderTarget() {
  assert(supersampling == 1 || supersampling == 2);  // a linear blit averages 2 x 2 pixels, no more
  width_ = width;
  height_ = height;
  supersampling_ = supersampling;
  drawn_color_ = makeRenderbuffer(GL_SRGB8_ALPHA8, supersampling * width, supersampling * height);
  drawn_depth_ = makeRenderbuffer(GL_DEPTH_COMPONENT24, supersampling * width, supersampling * height);
  drawn_ = makeFramebuffer(drawn_color_, drawn_depth_);
  bool complete = isComplete(drawn_);
  if (supersampling > 1) {
    image_color_ = makeRenderbuffer(GL_SRGB8_ALPHA8, width, height);
    image_ = makeFramebuffer(image_color_, 0);
    complete = complete && isComplete(image_);
  }
  const GLenum code = glGetError();
  if (complete && code == GL_NO_ERROR) return;
  GLint largest = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  throw GpuError("cannot create a framebuffer for an image of " + std::to_string(width) + " x " +
                 std::to_string(height) + " pixels; the driver accepts 1 to " +
                 std::to_string(largest / supersampling) + " along each axis; " + gpu::glErrorText(code));
}

RenderTarget::~RenderTarget() {
  for (uint32_t framebuffer : {drawn_, image_}) {
    if (framebuffer) glDeleteFramebuffers(1, &framebuffer);
  }
  for (uint32_t buffer : {drawn_color_, drawn_depth_, image_color_}) {
    if (buffer) glDeleteRenderbuffers(1, &buffer);
  }
}

RenderTarget::RenderTarget(RenderTarget&& other) noexcept : RenderTarget() {
  *this = std::move(other);
}

RenderTarget& RenderTarget::operator=(RenderTarget&& other) noexcept {
  std::swap(drawn_, other.drawn_);
  std::swap(drawn_color_, other.drawn_color_);
  std::swap(drawn_depth_, other.drawn_depth_);
  std::swap(image_, other.image_);
  std::swap(image_color_, other.image_color_);
  std::swap(width_, other.width_);
  std::swap(height_, other.height_);
  std::swap(supersampling_, other.supersampling_);
  return *this;
}

void RenderTarget::bindForDrawing() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, drawn_);
  glViewport(0, 0, supersampling_ * width_, supersampling_ * height_);
}

void RenderTarget::resolve() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, drawn_);
  if (image_) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, image_);
    glBlitFramebuffer(0, 0, supersampling_ * width_, supersampling_ * height_, 0, 0, width_, height_,
                      GL_COLOR_BUFFER_BIT, GL_LINEAR);
  }
  bindForReading();
}

void RenderTarget::bindForReading() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, image_ ? image_ : drawn_);
}

}  // namespace viscera
