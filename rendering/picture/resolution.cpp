#include "rendering/picture/smooth_target.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <utility>

namespace palpate {
namespace {

constexpr int kSamples = 4;
// Steps of the search along an edge in both directions; the flattest edge that it finds rises by one pixel in 26.
constexpr int kSteps = 8;

// The constants of Resolution.
constexpr float kScales[] = {1.0F, 0.82F, Resolution::kLeast};  // each has two thirds of the pixels of the one before
constexpr double kFrame_s = 1.0 / 60.0;
constexpr int kFrames = 60;                  // frames of a mean
constexpr double kStall_s = 2.0 * kFrame_s;  // longer frames count as this, so that one of them has no effect
constexpr double kLate = 0.97, kRoom = 0.90;
// A larger picture must fit for this many means, so that the resolution does not alternate.
constexpr int kGood = 5;

// Appends the parts of `a` outside of `b`: at most four.
void append_outside(const Viewport& a, const Viewport& b, std::vector<Viewport>& to) {
  const int left = std::max(a.x, b.x), right = std::min(a.x + a.width, b.x + b.width);
  const int low = std::max(a.y, b.y), high = std::min(a.y + a.height, b.y + b.height);
  if (left >= right || low >= high) {
    to.push_back(a);
    return;
  }
  for (const Viewport& part :
       {Viewport{a.x, a.y, a.width, low - a.y}, Viewport{a.x, high, a.width, a.y + a.height - high},
        Viewport{a.x, low, left - a.x, high - low}, Viewport{right, low, a.x + a.width - right, high - low}}) {
    if (part.width > 0 && part.height > 0) to.push_back(part);
  }
}

// The same pixels in parts that do not overlap, so that each pixel is copied and filtered once.
std::vector<Viewport> disjoint(const std::vector<Viewport>& parts) {
  std::vector<Viewport> all;
  for (const Viewport& part : parts) {
    std::vector<Viewport> rest{part};
    for (const Viewport& taken : all) {
      std::vector<Viewport> left;
      for (const Viewport& one : rest) append_outside(one, taken, left);
      rest = std::move(left);
    }
    all.insert(all.end(), rest.begin(), rest.end());
  }
  return all;
}

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

SmoothTarget::SmoothTarget(std::optional<EdgeFilter> filter)
    : filter_(std::move(filter)), pixels_(filter_ ? 0 : kSamples), still_(0), smoothed_(0), enlarged_(0) {
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
  pixels_.draw_into(width, height);
  if (!filters()) return;
  still_.draw_into(width, height);
  smoothed_.draw_into(width, height);
  if (is_enlarged()) enlarged_.draw_into(viewport.width, viewport.height);
}

void SmoothTarget::begin_still() { still_.draw_into(width(), height()); }

void SmoothTarget::end_still() {
  const Viewport whole{0, 0, width(), height()};
  filter_edges(still_, {whole});
  still_.copy_to(pixels_, whole);
  drawn_.clear();
  enlarge({whole});
}

void SmoothTarget::use_still(std::vector<Viewport> parts) {
  parts_ = parts;
  if (parts.size() == drawn_.size()) {
    std::transform(parts.begin(), parts.end(), drawn_.begin(), parts_.begin(), around_both);
  } else {
    parts_.insert(parts_.end(), drawn_.begin(), drawn_.end());
  }
  drawn_ = std::move(parts);
  parts_ = disjoint(parts_);
  for (const Viewport& part : parts_) still_.copy_to(pixels_, part);
  pixels_.draw_into(width(), height());
}

void SmoothTarget::end() {
  if (filters()) filter_edges(pixels_, parts_);
  enlarge(parts_);
  const Viewport& to = viewport_;
  const Pixels& picture = !filters() ? pixels_ : is_enlarged() ? enlarged_ : smoothed_;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, picture.framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  // In memory the first row of a window is the upper one. The filtered picture has the same order, so that a software
  // renderer copies it as it is.
  const int bottom = filters() ? to.height : 0, top = to.height - bottom;
  glBlitFramebuffer(0, bottom, to.width, top, to.x, to.y, to.x + to.width, to.y + to.height, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

bool SmoothTarget::is_enlarged() const noexcept {
  return filters() && (width() != viewport_.width || height() != viewport_.height);
}

// Interpolation is slow with a software renderer, so only the parts that have changed are enlarged.
void SmoothTarget::enlarge(const std::vector<Viewport>& parts) {
  if (!is_enlarged()) return;
  const int wide = viewport_.width, high = viewport_.height;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, smoothed_.framebuffer());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, enlarged_.framebuffer());
  glEnable(GL_SCISSOR_TEST);
  for (const Viewport& part : parts) {
    // With a margin of two pixels, into which the outermost pixels are interpolated.
    const int left = part.x * wide / width() - 2, right = (part.x + part.width) * wide / width() + 2;
    const int low = (height() - part.y - part.height) * high / height() - 2;
    const int top = (height() - part.y) * high / height() + 2;
    glScissor(left, low, right - left, top - low);
    glBlitFramebuffer(0, 0, width(), height(), 0, 0, wide, high, GL_COLOR_BUFFER_BIT, GL_LINEAR);
  }
  glDisable(GL_SCISSOR_TEST);
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

float Resolution::scale() const noexcept { return kScales[step_]; }

void Resolution::add(double busy_s) noexcept {
  busy_s_ += std::min(busy_s, kStall_s);
  if (++frames_ < kFrames) return;
  const double mean_s = busy_s_ / frames_;
  frames_ = 0;
  busy_s_ = 0.0;
  if (mean_s > kLate * kFrame_s) {
    step_ = std::min(step_ + 1, static_cast<int>(std::size(kScales)) - 1);
    good_ = 0;
    return;
  }
  if (step_ == 0) return;
  // The time of a larger picture, if all of it is proportional to the pixels.
  const float more = kScales[step_ - 1] / kScales[step_];
  good_ = mean_s * static_cast<double>(more * more) < kRoom * kFrame_s ? good_ + 1 : 0;
  if (good_ < kGood) return;
  --step_;
  good_ = 0;
}

}  // namespace palpate
