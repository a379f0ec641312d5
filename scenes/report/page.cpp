#include "scenes/report/page.h"

#include "scenes/report/tables.h"

namespace palpate {
namespace {

const char* const kStyle = R"(
:root { color-scheme: light dark; --paper: #ffffff; --ink: #222222; --muted: #666666; --grid: #d8d8d8;
  --minor-grid: #ececec; --band: #e3e3e3; --direct: #000000; --rule: #d0d0d0; --note: #f4f4f2; }
@media (prefers-color-scheme: dark) { :root { --paper: #16181b; --ink: #e6e6e6; --muted: #a0a0a0; --grid: #3a3d41;
  --minor-grid: #26292d; --band: #34383d; --direct: #ffffff; --rule: #3a3d41; --note: #202327; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1rem; max-width: 60rem; background: var(--paper); color: var(--ink);
  font: 1.0625rem/1.5 "DejaVu Sans", system-ui, sans-serif; overflow-wrap: break-word; }
h1 { font-size: 1.75rem; line-height: 1.2; margin: 0.5rem 0; }
h2 { font-size: 1.3rem; margin: 2.2rem 0 0.5rem; border-top: 1px solid var(--rule); padding-top: 1rem; }
h3 { font-size: 1.0625rem; margin: 0 0 0.3rem; }
p, li { max-width: 46rem; }
.finding { background: var(--note); border-left: 4px solid #009E73; padding: 0.6rem 0.9rem; margin: 0.8rem 0; }
.finding p { margin: 0.35rem 0; }
.warning { border-left-color: #E69F00; }
figure { margin: 1.6rem 0; break-inside: avoid; }
figure svg { display: block; width: 100%; height: auto; max-width: 45rem; }
figure svg text, figure svg tspan { font-family: "DejaVu Sans", system-ui, sans-serif; }
figcaption, .caption { color: var(--muted); font-size: 0.9375rem; margin: 0.3rem 0; }
.table { overflow-x: auto; margin: 0.5rem 0 1rem; }
table { border-collapse: collapse; font-size: 0.8125rem; font-variant-numeric: tabular-nums; line-height: 1.35; }
th, td { padding: 0.2rem 0.45rem; text-align: right; border-bottom: 1px solid var(--rule); vertical-align: bottom; }
td { white-space: nowrap; vertical-align: top; }
th { font-weight: 600; }
th.text, td.text { text-align: left; }
td.text:last-child:not(:first-child) { white-space: normal; min-width: 8rem; }
code { font-size: 0.875rem; overflow-wrap: anywhere; }
@media (max-width: 40rem) { body { padding: 0.7rem; font-size: 1rem; } h1 { font-size: 1.4rem; }
  figure { margin: 1.2rem 0; } }
@media print { @page { size: A4; margin: 14mm; }
  :root { --paper: #ffffff; --ink: #222222; --muted: #555555; --grid: #d8d8d8; --minor-grid: #ececec;
    --band: #e3e3e3; --direct: #000000; --rule: #cccccc; --note: #f6f6f6; }
  body { max-width: none; font-size: 10pt; padding: 0; } h2, h3 { break-after: avoid; } tr { break-inside: avoid; }
  figure svg { max-height: 225mm; max-width: 150mm; } table { font-size: 7.5pt; } .table { overflow: visible; }
  th, td { padding: 0.1rem 0.3rem; } }
)";

// Escaped, and no line begins with a percent sign.
std::string prose(const std::string& text) {
  std::string safe = escape_html(text);
  for (std::size_t at = 0; (at = safe.find(" %", at)) != std::string::npos;) safe.replace(at, 1, "&#160;");
  return safe;
}

std::string paragraph(const std::string& text) { return "<p>" + prose(text) + "</p>\n"; }

std::string finding_box(const std::vector<std::string>& sentences, bool warning = false) {
  if (sentences.empty()) return {};
  std::string html = warning ? "<div class=\"finding warning\">\n" : "<div class=\"finding\">\n";
  for (const std::string& sentence : sentences) html += paragraph(sentence);
  return html + "</div>\n";
}

class Page {
 public:
  Page(const std::vector<Table>& tables, const std::vector<Figure>& figures,
       const std::map<std::string, std::string>& svgs)
      : tables_(tables), figures_(figures), svgs_(svgs) {}

  void add(const std::string& html) { html_ += html; }
  void heading(const std::string& text) { html_ += "<h2>" + escape_html(text) + "</h2>\n"; }

  // Nothing when the report has no such figure.
  void figure(const std::string& name) {
    for (const Figure& figure : figures_) {
      const auto svg = svgs_.find(name);
      if (figure.name != name || svg == svgs_.end()) continue;
      html_ += "<figure id=\"" + name + "\">\n<h3>" + escape_html(figure.title) + "</h3>\n" +
               inline_svg(svg->second, name, figure.title) + "\n<figcaption>" + prose(figure.caption) +
               "</figcaption>\n</figure>\n";
    }
  }

  void table(const std::string& name) {
    for (const Table& table : tables_) {
      if (table.name != name || table.caption.empty() || table.rows.empty()) continue;
      html_ += "<p class=\"caption\">" + prose(table.caption) + " (tables/" + name + ".csv)</p>\n" +
               table_html(table);
    }
  }

  std::string take() { return std::move(html_); }

 private:
  const std::vector<Table>& tables_;
  const std::vector<Figure>& figures_;
  const std::map<std::string, std::string>& svgs_;
  std::string html_;
};

std::string introduction(const ReportData& data) {
  std::string text = data.virtual_recordings
                         ? "No recordings were given, so this report is about a virtual silicone: a material, a hand "
                           "and sensors that exist in the computer only. "
                         : "";
  text += "Every method was fitted to the training recordings and replayed over the test recordings through the code "
          "that renders them live at 1 kHz. Errors are over the samples in contact. One JND (just noticeable "
          "difference) is the error that a hand notices: " +
          three_digits(1e3 * data.jnd.offset_N) + " mN + " + three_digits(100.0 * data.jnd.weber_fraction) +
          " % of the force. Scene: " + data.scene + "; relaxation times ";
  std::string times;
  for (const std::string& time : data.relaxation_times) {
    if (!times.empty()) times.append(", ");
    times.append(time);
  }
  return text + (times.empty() ? "none" : times + " s") + ".";
}

std::vector<std::string> warnings(const ReportData& data) {
  std::vector<std::string> list;
  if (data.folds > 0) {
    list.push_back("There was no test recording. Every error here is from " + std::to_string(data.folds) +
                   "-fold cross-validation over the training recordings: each part was tested by models fitted to "
                   "the others. Parts of one session are more alike than two sessions are, so a new recording will "
                   "do worse than this page says.");
  }
  if (data.quick) {
    list.push_back("A quick report: fewer sizes, fewer sites in the cost figures, and greedy with 20 candidates over "
                   "the seeds. Leave out --quick for all.");
  }
  return list;
}

std::string origin_html(const ReportOrigin& origin) {
  return "<p>" + escape_html(origin.version) + ", " + escape_html(origin.compiler) + ", " +
         escape_html(origin.gnuplot) + ". " + escape_html(origin.machine) + ". Made in " +
         three_digits(origin.seconds) + " s by</p>\n<p><code>" + escape_html(origin.command_line) +
         "</code></p>\n<p>All numbers: report.json and tables/*.csv; all figures as SVG, PNG and gnuplot script: "
         "figures/. The same recordings give the same figures but for times.</p>\n"
         "<p>Method and figures after R. Hoever and M. Harders (2009), <i>Computationally Efficient Techniques for "
         "Data-Driven Haptic Rendering</i>, World Haptics Conference.</p>\n";
}

}  // namespace

std::string make_page(const ReportData& data, const ReportOrigin& origin, const std::vector<Table>& tables,
                      const std::vector<Figure>& figures, const std::map<std::string, std::string>& svgs) {
  Page page(tables, figures, svgs);
  page.add("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
           "<title>Palpate: speed against error</title>\n<style>");
  page.add(kStyle);
  page.add("</style>\n</head>\n<body>\n<h1>How well, how fast: models of a touched material</h1>\n");
  page.add(paragraph(introduction(data)));
  page.add(finding_box(warnings(data), true));
  page.add(finding_box(findings(data, false)));
  page.add(finding_box(findings(data, true)));
  page.table("recordings");

  page.heading("Speed against error");
  for (const char* name : {"pareto", "pareto_share", "pareto_worst", "fit_time"}) page.figure(name);
  page.table("speed_error");
  page.table("speed_error_times");

  page.heading("Error against force");
  for (const char* name : {"error_mean_absolute", "error_mean_relative", "error_max_absolute", "error_max_relative"}) {
    page.figure(name);
  }

  page.heading("Where it goes wrong");
  page.figure("worst_trace");
  page.figure("coverage");
  page.table("coverage_errors");
  if (data.test_names.size() > 1) {
    page.heading("Between recordings");
    page.table("per_recording");
  }
  page.heading("Where the surface is");
  page.table("surface_moved");
  page.heading("Is it luck?");
  page.figure("repeatability");

  page.heading("Numerical health");
  page.table("fit_health");
  if (data.hard_cases) {
    page.heading("Hard cases");
    page.table(data.hard_cases->name);
  }
  page.heading("What fits cost");
  page.figure("fit_time_sites");
  page.figure("cost_dimension");

  page.heading("What a hand notices");
  page.figure("jnd");
  page.heading("Where this comes from");
  page.add(origin_html(origin));
  page.add("</body>\n</html>\n");
  return page.take();
}

}  // namespace palpate
