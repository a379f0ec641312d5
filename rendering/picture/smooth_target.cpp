#include "rendering/picture/smooth_target.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

constexpr int kSamples = 4;
// Steps of the search along an edge in both directions; the flattest edge that it finds rises by one pixel in 26.
constexpr int kSteps = 8;

Viewport around_both(const Viewport& a, const Viewport& b) {
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

}  // namespace

Smoothing smoothing_for(std::string_view renderer) noexcept {
  // The software renderers of Mesa (three), Microsoft and Apple.
  for (const std::string_view program : {"llvmpipe", "softpipe", "SWR", "GDI Generic", "Software"}) {
    if (renderer.find(program) != std::string_view::npos) return Smoothing::filter;
  }
  return Smoothing::samples;
}

SmoothTarget::SmoothTarget(std::optional<EdgeFilter> filter)
    : filter_(std::move(filter)), pixels_(filter_ ? 0 : kSamples), still_(0), smoothed_(0) {
  glGenVertexArrays(1, &no_vertices_);
}

SmoothTarget::~SmoothTarget() { glDeleteVertexArrays(1, &no_vertices_); }

void SmoothTarget::begin(const Viewport& viewport, float scale) {
  viewport_ = viewport;
  const float part = filters() ? scale : 1.0F;
  const auto drawn = [part](int size) {
    return std::max(1, static_cast<int>(std::round(part * static_cast<float>(size))));
  };
  const int width = drawn(viewport.width), height = drawn(viewport.height);
  refused_ = filters() && !(still_.draw_into(width, height) && smoothed_.draw_into(width, height));
  refused_ = !pixels_.draw_into(width, height) || refused_;
  if (!refused_) return;
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(viewport.x, viewport.y, viewport.width, viewport.height);
}

void SmoothTarget::begin_still() { still_.draw_into(width(), height()); }

void SmoothTarget::end_still() {
  const Viewport whole{0, 0, width(), height()};
  filter_edges(still_, {whole});
  still_.copy_to(pixels_, whole);
  drawn_.clear();
}

void SmoothTarget::use_still(std::vector<Viewport> parts) {
  parts_ = parts;
  if (parts.size() == drawn_.size()) {
    std::transform(parts.begin(), parts.end(), drawn_.begin(), parts_.begin(), around_both);
  } else {
    parts_.insert(parts_.end(), drawn_.begin(), drawn_.end());
  }
  drawn_ = std::move(parts);
  for (const Viewport& part : parts_) still_.copy_to(pixels_, part);
  pixels_.draw_into(width(), height());
}

void SmoothTarget::end() {
  if (refused_) return;
  if (filters()) filter_edges(pixels_, parts_);
  const Viewport& to = viewport_;
  const bool enlarged = width() != to.width || height() != to.height;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, filters() ? smoothed_.framebuffer() : pixels_.framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  // In memory the first row of a window is the upper one. The filtered picture has the same order, so that a software
  // renderer copies it as it is.
  const int bottom = filters() ? height() : 0, top = height() - bottom;
  glBlitFramebuffer(0, bottom, width(), top, to.x, to.y, to.x + to.width, to.y + to.height, GL_COLOR_BUFFER_BIT,
                    enlarged ? GL_LINEAR : GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

// The first pass copies the picture and finds its edges; the second redraws the pixels at edges.
void SmoothTarget::filter_edges(const Pixels& picture, const std::vector<Viewport>& parts) {
  smoothed_.draw_into(width(), height());
  glBindTexture(GL_TEXTURE_2D, picture.colour());
  glBindVertexArray(no_vertices_);
  glEnable(GL_SCISSOR_TEST);
  const auto draw = [&](const Shader& shader) {
    shader.use();
    shader.set("steps", kSteps);
    for (const Viewport& part : parts) {
      glScissor(part.x, height() - part.y - part.height, part.width, part.height);
      glDrawArrays(GL_TRIANGLES, 0, 3);
    }
  };
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS);
  draw(filter_->find);
  // The first pass wrote the depth: the triangle, at half depth, is drawn at the edges only.
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  draw(filter_->smooth);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LESS);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
  glBindVertexArray(0);
}

}  // namespace palpate
