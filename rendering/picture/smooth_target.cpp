#include "rendering/picture/smooth_target.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace palpate {
namespace {

constexpr int kSamples = 4;
// It grows in steps, so that a tool that moves does not make it anew in every frame.
constexpr int kStep_px = 128;

int in_steps(int pixels) { return (pixels + kStep_px - 1) / kStep_px * kStep_px; }

}  // namespace

SmoothTarget::~SmoothTarget() { release(); }

void SmoothTarget::release() {
  if (framebuffer_ != 0) glDeleteFramebuffers(1, &framebuffer_);
  if (buffers_[0] != 0) glDeleteRenderbuffers(2, buffers_);
  framebuffer_ = buffers_[0] = buffers_[1] = 0;
}

bool SmoothTarget::resize(int width, int height) {
  width_ = std::max(width_, in_steps(width));
  height_ = std::max(height_, in_steps(height));
  release();
  glGenFramebuffers(1, &framebuffer_);
  glGenRenderbuffers(2, buffers_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  const GLenum formats[2] = {GL_RGBA8, GL_DEPTH_COMPONENT24};
  const GLenum places[2] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
  for (int i = 0; i < 2; ++i) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffers_[i]);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, kSamples, formats[i], width_, height_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, places[i], GL_RENDERBUFFER, buffers_[i]);
  }
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

bool SmoothTarget::begin(unsigned source, int at_x, int at_y, const Viewport& part) {
  if (refused_) return false;
  if ((part.width > width_ || part.height > height_ || framebuffer_ == 0) && !resize(part.width, part.height)) {
    refused_ = true;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return false;
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, source);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  glBlitFramebuffer(at_x, at_y, at_x + part.width, at_y + part.height, 0, 0, part.width, part.height,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, part.width, part.height);
  glClear(GL_DEPTH_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
  return true;
}

void SmoothTarget::end(unsigned target, const Viewport& part) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
  glBlitFramebuffer(0, 0, part.width, part.height, part.x, part.y, part.x + part.width, part.y + part.height,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, target);
}

}  // namespace palpate
