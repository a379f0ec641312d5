#include "rendering/panels/curve_drawing.h"

namespace palpate {

void CurvePainter::jnd_band(ImU32 colour) const {
  band(
      colour, [](const CurveColumn& c) { return c.tick.reference_N - c.jnd_N; },
      [](const CurveColumn& c) { return c.tick.reference_N + c.jnd_N; });
}

void CurvePainter::fault_marks(ImU32 late, ImU32 alarm, float size_px) const {
  for (const CurveColumn& column : columns) {
    const float x = plot.x_px(column.time_s - zero_s);
    if (column.fault_level == TickFaultLevel::late) {
      plot.list().AddLine({x, plot.top()}, {x, plot.top() + size_px}, late);
    } else if (column.fault_level == TickFaultLevel::alarm) {
      plot.list().AddTriangleFilled({x - size_px, plot.top()}, {x + size_px, plot.top()},
                                    {x, plot.top() + 1.6F * size_px}, alarm);
    }
  }
}

}  // namespace palpate
