// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/geometry_target.h"

#include <string>

#include "gpu/gl.h"
#include "render/renderbuffer.h"
#include "viscera/math/error.h"

namespace viscera {

GeometryTarget::GeometryTarget(int width, int height)
    : width_(width),
      height_(height),
      depths_(makeRenderbuffer(GL_R32F, width, height)),
      labels_(makeRenderbuffer(GL_R8UI, width, height)),
      depth_buffer_(makeRenderbuffer(GL_DEPTH_COMPONENT24, width, height)) {
  glCreateFramebuffers(1, &framebuffer_);
  gpu::countObject();
  glNamedFramebufferRenderbuffer(framebuffer_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, depths_);
  glNamedFramebufferRenderbuffer(framebuffer_, GL_COLOR_ATTACHMENT1, GL_RENDERBUFFER, labels_);
  glNamedFramebufferRenderbuffer(framebuffer_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_buffer_);
  const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glNamedFramebufferDrawBuffers(framebuffer_, 2, both);
  const bool complete = glCheckNamedFramebufferStatus(framebuffer_, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  const GLenum code = glGetError();
  if (complete && code == GL_NO_ERROR) return;
  throw GpuError("cannot create a framebuffer for depths and labels of " + std::to_string(width) + " x " +
                 std::to_string(height) + " pixels: " + gpu::glErrorText(code));
}

GeometryTarget::~GeometryTarget() {
  glDeleteFramebuffers(1, &framebuffer_);
  for (uint32_t buffer : {depths_, labels_, depth_buffer_}) glDeleteRenderbuffers(1, &buffer);
}

void GeometryTarget::bindEmpty() const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_, height_);
  const GLfloat no_depth[] = {0, 0, 0, 0}, farthest[] = {1};
  const GLuint no_label[] = {0, 0, 0, 0};
  glClearBufferfv(GL_COLOR, 0, no_depth);
  glClearBufferuiv(GL_COLOR, 1, no_label);
  glClearBufferfv(GL_DEPTH, 0, farthest);
}

void GeometryTarget::bindDepths() const {
  glNamedFramebufferReadBuffer(framebuffer_, GL_COLOR_ATTACHMENT0);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
}

void GeometryTarget::bindLabels() const {
  glNamedFramebufferReadBuffer(framebuffer_, GL_COLOR_ATTACHMENT1);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
}

}  // namespace viscera
