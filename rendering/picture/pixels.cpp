#include "rendering/picture/pixels.h"

#include <epoxy/gl.h>

#include <initializer_list>

namespace palpate {

void Pixels::release() {
  if (framebuffer_ == 0) return;
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &colour_);
  glDeleteRenderbuffers(1, &depth_);
  framebuffer_ = 0;
}

void Pixels::make() {
  release();
  glGenFramebuffers(1, &framebuffer_);
  glGenTextures(1, &colour_);
  glGenRenderbuffers(1, &depth_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  const GLenum kind = samples_ > 0 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D;
  glBindTexture(kind, colour_);
  if (samples_ > 0) {
    glTexImage2DMultisample(kind, samples_, GL_RGBA8, width_, height_, GL_TRUE);
  } else {
    // The order of colours of a window, so that a software renderer copies memory without converting it.
    glTexImage2D(kind, 0, GL_RGBA8, width_, height_, 0, GL_BGRA, GL_UNSIGNED_BYTE, nullptr);
    for (const int filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      glTexParameteri(kind, static_cast<GLenum>(filter), GL_LINEAR);
    for (const int wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
      glTexParameteri(kind, static_cast<GLenum>(wrap), GL_CLAMP_TO_EDGE);
  }
  glBindRenderbuffer(GL_RENDERBUFFER, depth_);
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_, GL_DEPTH_COMPONENT24, width_, height_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, kind, colour_, 0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
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
