#include "rendering/panels/panel_errors.h"

#include <algorithm>
#include <vector>

#include "rendering/panels/panel_parts.h"
#include "rendering/ui/plot.h"

namespace palpate {
namespace {

// Fewer say nothing about a spread.
constexpr std::uint64_t kFewestSamples = 20;

struct Limits {
  double force_N = 1.0;
  double error_N = 0.1;
};

Limits limits_of(const ModelsView& models) {
  Limits limits;
  for (const SlotView* slot : models.slots) {
    for (const ForceBin& bin : slot->errors.bins(models.jnd)) {
      if (bin.count < kFewestSamples) continue;
      limits.force_N = std::max(limits.force_N, bin.force_to_N);
      limits.error_N = std::max(limits.error_N, bin.mean_abs_error_N + bin.std_abs_error_N);
    }
  }
  // The line must be seen whole; maxima beyond twice that leave at the top.
  limits.error_N = round_up(1.6 * std::max(limits.error_N, models.jnd.at(limits.force_N)));
  return limits;
}

void draw_slot(const LivePlot& plot, const ModelsView& models, std::size_t index, const UiStyle& style) {
  const bool selected = index == models.selected;
  const SlotView& slot = *models.slots[index];
  const ImU32 colour = ink(slot_colour(models, index, style.theme()), selected ? 1.0F : 0.75F);
  const float size = style.scale();
  std::vector<ImVec2> spread;
  for (const ForceBin& bin : slot.errors.bins(models.jnd)) {
    if (bin.count < kFewestSamples) continue;
    const float x = plot.x_px(0.5 * (bin.force_from_N + bin.force_to_N));
    spread.emplace_back(x, plot.y_px(bin.mean_abs_error_N + bin.std_abs_error_N));
    plot.list().AddCircleFilled(spread.back(), (selected ? 4.0F : 3.0F) * size, colour);
    const float top = std::max(plot.y_px(bin.max_abs_error_N), plot.top() + 4.0F * size);
    plot.list().AddTriangleFilled({x - 4.0F * size, top + 3.0F * size}, {x + 4.0F * size, top + 3.0F * size},
                                  {x, top - 4.0F * size}, colour);
  }
  plot.line(spread, colour, (selected ? 2.6F : 1.5F) * size);
}

}  // namespace

void draw_error_bins(const ModelsView& models, const UiStyle& style, float height) {
  const Limits limits = limits_of(models);
  {
    const LivePlot plot(style, {ImGui::GetContentRegionAvail().x, height},
                        {{0.0, limits.force_N}, {0.0, limits.error_N}, "N", "N", true});
    const double ends[2] = {0.0, limits.force_N};
    std::vector<ImVec2> line;
    std::vector<ImVec2> floor;
    for (const double force_N : ends) {
      line.emplace_back(plot.x_px(force_N), plot.y_px(models.jnd.at(force_N)));
      floor.emplace_back(plot.x_px(force_N), plot.bottom());
    }
    plot.band(line, floor, ink(style.colours().band, 0.45F));
    plot.line(line, ink(style.colours().text), 1.5F * style.scale());
    for (std::size_t i = 0; i < models.slots.size(); ++i) {
      if (i != models.selected) draw_slot(plot, models, i, style);
    }
    if (!models.slots.empty()) draw_slot(plot, models, models.selected, style);
    plot.caption(
        " JND", 0.0F,
        std::clamp((plot.y_px(models.jnd.offset_N) - plot.top()) / (plot.bottom() - plot.top()) - 0.25F, 0.0F, 0.9F),
        ink(style.colours().quiet));
  }
  tip("Error against force since the last reset (C), in steps of 0.5 N.\nDots: mean + standard deviation. "
      "Triangles: the largest.\nBlack line: the just noticeable difference.");
}

}  // namespace palpate
