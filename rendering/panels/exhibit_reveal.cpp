#include "rendering/panels/exhibit_reveal.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "engine/base/text.h"

namespace palpate {
namespace {

// In columns: the longest parts of the press before and after the largest difference that are shown, and the approach
// before it.
constexpr std::size_t kBefore = static_cast<std::size_t>(1.0 / ExhibitTrace::kColumn_s);
constexpr std::size_t kAfter = static_cast<std::size_t>(0.6 / ExhibitTrace::kColumn_s);
constexpr std::size_t kApproach = static_cast<std::size_t>(0.15 / ExhibitTrace::kColumn_s);
constexpr double kBack = 0.25 / ExhibitTrace::kColumn_s;  // duration of the motion back to the largest difference

bool is_pressed(const ExhibitTrace::Column& column) { return column.ticks > 0 && column.position_m > 0.0; }

void draw_force_arrow(ImDrawList& list, const ImVec2& foot, float length, float width, ImU32 colour) {
  const float head = std::min(1.1F * width, length);
  list.AddRectFilled({foot.x - 0.3F * width, foot.y - length + head}, {foot.x + 0.3F * width, foot.y}, colour);
  list.AddTriangleFilled({foot.x, foot.y - length}, {foot.x + 0.75F * width, foot.y - length + head},
                         {foot.x - 0.75F * width, foot.y - length + head}, colour);
}

}  // namespace

void ExhibitReveal::start(const ExhibitTrace& trace, const JndLine& jnd, double slowness, double now_s) {
  jnd_ = jnd;
  slowness_ = slowness;
  began_s_ = now_s;
  moments_.assign(1, {});
  largest_at_ = 0;
  const std::vector<Moment>& columns = trace.columns();
  if (columns.empty()) return;
  std::size_t first = trace.largest_at();
  std::size_t last = first;
  const std::size_t largest = first;
  while (first > 0 && largest - first < kBefore && is_pressed(columns[first - 1])) --first;
  while (last + 1 < columns.size() && last - largest < kAfter && is_pressed(columns[last + 1])) ++last;
  for (std::size_t i = 0; i < kApproach && first > 0 && columns[first - 1].ticks > 0; ++i) --first;
  moments_.assign(columns.begin() + static_cast<std::ptrdiff_t>(first),
                  columns.begin() + static_cast<std::ptrdiff_t>(last + 1));
  largest_at_ = largest - first;
}

double ExhibitReveal::columns_since_start(double now_s) const noexcept {
  return (now_s - began_s_) / slowness_ / ExhibitTrace::kColumn_s;
}

double ExhibitReveal::way_back(double now_s) const noexcept {
  const double share = std::clamp((columns_since_start(now_s) - end()) / kBack, 0.0, 1.0);
  return share * share * (3.0 - 2.0 * share);
}

double ExhibitReveal::playhead(double now_s) const noexcept {
  const double pressed = columns_since_start(now_s);
  if (pressed < end()) return std::max(0.0, pressed);
  return std::lerp(end(), static_cast<double>(largest_at_), way_back(now_s));
}

bool ExhibitReveal::done(double now_s) const noexcept { return columns_since_start(now_s) >= end() + kBack; }

ExhibitReveal::Moment ExhibitReveal::at(double now_s) const noexcept {
  const double at = playhead(now_s);
  const auto below = static_cast<std::size_t>(at);
  const Moment& above = moments_[std::min(below + 1, moments_.size() - 1)];
  const double share = at - static_cast<double>(below);
  Moment moment = moments_[below];
  moment.position_m = std::lerp(moment.position_m, above.position_m, share);
  moment.first_N = std::lerp(moment.first_N, above.first_N, share);
  moment.over_jnd = std::lerp(moment.over_jnd, above.over_jnd, share);
  return moment;
}

double ExhibitReveal::second_N(const Moment& moment) const noexcept {
  return moment.first_N + moment.over_jnd * jnd_.at(moment.first_N);
}

double ExhibitReveal::highest_N(const Moment& moment) const noexcept {
  return std::max(moment.first_N + jnd_.at(moment.first_N), second_N(moment));
}

void ExhibitReveal::draw_arrows(const UiStyle& style, const SceneArea& area, double now_s, const Rgb& first,
                                const Rgb& second, bool first_is_left) const {
  const Moment moment = at(now_s);
  double press_N = 0.1;
  for (const Moment& one : moments_) press_N = std::max(press_N, highest_N(one));
  const double still_N = std::max(0.1, highest_N(moments_[largest_at_]));
  // During the motion back the present arrows may be higher than both.
  const double most_N = std::max(std::lerp(press_N, still_N, way_back(now_s)), highest_N(moment));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float px_per_N = area.size.y / static_cast<float>(most_N);
  const float ground = area.at.y + area.size.y;
  const auto height = [&](double force_N) { return px_per_N * static_cast<float>(std::max(0.0, force_N)); };
  const double jnd_N = jnd_.at(moment.first_N);
  const ImVec2 corner(area.at.x, ground - height(moment.first_N + jnd_N));
  const ImVec2 other(area.at.x + area.size.x, ground - height(moment.first_N - jnd_N));
  list.AddRectFilled(corner, other, ink(style.colours().band));
  list.AddRect(corner, other, ink(style.colours().edge));
  const float thick = 3.0F * style.scale();
  const float width = 0.11F * area.size.x;
  const float left = area.at.x + 0.25F * area.size.x, right = area.at.x + 0.75F * area.size.x;
  const ImVec2 first_tip(first_is_left ? left : right, ground - height(moment.first_N));
  const ImVec2 second_tip(first_is_left ? right : left, ground - height(second_N(moment)));
  draw_force_arrow(list, {first_tip.x, ground}, ground - first_tip.y, width, ink(first));
  draw_force_arrow(list, {second_tip.x, ground}, ground - second_tip.y, width, ink(second));
  // The forces in newtons, above the tips.
  for (const auto& [tip, force_N, colour] : {std::tuple(first_tip, moment.first_N, first),
                                             std::tuple(second_tip, std::max(0.0, second_N(moment)), second)}) {
    const std::string text = fixed(force_N, 1) + " N";
    const float wide = ImGui::CalcTextSize(text.c_str()).x;
    const float y = std::max(area.at.y - 1.1F * ImGui::GetFontSize(), tip.y - 1.2F * ImGui::GetFontSize());
    list.AddText({tip.x - 0.5F * wide, y}, ink(text_colour(colour, style.theme())), text.c_str());
  }
  // The difference between the tips, in the colour of errors above one JND where it leaves the band.
  const bool above = std::abs(moment.over_jnd) > 1.0;
  const float middle = 0.5F * (left + right);
  const float half = 4.0F * thick;
  list.AddRectFilled({middle - half, std::min(first_tip.y, second_tip.y)},
                     {middle + half, std::max(first_tip.y, second_tip.y)},
                     ink(above ? kAboveJndColour : style.colours().quiet));
  list.AddLine(first_tip, {middle, first_tip.y}, ink(first), thick);
  list.AddLine({middle, second_tip.y}, second_tip, ink(second), thick);
  list.AddLine({area.at.x, ground}, {area.at.x + area.size.x, ground}, ink(style.colours().quiet), thick);
}

}  // namespace palpate
