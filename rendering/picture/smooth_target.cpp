#include "rendering/picture/smooth_target.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace palpate {
namespace {

constexpr int kSamples = 4;
// It grows in steps, so that a tool that moves does not make it anew in every frame.
constexpr int kStep_px = 128;

int in_steps(int pixels) { return (pixels + kStep_px - 1) / kStep_px * kStep_px; }

// The parts from one framebuffer to another, each with its lower left corner in the window.
void copy_parts(unsigned from, int from_x, int from_y, unsigned to, int to_x, int to_y,
                std::span<const Viewport> parts) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
  for (const Viewport& part : parts) {
    const int x = part.x - from_x;
    const int y = part.y - from_y;
    const int at_x = part.x - to_x;
    const int at_y = part.y - to_y;
    glBlitFramebuffer(x, y, x + part.width, y + part.height, at_x, at_y, at_x + part.width, at_y + part.height,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
}

}  // namespace

void SmoothTarget::Samples::release() {
  if (framebuffer != 0) glDeleteFramebuffers(1, &framebuffer);
  if (buffers[0] != 0) glDeleteRenderbuffers(2, buffers);
  framebuffer = buffers[0] = buffers[1] = 0;
}

bool SmoothTarget::Samples::make(int its_width, int its_height, bool with_depth) {
  width = its_width;
  height = its_height;
  release();
  glGenFramebuffers(1, &framebuffer);
  glGenRenderbuffers(2, buffers);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  const GLenum formats[2] = {GL_RGBA8, GL_DEPTH_COMPONENT24};
  const GLenum places[2] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
  for (int i = 0; i < (with_depth ? 2 : 1); ++i) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffers[i]);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, kSamples, formats[i], width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, places[i], GL_RENDERBUFFER, buffers[i]);
  }
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

bool SmoothTarget::begin_from(unsigned framebuffer, int x, int y, const Viewport& whole,
                              std::span<const Viewport> parts) {
  if (refused_) return false;
  const bool fits = drawn_.framebuffer != 0 && whole.width <= drawn_.width && whole.height <= drawn_.height;
  if (!fits && !drawn_.make(std::max(drawn_.width, in_steps(whole.width)),
                            std::max(drawn_.height, in_steps(whole.height)), true)) {
    refused_ = true;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return false;
  }
  copy_parts(framebuffer, x, y, drawn_.framebuffer, whole.x, whole.y, parts);
  glBindFramebuffer(GL_FRAMEBUFFER, drawn_.framebuffer);
  // All of it: a part would be cleared by drawing a rectangle.
  glClear(GL_DEPTH_BUFFER_BIT);
  return true;
}

bool SmoothTarget::begin(unsigned framebuffer, const Viewport& whole, std::span<const Viewport> parts) {
  return begin_from(framebuffer, 0, 0, whole, parts);
}

bool SmoothTarget::begin_with_kept(const Viewport& whole, std::span<const Viewport> parts) {
  return kept_.framebuffer != 0 && begin_from(kept_.framebuffer, kept_x_, kept_y_, whole, parts);
}

void SmoothTarget::end(unsigned framebuffer, const Viewport& whole, std::span<const Viewport> parts) const {
  copy_parts(drawn_.framebuffer, whole.x, whole.y, framebuffer, 0, 0, parts);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

void SmoothTarget::keep(unsigned framebuffer, const Viewport& place) {
  const bool fits = kept_.framebuffer != 0 && place.width == kept_.width && place.height == kept_.height;
  if (!fits && !kept_.make(place.width, place.height, false)) kept_.release();
  kept_x_ = place.x;
  kept_y_ = place.y;
  if (kept_.framebuffer != 0)
    copy_parts(framebuffer, place.x, place.y, kept_.framebuffer, place.x, place.y, {&place, 1});
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace palpate
