// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/g_buffer.h"

#include <string>

#include "gpu/gl.h"
#include "layout/seen.h"
#include "render/renderbuffer.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr int kSeenSamples = 2;  // per pixel along each axis

uint32_t makeFramebuffer() {
  uint32_t id = 0;
  glCreateFramebuffers(1, &id);
  gpu::countObject();
  return id;
}

bool isSeenComplete(uint32_t framebuffer) {
  return glCheckNamedFramebufferStatus(framebuffer, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

}  // namespace

uint32_t makeTexture(uint32_t format, int width, int height, uint32_t filter) {
  uint32_t id = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &id);
  gpu::countObject();
  glTextureStorage2D(id, 1, format, width, height);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
  glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return id;
}

GBuffer::GBuffer(int width, int height) : width_(width), height_(height) {
  const int columns = kSeenSamples * width, rows = kSeenSamples * height;
  positions_ = makeTexture(GL_RGBA32UI, columns, rows, GL_NEAREST);
  finishes_ = makeTexture(GL_RG32UI, columns, rows, GL_NEAREST);
  depths_ = makeTexture(GL_DEPTH_COMPONENT24, columns, rows, GL_NEAREST);
  over_color_ = makeTexture(GL_SRGB8_ALPHA8, columns, rows, GL_LINEAR);
  image_color_ = makeRenderbuffer(GL_SRGB8_ALPHA8, width, height);
  parts_ = makeRenderbuffer(GL_DEPTH_COMPONENT24, width, height);
  seen_ = makeFramebuffer();
  glNamedFramebufferTexture(seen_, GL_COLOR_ATTACHMENT0, positions_, 0);
  glNamedFramebufferTexture(seen_, GL_COLOR_ATTACHMENT1, finishes_, 0);
  glNamedFramebufferTexture(seen_, GL_DEPTH_ATTACHMENT, depths_, 0);
  const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glNamedFramebufferDrawBuffers(seen_, 2, both);
  over_ = makeFramebuffer();
  glNamedFramebufferTexture(over_, GL_COLOR_ATTACHMENT0, over_color_, 0);
  glNamedFramebufferTexture(over_, GL_DEPTH_ATTACHMENT, depths_, 0);
  image_ = makeFramebuffer();
  glNamedFramebufferRenderbuffer(image_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, image_color_);
  glNamedFramebufferRenderbuffer(image_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, parts_);
  const bool complete = isSeenComplete(seen_) && isSeenComplete(over_) && isSeenComplete(image_);
  const GLenum code = glGetError();
  if (complete && code == GL_NO_ERROR) return;
  remove();
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  throw GpuError("cannot create a framebuffer for an image of " + std::to_string(width) + " x " +
                 std::to_string(height) + " pixels; the driver accepts 1 to " + std::to_string(largest / kSeenSamples) +
                 " along each axis; " + gpu::glErrorText(code));
}

GBuffer::~GBuffer() {
  remove();
}

void GBuffer::remove() {
  const uint32_t framebuffers[] = {seen_, over_, image_}, textures[] = {positions_, finishes_, depths_, over_color_},
                 buffers[] = {image_color_, parts_};
  glDeleteFramebuffers(3, framebuffers);
  glDeleteTextures(4, textures);
  glDeleteRenderbuffers(2, buffers);
}

void GBuffer::bindSeen() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, seen_);
  glViewport(0, 0, kSeenSamples * width_, kSeenSamples * height_);
  const GLfloat farthest[] = {1};
  glClearBufferfv(GL_DEPTH, 0, farthest);
}

void GBuffer::bindImage() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, image_);
  glViewport(0, 0, width_, height_);
  glBindTextureUnit(layout::kUnitSeenDepths, depths_);
  glBindTextureUnit(layout::kUnitSeenPositions, positions_);
  glBindTextureUnit(layout::kUnitSeenFinishes, finishes_);
}

void GBuffer::bindOver() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, over_);
  glViewport(0, 0, kSeenSamples * width_, kSeenSamples * height_);
  const GLfloat nothing[] = {0, 0, 0, 0};
  glClearBufferfv(GL_COLOR, 0, nothing);
}

void GBuffer::readOver() const {
  glBindTextureUnit(layout::kUnitOver, over_color_);
}

void GBuffer::bindForReading() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, image_);
}

}  // namespace viscera
