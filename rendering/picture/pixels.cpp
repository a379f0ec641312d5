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
  glBindTexture(GL_TEXTURE_2D, colour_);
  // The order of colours of a window, so that a software renderer copies memory: it takes a tenth of the time of a
  // conversion. With the format GL_RGBA8, Mesa would choose an order of its own.
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, width_, height_, 0, GL_BGRA, GL_UNSIGNED_BYTE, nullptr);
  for (const GLenum filter : std::initializer_list<GLenum>{GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, filter, GL_LINEAR);
  for (const GLenum wrap : std::initializer_list<GLenum>{GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_, 0);
  if (!with_depth_) return;
  glBindRenderbuffer(GL_RENDERBUFFER, depth_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width_, height_);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
}

bool Pixels::draw_into(int width, int height) {
  const bool same = framebuffer_ != 0 && width == width_ && height == height_;
  width_ = width;
  height_ = height;
  if (!same) make();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width, height);
  return !same;
}

void Pixels::copy_to(const Pixels* other, const Viewport& from, const Viewport& to) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, other != nullptr ? other->framebuffer_ : 0);
  const bool same = from.width == to.width && from.height == to.height;
  const int low = other != nullptr ? to.y : to.y + to.height, high = other != nullptr ? to.y + to.height : to.y;
  glBlitFramebuffer(from.x, from.y, from.x + from.width, from.y + from.height, to.x, low, to.x + to.width, high,
                    GL_COLOR_BUFFER_BIT, same ? GL_NEAREST : GL_LINEAR);
}

}  // namespace palpate
