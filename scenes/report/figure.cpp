#include "scenes/report/figure.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>

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

std::string style() {
  std::string text = R"(set key off
set samples 200
set border 3 linecolor rgb "INK" linewidth 1
set tics nomirror textcolor rgb "INK" scale 0.6,0.3
set xlabel textcolor rgb "INK" offset 0,0.3
set ylabel textcolor rgb "INK"
set grid xtics ytics mxtics mytics linetype 1 linecolor rgb "GRID" linewidth 1, linetype 1 linecolor rgb "MINOR" linewidth 1
set grid back
)";
  text = replaced(text, "INK", kInk);
  text = replaced(text, "GRID", kGrid);
  return replaced(text, "MINOR", kMinorGrid);
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

std::string figure_script(const Figure& figure) {
  const std::string w = std::to_string(figure.width);
  const std::string h = std::to_string(figure.height);
  const std::string w2 = std::to_string(2 * figure.width);
  const std::string h2 = std::to_string(2 * figure.height);
  const std::string paper(kPaper);
  const std::string plot = style() + figure.commands + "unset output\nreset\n";
  return "# " + figure.title + "\nreset session\nset encoding utf8\n" + figure.data +
         "set terminal svg size " + w + "," + h + " font \"sans-serif,15\" background \"" + paper +
         "\" rounded\nset output \"" + figure.name + ".svg\"\n" + plot +
         "set terminal pngcairo size " + w2 + "," + h2 +
         " font \"DejaVu Sans,13\" fontscale 1.7 linewidth 2 pointscale 2 background \"#ffffff\" rounded\nset output \"" +
         figure.name + ".png\"\n" + plot;
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

std::string method_colour(const Method& method) {
  if (method.colour == kNeutralColour) return std::string(kDirect);
  char text[16];
  std::snprintf(text, sizeof text, "#%06X", static_cast<unsigned>(method.colour));
  return text;
}

std::string model_label(const PlannedModel& model) {
  const bool few = model.request.candidates < MethodRequest{}.candidates;
  return model.request.method->label + (few ? ", " + std::to_string(model.request.candidates) + " tried" : std::string());
}

std::string data_block(const std::string& name, const std::vector<std::vector<double>>& rows) {
  std::string text("$");
  text.append(name).append(" << EOD\n");
  for (const std::vector<double>& row : rows) {
    for (const double value : row) text.append(number(value)).push_back(' ');
    text.push_back('\n');
  }
  // A block without a row is an error in a plot command.
  if (rows.empty()) text.append("NaN NaN NaN NaN\n");
  return text.append("EOD\n");
}

double AxisRange::fraction(double value) const {
  if (!logarithmic) return (value - low) / (high - low);
  return std::log(std::max(value, 1e-300) / low) / std::log(high / low);
}

std::string AxisRange::text() const {
  std::string text("[");
  return text.append(number(low)).append(":").append(number(high)).append("]");
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

AxisRange log_range(const std::vector<double>& values) {
  double low = 1e300;
  double high = 0.0;
  for (const double value : values) {
    if (!(value > 0.0) || !std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (high <= 0.0) return {0.1, 10.0, true};
  return {round_down(low / 1.15), round_up(high * 1.15), true};
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

std::string side_labels(std::vector<SideLabel> labels, const std::string& x, double gap, int first_tag) {
  std::stable_sort(labels.begin(), labels.end(),
                   [](const SideLabel& a, const SideLabel& b) { return a.fraction < b.fraction; });
  for (SideLabel& label : labels) label.fraction = std::clamp(label.fraction, 0.02, 0.98);
  // Up past each other, then back down from the top where that went too far.
  for (std::size_t i = 1; i < labels.size(); ++i) {
    labels[i].fraction = std::max(labels[i].fraction, labels[i - 1].fraction + gap);
  }
  double highest = 0.98;
  for (std::size_t i = labels.size(); i-- > 0;) {
    labels[i].fraction = std::min(labels[i].fraction, highest);
    highest = labels[i].fraction - gap;
  }
  std::string text;
  for (const SideLabel& label : labels) {
    text.append("set label ").append(std::to_string(first_tag++)).append(" ").append(quoted(label.text));
    text.append(" at ").append(x).append(", graph ").append(number(label.fraction));
    text.append(" left noenhanced textcolor rgb \"").append(label.colour).append("\"\n");
  }
  return text;
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
