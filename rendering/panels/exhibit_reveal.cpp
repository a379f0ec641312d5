#include "rendering/panels/exhibit_reveal.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/base/text.h"

namespace palpate {
namespace {

// In columns: the longest parts of the press before and after the largest difference that are shown, and the approach
// before it.
constexpr std::size_t kBefore = static_cast<std::size_t>(1.0 / ExhibitTrace::kColumn_s);
constexpr std::size_t kAfter = static_cast<std::size_t>(0.6 / ExhibitTrace::kColumn_s);
constexpr std::size_t kApproach = static_cast<std::size_t>(0.15 / ExhibitTrace::kColumn_s);

bool is_pressed(const ExhibitTrace::Column& column) { return column.ticks > 0 && column.position_m > 0.0; }

}  // namespace

void ExhibitReveal::start(const ExhibitTrace& trace, const JndLine& jnd, double slowness, double now_s) {
  jnd_ = jnd;
  slowness_ = slowness;
  began_s_ = now_s;
  moments_.assign(1, {});
  largest_at_ = 0;
  const std::vector<Moment>& columns = trace.columns();
  if (columns.empty()) return;
  const std::size_t largest = trace.largest_at();
  std::size_t first = largest, last = largest;
  while (first > 0 && largest - first < kBefore && is_pressed(columns[first - 1])) --first;
  while (last + 1 < columns.size() && last - largest < kAfter && is_pressed(columns[last + 1])) ++last;
  for (std::size_t i = 0; i < kApproach && first > 0 && columns[first - 1].ticks > 0; ++i) --first;
  moments_ = {columns.begin() + static_cast<std::ptrdiff_t>(first),
              columns.begin() + static_cast<std::ptrdiff_t>(last + 1)};
  largest_at_ = largest - first;
}

double ExhibitReveal::way_back(double now_s) const noexcept {
  const double share = std::clamp((columns_since_start(now_s) - end()) / kBack, 0.0, 1.0);
  return share * share * (3.0 - 2.0 * share);
}

double ExhibitReveal::playhead(double now_s) const noexcept {
  const double pressed = std::clamp(columns_since_start(now_s), 0.0, end());
  return std::lerp(pressed, static_cast<double>(largest_at_), way_back(now_s));
}

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

void ExhibitReveal::draw_arrows(const UiStyle& style, const SceneArea& area, double now_s, const Rgb& first,
                                const Rgb& second, bool first_is_left) const {
  const Moment moment = at(now_s);
  const auto highest_N = [this](const Moment& one) { return std::max({0.1, one.first_N + jnd_N(one), second_N(one)}); };
  double press_N = 0.1;
  for (const Moment& one : moments_) press_N = std::max(press_N, highest_N(one));
  // During the way back the present arrows may be higher than both.
  const double most_N =
      std::max(std::lerp(press_N, highest_N(moments_[largest_at_]), way_back(now_s)), highest_N(moment));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float right = area.at.x + area.size.x, ground = area.at.y + area.size.y;
  const auto y_of = [&](double force_N) {
    return ground - area.size.y * static_cast<float>(std::max(0.0, force_N) / most_N);
  };
  const ImVec2 corner(area.at.x, y_of(moment.first_N + jnd_N(moment)));
  const ImVec2 other(right, y_of(moment.first_N - jnd_N(moment)));
  list.AddRectFilled(corner, other, ink(style.colours().band));
  list.AddRect(corner, other, ink(style.colours().edge));
  const float thick = 3.0F * style.scale(), width = 0.11F * area.size.x, middle = area.at.x + 0.5F * area.size.x;
  // The difference between the tips, in the colour of errors above one JND where it leaves the band.
  list.AddRectFilled({middle - 4.0F * thick, y_of(std::max(moment.first_N, second_N(moment)))},
                     {middle + 4.0F * thick, y_of(std::min(moment.first_N, second_N(moment)))},
                     ink(std::abs(moment.over_jnd) > 1.0 ? kAboveJndColour : style.colours().quiet));
  for (const bool is_first : {true, false}) {
    const double force_N = std::max(0.0, is_first ? moment.first_N : second_N(moment));
    const Rgb& colour = is_first ? first : second;
    const float x = area.at.x + (is_first == first_is_left ? 0.25F : 0.75F) * area.size.x, tip = y_of(force_N);
    const float neck = std::min(tip + 1.1F * width, ground);
    list.AddRectFilled({x - 0.3F * width, neck}, {x + 0.3F * width, ground}, ink(colour));
    list.AddTriangleFilled({x, tip}, {x + 0.75F * width, neck}, {x - 0.75F * width, neck}, ink(colour));
    list.AddLine({x, tip}, {middle, tip}, ink(colour), thick);
    const std::string text = fixed(force_N, 1) + " N";
    const float y = std::max(area.at.y - 1.1F * ImGui::GetFontSize(), tip - 1.2F * ImGui::GetFontSize());
    list.AddText({x - 0.5F * ImGui::CalcTextSize(text.c_str()).x, y}, ink(text_colour(colour, style.theme())),
                 text.c_str());
  }
  list.AddLine({area.at.x, ground}, {right, ground}, ink(style.colours().quiet), thick);
}

}  // namespace palpate
