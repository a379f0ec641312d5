#include "scenes/report/page/page.h"

#include <algorithm>
#include <cmath>

#include "engine/base/whole_file.h"
#include "scenes/report/page/tables.h"
#include "scenes/report/page/template.h"
#include "scenes/scene/assets.h"

namespace palpate {
namespace {

// Escaped, and no line begins with a percent sign.
std::string prose(const std::string& text) {
  std::string safe = escape_html(text);
  for (std::size_t at = 0; (at = safe.find(" %", at)) != std::string::npos;) safe.replace(at, 1, "&#160;");
  return safe;
}

std::string paragraphs(const std::vector<std::string>& sentences) {
  std::string html;
  for (const std::string& sentence : sentences) html += "<p>" + prose(sentence) + "</p>\n";
  return html;
}

std::string link(const std::string& file, const std::string& text) {
  return "<a href=\"" + escape_html(file) + "\">" + escape_html(text) + "</a>";
}

std::string figure_html(const Figure& figure, const std::string& svg) {
  const std::string base = "figures/" + figure.name;
  std::string links;
  for (const Table& table : figure.data) {
    links += (links.empty() ? "" : ", ") + link("figures/" + table.name + ".csv", table.name + ".csv");
  }
  for (const char* ending : {".svg", ".png", ".gp"}) links += ", " + link(base + ending, std::string(ending).substr(1));
  return "<figure id=\"" + figure.name + "\">\n<h3>" + prose(figure.title) + "</h3>\n<div class=\"drawing\">" +
         inline_svg(svg, figure.name, figure.title) + "</div>\n<figcaption>" + prose(figure.caption) +
         " <span class=\"data\">Data: " + links + ".</span></figcaption>\n</figure>\n";
}

std::string table_block(const Table& table) {
  const std::string file = "tables/" + table.name + ".csv";
  return (table.caption.empty() ? "" : "<p class=\"caption\">" + prose(table.caption) + " <span class=\"data\">Data: " +
                                           link(file, table.name + ".csv") + ".</span></p>\n") +
         table_html(table);
}

// Of the stability suite: how many cases, how many safe, and the three worst errors.
std::string hard_cases_text(const ReportData& data) {
  if (!data.hard_cases) return {};
  const std::vector<std::vector<TableCell>>& rows = data.hard_cases->rows;
  std::size_t safe = 0;
  std::vector<const std::vector<TableCell>*> order;
  for (const auto& row : rows) {
    if (row.size() < 5) return {};
    safe += row[2].text == "yes" ? 1 : 0;
    if (std::isfinite(row[4].number)) order.push_back(&row);
  }
  std::stable_sort(order.begin(), order.end(), [](const auto* a, const auto* b) { return (*a)[4].number > (*b)[4].number; });
  std::string text = std::to_string(safe) + " of " + std::to_string(rows.size()) +
                     " made-up hard cases (broken data, motions far from the training; the same in every report) end "
                     "safely: finite and bounded everywhere, or refused with a message. The worst three cases: ";
  std::vector<std::string> named;  // a case once, with its worst method
  for (const auto* worst : order) {
    const auto& row = *worst;
    if (named.size() == 3) break;
    if (std::find(named.begin(), named.end(), row[0].text) != named.end()) continue;
    named.push_back(row[0].text);
    text += (named.size() == 1 ? "" : "; ") + row[1].text + " with \"" + row[0].text + "\", " + three_digits(row[4].number) + " JND";
  }
  return "<p>" + prose(text + ".") + "</p>\n";
}

std::vector<std::string> warnings(const ReportData& data) {
  std::vector<std::string> list;
  if (data.virtual_recordings) {
    list.push_back("No recordings were given, so this report is about a virtual silicone: a material, a hand and "
                   "sensors that exist in the computer only.");
  }
  if (data.folds > 0) {
    list.push_back("There was no test recording. Every error here is from " + std::to_string(data.folds) +
                   "-fold cross-validation over the training recordings: each part was tested by models fitted to "
                   "the others. Parts of one session are more alike than two sessions are, so a new recording will "
                   "do worse than this page says.");
  }
  if (data.quick) {
    list.push_back("A quick report: fewer sizes, fewer sites in the cost figures, greedy with 20 candidates over the "
                   "seeds, and neither direct nor voxel models among those that may be recommended. Leave out --quick "
                   "for all.");
  }
  return list;
}

std::map<std::string, std::string> plain_values(const ReportData& data, const ReportOrigin& origin) {
  std::map<std::string, std::string> values;
  std::vector<std::string> sentences = findings(data, false);
  if (!sentences.empty()) {
    values["first_finding"] = prose(sentences.front());
    sentences.erase(sentences.begin());
  }
  values["findings"] = paragraphs(sentences);
  values["time_findings"] = paragraphs(findings(data, true));
  values["warnings"] = paragraphs(warnings(data));
  values["scene"] = escape_html(data.scene);
  values["jnd_offset"] = three_digits(1e3 * data.jnd.offset_N);
  values["jnd_fraction"] = three_digits(100.0 * data.jnd.weber_fraction);
  std::string times;
  for (const std::string& time : data.relaxation_times) times += (times.empty() ? "" : ", ") + time;
  values["relaxation_times"] = times.empty() ? "none" : times + " s";
  values["hard_cases"] = hard_cases_text(data);
  values["several_tests"] = data.test_names.size() > 1 ? "yes" : "";
  values["facts_model"] = escape_html(data.facts.model);
  values["version"] = escape_html(origin.version);
  values["compiler"] = escape_html(origin.compiler);
  values["gnuplot"] = escape_html(origin.gnuplot);
  values["machine"] = escape_html(origin.machine);
  values["seconds"] = three_digits(origin.seconds);
  values["command_line"] = escape_html(origin.command_line);
  values.try_emplace("first_finding");
  return values;
}

}  // namespace

Result<std::string> make_page(const ReportData& data, const ReportOrigin& origin, const std::vector<Table>& tables,
                              const std::vector<Figure>& figures, const std::map<std::string, std::string>& svgs) {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  const std::string path = *assets + "/report/page.html";
  const auto text = read_whole_file(path);
  if (!text) return Error{"cannot read " + path + ", the template of the page; check the assets folder"};
  std::map<std::string, std::string> values = plain_values(data, origin);
  for (const Figure& figure : figures) {
    const auto svg = svgs.find(figure.name);
    if (svg != svgs.end()) values["figure " + figure.name] = figure_html(figure, svg->second);
  }
  for (const Table& table : tables) values["table " + table.name] = table.rows.empty() ? "" : table_block(table);
  const std::string nothing;
  return filled_template(*text, path, [&](const std::string& name) -> const std::string* {
    const auto found = values.find(name);
    if (found != values.end()) return &found->second;
    // A figure or table that this report does not have.
    return name.rfind("figure ", 0) == 0 || name.rfind("table ", 0) == 0 ? &nothing : nullptr;
  });
}

}  // namespace palpate
