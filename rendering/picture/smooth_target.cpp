#include "rendering/picture/smooth_target.h"

#include <epoxy/gl.h>

namespace palpate {
namespace {

constexpr int kSamples = 4;

}  // namespace

void SmoothTarget::release() {
  if (buffers_[0] == 0) return;
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteRenderbuffers(2, buffers_);
  framebuffer_ = 0;
}

bool SmoothTarget::make() {
  release();
  glGenFramebuffers(1, &framebuffer_);
  glGenRenderbuffers(2, buffers_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  constexpr GLenum kFormats[2] = {GL_RGBA8, GL_DEPTH_COMPONENT24};
  constexpr GLenum kPlaces[2] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
  for (int i = 0; i < 2; ++i) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffers_[i]);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, kSamples, kFormats[i], viewport_.width, viewport_.height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, kPlaces[i], GL_RENDERBUFFER, buffers_[i]);
  }
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

void SmoothTarget::begin(const Viewport& viewport) {
  const bool same = buffers_[0] != 0 && viewport.width == viewport_.width && viewport.height == viewport_.height;
  viewport_ = viewport;
  if (!same && !make()) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer_);
    framebuffer_ = 0;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(framebuffer_ == 0 ? viewport.x : 0, framebuffer_ == 0 ? viewport.y : 0, viewport.width, viewport.height);
}

void SmoothTarget::end() const {
  if (framebuffer_ == 0) return;
  const Viewport& to = viewport_;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, to.width, to.height, to.x, to.y, to.x + to.width, to.y + to.height, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace palpate
