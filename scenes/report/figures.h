// The report's figures as plots (scenes/plot/plot.h) with captions.
// Thread guarantee: pure functions.
#pragma once

#include "scenes/report/measure.h"
#include "scenes/report/publish.h"

namespace palpate {

Figure speed_figure(const ReportData& data);
Figure worst_figure(const ReportData& data);
Figure force_figure(const ReportData& data);

}  // namespace palpate
