#include "scenes/report/figures/figure.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "engine/base/whole_file.h"
#include "scenes/scene/assets.h"

namespace palpate {
namespace {

std::string number(double value) {
  if (!std::isfinite(value)) return "NaN";
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 7).ptr};
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  std::string result;
  std::size_t at = 0;
  for (std::size_t next; (next = text.find(from, at)) != std::string::npos; at = next + from.size()) {
    result.append(text, at, next - at).append(to);
  }
  return result.append(text, at, std::string::npos);
}

// The ways in which gnuplot writes "#d8d8d8".
std::vector<std::string> spellings(std::string_view colour) {
  const auto part = [&](std::size_t at) { return std::stoi(std::string(colour.substr(at, 2)), nullptr, 16); };
  char wide[40];
  char narrow[40];
  std::snprintf(wide, sizeof wide, "rgb(%3d, %3d, %3d)", part(1), part(3), part(5));
  std::snprintf(narrow, sizeof narrow, "rgb(%d,%d,%d)", part(1), part(3), part(5));
  std::string upper(colour);
  for (char& letter : upper) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return {std::string(colour), upper, wide, narrow};
}

// 1, 2 or 5 times a power of ten, at or below / at or above `value` > 0.
double round_down(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {5.0, 2.0}) {
    if (step * decade <= value) return step * decade;
  }
  return decade;
}

double round_up(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * decade >= value) return step * decade;
  }
  return 10.0 * decade;
}

}  // namespace

void Figure::set_number(const std::string& variable, double value) {
  settings.append(variable).append(" = ").append(number(value)).append("\n");
}

void Figure::set_text(const std::string& variable, const std::string& text) {
  settings.append(variable).append(" = ").append(quoted(text)).append("\n");
}

Result<std::map<std::string, std::string>> figure_files(const std::vector<Figure>& figures) {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  const std::string folder = *assets + "/figures/report/";
  std::map<std::string, std::string> files;
  const auto add_script = [&](const std::string& name, const std::string& source) -> Status {
    auto text = read_whole_file(folder + source);
    if (!text) return Error{"cannot read " + folder + source + ", the plot script of a figure; check the assets folder"};
    files[name] = replaced(std::move(*text), "FIGURE", name.substr(0, name.rfind('.')));
    return {};
  };
  if (const Status status = add_script("style.gp", "style.gp"); !status) return status.error();
  for (const Figure& figure : figures) {
    const std::string source = (figure.script.empty() ? figure.name : figure.script) + ".gp";
    if (const Status status = add_script(figure.name + ".gp", source); !status) return status.error();
    files[figure.name + ".set"] = "width = " + std::to_string(figure.width) + "\nheight = " +
                                  std::to_string(figure.height) + "\n" + figure.settings;
    for (const Table& table : figure.data) files[table.name + ".csv"] = table_csv(table);
  }
  return files;
}

std::string inline_svg(const std::string& svg, const std::string& name, const std::string& title) {
  const std::size_t open = svg.find("<svg");
  if (open == std::string::npos) return {};
  const std::size_t box = svg.find("viewBox=\"", open) + 9;
  const std::string view = svg.substr(box, svg.find('"', box) - box);
  std::string body = svg.substr(svg.find('>', open) + 1);
  const std::size_t about = body.find("<title>");
  const std::size_t after = body.find("</desc>");
  if (about != std::string::npos && after != std::string::npos) body.erase(about, after + 7 - about);
  for (const char* reference : {"id=\"", "id='", "xlink:href=\"#", "xlink:href='#"}) {
    body = replaced(body, reference, std::string(reference).append(name).append("-"));
  }
  body = replaced(body, "url(#", std::string("url(#").append(name).append("-"));
  body = replaced(body, "xlink:href", "href");
  const std::pair<std::string_view, std::string_view> variables[] = {
      {kInk, "var(--ink)"},         {kMuted, "var(--muted)"}, {kGrid, "var(--grid)"}, {kMinorGrid, "var(--minor-grid)"},
      {kBand, "var(--band)"},       {kPaper, "var(--paper)"}, {kDirect, "var(--direct)"}};
  for (const auto& [colour, variable] : variables) {
    for (const std::string& form : spellings(colour)) body = replaced(body, form, variable);
  }
  body = replaced(body, "\"black\"", "\"var(--ink)\"");
  return "<svg viewBox=\"" + view + "\" role=\"img\" aria-label=\"" + escape_html(title) + "\">" + body;
}

double model_colour(const PlannedModel& model) {
  constexpr double kBlackOrWhite = 0x000001;  // kDirect
  const std::uint32_t colour = model.request.method->colour;
  return model.rung == Rung::no_force || colour == kNeutralColour ? kBlackOrWhite : static_cast<double>(colour);
}

std::string model_label(const PlannedModel& model) {
  if (model.rung == Rung::no_force) return "0 N";
  const bool few = model.few_candidates();
  return model.request.method->label + (few ? ", " + std::to_string(model.request.candidates) + " tried" : std::string());
}

double AxisRange::fraction(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  return std::log(std::max(value, 1e-300) / low) / std::log(high / low);
}

double AxisRange::value(double fraction) const {
  return logarithmic ? low * std::pow(high / low, fraction) : low + fraction * (high - low);
}

std::string AxisRange::tics(const std::string& axis) const {
  if (!logarithmic) return {};
  // Over few decades 2 and 5 are labelled too.
  const bool few = high / low < 200.0;
  std::string text("set ");
  text.append(axis).append("tics (");
  bool first = true;
  for (double decade = std::pow(10.0, std::floor(std::log10(low) + 1e-9)); decade <= high; decade *= 10.0) {
    for (int step = 1; step < 10; ++step) {
      const double at = step * decade;
      if (at < low * 0.999 || at > high * 1.001) continue;
      const bool labelled = step == 1 || (few && (step == 2 || step == 5));
      text.append(first ? "" : ", ").append(quoted(labelled ? number(at) : "")).append(" ");
      text.append(number(at)).append(labelled ? "" : " 1");
      first = false;
    }
  }
  return text.append(")\n");
}

AxisRange cropped_log_range(const std::vector<double>& values, double below, double above) {
  double low = HUGE_VAL;
  double high = 0.0;
  for (const double value : values) {
    if (!(value > 0.0) || !std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (high <= 0.0) return {0.1, 10.0, true};
  return {low / below, high * above, true};
}

AxisRange log_range(const std::vector<double>& values) {
  const AxisRange range = cropped_log_range(values, 1.15, 1.15);
  return {round_down(range.low), round_up(range.high), true};
}

AxisRange zero_range(const std::vector<double>& values) {
  double high = 0.0;
  for (const double value : values) {
    if (std::isfinite(value)) high = std::max(high, value);
  }
  if (high <= 0.0) return {0.0, 1.0, false};
  const double step = round_down(high) / 5.0;
  return {0.0, step * std::ceil(1.05 * high / step), false};
}

std::vector<double> spread_labels(const std::vector<double>& wanted, double gap) {
  std::vector<std::size_t> order(wanted.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return wanted[a] < wanted[b]; });
  std::vector<double> at = wanted;
  for (double& height : at) height = std::clamp(height, 0.02, 0.98);
  // Up past each other, then back down from the top where that went too far.
  for (std::size_t i = 1; i < order.size(); ++i) at[order[i]] = std::max(at[order[i]], at[order[i - 1]] + gap);
  double highest = 0.98;
  for (std::size_t i = order.size(); i-- > 0;) {
    at[order[i]] = std::min(at[order[i]], highest);
    highest = at[order[i]] - gap;
  }
  return at;
}

std::string quoted(const std::string& text) {
  std::string safe(1, '"');
  for (const char letter : text) {
    if (letter == '"' || letter == '\\' || letter == '\n' || letter == '`') {
      safe.push_back('\'');
    } else {
      safe.push_back(letter);
    }
  }
  safe.push_back('"');
  return safe;
}

}  // namespace palpate
