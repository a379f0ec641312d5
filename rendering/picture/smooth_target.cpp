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
  refused_ = !pixels_.draw_into(drawn(viewport.width), drawn(viewport.height));
  if (!refused_) return;
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(viewport.x, viewport.y, viewport.width, viewport.height);
}

bool SmoothTarget::begin_still() { return !refused_ && still_.draw_into(pixels_.width(), pixels_.height()); }

void SmoothTarget::use_still() { still_.copy_to(pixels_); }

void SmoothTarget::end() {
  if (refused_) return;
  const Viewport& to = viewport_;
  const bool enlarged = filters() && (width() != to.width || height() != to.height);
  if (filters() && !enlarged) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    filter_edges(to);
    return;
  }
  if (enlarged && smoothed_.draw_into(width(), height())) filter_edges({0, 0, width(), height()});
  glBindFramebuffer(GL_READ_FRAMEBUFFER, enlarged ? smoothed_.framebuffer() : pixels_.framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  glBlitFramebuffer(0, 0, width(), height(), to.x, to.y, to.x + to.width, to.y + to.height, GL_COLOR_BUFFER_BIT,
                    enlarged ? GL_LINEAR : GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

// The first pass copies the picture and finds its edges; the second redraws the pixels at edges.
void SmoothTarget::filter_edges(const Viewport& to) const {
  glViewport(to.x, to.y, to.width, to.height);
  glBindTexture(GL_TEXTURE_2D, pixels_.colour());
  glBindVertexArray(no_vertices_);
  const auto draw = [&](const Shader& shader) {
    shader.use();
    shader.set("corner", glm::vec2(to.x, to.y));
    shader.set("steps", kSteps);
    glDrawArrays(GL_TRIANGLES, 0, 3);
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
  glBindVertexArray(0);
}

}  // namespace palpate
