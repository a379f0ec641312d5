#include "rendering/picture/pixels.h"

#include <epoxy/gl.h>

#include <initializer_list>

namespace palpate {

void Pixels::release() {
  if (framebuffer_ == 0) return;
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &colour_);
  glDeleteRenderbuffers(2, buffers_);
  framebuffer_ = 0;
}

void Pixels::make() {
  release();
  glGenFramebuffers(1, &framebuffer_);
  glGenTextures(1, &colour_);
  glGenRenderbuffers(2, buffers_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  const auto attach_buffer = [&](GLenum attachment, unsigned buffer, GLenum format) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_, format, width_, height_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, attachment, GL_RENDERBUFFER, buffer);
  };
  if (samples_ > 0) {
    attach_buffer(GL_COLOR_ATTACHMENT0, buffers_[0], GL_RGBA8);
  } else {
    glBindTexture(GL_TEXTURE_2D, colour_);
    // The order of colours of a window, so that a software renderer copies memory without converting it.
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_, height_, 0, GL_BGRA, GL_UNSIGNED_BYTE, nullptr);
    for (const GLenum filter : std::initializer_list<GLenum>{GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
    for (const GLenum wrap : std::initializer_list<GLenum>{GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
      glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_, 0);
  }
  attach_buffer(GL_DEPTH_ATTACHMENT, buffers_[1], GL_DEPTH_COMPONENT24);
}

void Pixels::draw_into(int width, int height) {
  const bool same = framebuffer_ != 0 && width == width_ && height == height_;
  width_ = width;
  height_ = height;
  if (!same) make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width, height);
}

void Pixels::copy_to(const Pixels& other, const Viewport& part) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, other.framebuffer_);
  const int right = part.x + part.width, top = part.y + part.height;
  glBlitFramebuffer(part.x, part.y, right, top, part.x, part.y, right, top, GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT,
                    GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, other.framebuffer_);
}

}  // namespace palpate
