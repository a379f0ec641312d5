#include "scenes/report/publish.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr double kPageWidth_rem = 52.0;

constexpr const char* kNothing = "–";

std::string quoted_if_needed(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  return '"' + replaced(text, "\"", "\"\"") + '"';
}

std::string csv_cell(const TableCell& cell) {
  if (cell.is_string()) return quoted_if_needed(cell.get<std::string>());
  if (cell.is_number_integer() || cell.is_boolean()) return cell.dump();
  return std::isfinite(cell.get<double>()) ? shortest(cell.get<double>()) : "";
}

std::string shown(const TableCell& cell, const TableColumn& column) {
  if (cell.is_string()) return cell.get<std::string>();
  if (cell.is_boolean()) return yes_or_no(cell.get<bool>());
  if (cell.is_number_integer()) return with_thousands(cell.dump());
  const double value = cell.get<double>() * column.scale;
  if (!std::isfinite(value)) return kNothing;
  return column.decimals == TableColumn::kThreeDigits ? three_digits(value)
                                                      : with_thousands(fixed(value, column.decimals));
}

// The small text below the cell `first - 1`: the next value, or the next two as an interval.
std::string under_html(const std::vector<TableCell>& row, std::size_t first, const TableColumn& column) {
  if (column.under == 0) return {};
  const std::string low = shown(row[first], column);
  const std::string high = column.under == 2 ? shown(row[first + 1], column) : "";
  if (low == kNothing || high == kNothing) return {};
  return "<small>" + escape_html(low) + (high.empty() ? "" : "–" + escape_html(high)) + "</small>";
}

bool is_text(const Table& table, std::size_t column) {
  return !table.rows.empty() &&
         std::ranges::all_of(table.rows, [&](const auto& row) { return row[column].is_string(); });
}

// The spellings that gnuplot uses for a colour such as "#d8d8d8".
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

Result<std::string> read_template(const std::string& name) {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  const std::string path = *assets + "/report/" + name;
  auto text = read_whole_file(path);
  if (!text) return Error{"cannot read " + path + ", a template of the report; check the assets folder"};
  return std::move(*text);
}

Status check_target(const fs::path& path, bool overwrite) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (!fs::exists(status)) return {};
  if (!fs::is_directory(status)) {
    return Error{"cannot write " + path.string() + ": it is not a folder; name a new one for --out"};
  }
  if (!overwrite) return Error{path.string() + " exists; pass --force to replace it"};
  if (!fs::is_empty(path, error) && !fs::exists(path / "report.json", error)) {
    return Error{path.string() +
                 " holds files but no report.json, expected an earlier report to replace; name "
                 "another folder"};
  }
  return {};
}

std::string figure_html(const Plot& figure, const std::string& svg) {
  // Text has the same size in narrow figures and in wide ones.
  return "<figure style=\"max-width: " + general(kPageWidth_rem * figure.width, 3) + "rem\">" +
         inline_svg(svg, figure.name, figure.caption) + "<figcaption>" + escape_html(figure.caption) +
         " <a class=\"data\" href=\"figures/" + figure.name + ".gp\">data and script</a></figcaption></figure>\n";
}

// Returns assets/report/NAME with every {{key}} replaced by its value.
Result<std::string> fill_page(const std::string& name, const std::map<std::string, std::string>& values) {
  const auto text = read_template(name);
  if (!text) return text.error();
  std::string page;
  std::size_t at = 0;
  for (std::size_t open; (open = text->find("{{", at)) != std::string::npos;) {
    const std::size_t close = text->find("}}", open);
    const auto value =
        close == std::string::npos ? values.end() : values.find(text->substr(open + 2, close - open - 2));
    if (value == values.end()) return Error{name + ": found {{ without the name of a part of the page after it"};
    page.append(*text, at, open - at).append(value->second);
    at = close + 2;
  }
  return page.append(*text, at);
}

// Removes the slash at the end of "a/b/".
fs::path without_slash(const std::string& path) {
  fs::path clean = fs::path(path).lexically_normal();
  if (!clean.has_filename()) clean = clean.parent_path();
  return clean;
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string safe(text);
  for (const auto& [letter, entity] :
       {std::pair{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}, {"'", "&#39;"}}) {
    safe = replaced(safe, letter, entity);
  }
  return safe;
}

std::string table_csv(const Table& table) {
  std::vector<std::string> keys;
  for (const TableColumn& column : table.columns) keys.push_back(column.key);
  std::string text = joined(keys, ",") + "\n";
  for (const auto& row : table.rows) {
    std::vector<std::string> cells;
    for (const TableCell& cell : row) cells.push_back(csv_cell(cell));
    text += joined(cells, ",") + "\n";  // a row without cells is a blank line
  }
  return text;
}

nlohmann::ordered_json table_json(const Table& table) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& row : table.rows) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < row.size(); ++i)  // a number that is not finite is written as null
      if (const std::string& key = table.columns[i].key; !key.empty())
        object[nlohmann::ordered_json::json_pointer("/" + replaced(key, ".", "/"))] = row[i];
    list.push_back(std::move(object));
  }
  return list;
}

std::vector<std::vector<std::string>> table_text(const Table& table) {
  std::vector<std::vector<std::string>> lines(table.rows.size() + 1);
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].title.empty()) continue;
    lines[0].push_back(table.columns[i].title);
    for (std::size_t row = 0; row < table.rows.size(); ++row)
      lines[row + 1].push_back(shown(table.rows[row][i], table.columns[i]));
  }
  return lines;
}

std::string table_html(const Table& table) {
  std::string html = "<div class=\"table\"><table>\n<thead><tr>";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].title.empty()) continue;
    html += is_text(table, i) ? "<th class=\"text\">" : "<th>";
    html += escape_html(table.columns[i].title) + "</th>";
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const TableColumn& column = table.columns[i];
      if (column.title.empty()) continue;
      const std::string text = shown(row[i], column);
      html += text.starts_with("✗") ? "<td class=\"broken\">" : is_text(table, i) ? "<td class=\"text\">" : "<td>";
      html += escape_html(text) + under_html(row, i + 1, column) + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string list_html(const std::vector<std::string>& lines) {
  std::string html;
  for (const std::string& line : lines) html += "<li>" + escape_html(line) + "</li>\n";
  return html;
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
  for (const char* reference : {"id=\"", "id='", "xlink:href=\"#", "xlink:href='#"})
    body = replaced(body, reference, std::string(reference).append(name).append("-"));
  body = replaced(body, "url(#", std::string("url(#").append(name).append("-"));
  body = replaced(body, "xlink:href", "href");
  const std::pair<std::string_view, std::string_view> variables[] = {{"#222222", "var(--ink)"},
                                                                     {"#6e6e6e", "var(--muted)"},
                                                                     {"#d8d8d8", "var(--grid)"},
                                                                     {"#e3e3e3", "var(--band)"},
                                                                     {"#fefefe", "var(--paper)"}};
  for (const auto& [colour, variable] : variables)
    for (const std::string& form : spellings(colour)) body = replaced(body, form, variable);
  body = replaced(body, "\"black\"", "\"var(--ink)\"");
  return "<svg viewBox=\"" + view + "\" role=\"img\" aria-label=\"" + escape_html(title) + "\">" + body;
}

Result<ReportFolder> ReportFolder::create(const std::string& path, bool overwrite) {
  const fs::path clean = without_slash(path);
  if (path.empty() || path == "-" || clean.filename() == "." || clean.filename() == "..") {
    return Error{"cannot write a report to \"" + path + "\": it is no name of a new folder; name one for --out"};
  }
  if (const Status target = check_target(clean, overwrite); !target) return target.error();
  ReportFolder folder;
  folder.path_ = clean.string();
  // Reports before the work of a report if nothing can be written.
  if (const Status trial = folder.open(); !trial) return trial.error();
  folder.temporary_.reset();
  return folder;
}

Status ReportFolder::open() {
  const fs::path path(path_);
  const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  temporary_ = std::make_unique<ScratchFolder>(parent.string(), ".palpate-report-");
  if (temporary_->path().empty()) {
    return Error{"cannot write " + path_ + ": cannot make a folder in " + parent.string() + " (" +
                 std::generic_category().message(errno) + "); create that folder first, or name another one"};
  }
  // Only the owner can read a new scratch folder.
  std::error_code error;
  fs::permissions(temporary_->path(), static_cast<fs::perms>(0755), error);
  return {};
}

Status ReportFolder::write(const std::string& name, std::string_view text) {
  if (!temporary_) {
    if (Status opened = open(); !opened) return opened;
  }
  std::error_code ignored;
  fs::create_directories(fs::path(path_of(name)).parent_path(), ignored);
  return write_file_atomically(path_of(name), text, true);
}

Status ReportFolder::commit() {
  std::error_code error;
  // A rename cannot replace a folder with files: the earlier report is moved aside first, and moved back when the
  // rename fails.
  const std::string made = temporary_->path();
  const std::string aside = made + ".old";
  const bool replaces = fs::exists(path_, error);
  if (replaces) {
    fs::rename(path_, aside, error);
    if (error) return Error{"cannot replace " + path_ + ": " + error.message()};
  }
  fs::rename(made, path_, error);
  if (error) {
    std::error_code ignored;
    if (replaces) fs::rename(aside, path_, ignored);
    return Error{"cannot write " + path_ + ": " + error.message()};
  }
  if (replaces) fs::remove_all(aside, error);
  return {};
}

Status write_report(ReportFolder& folder, const PageRequest& request, const std::string& page_template,
                    const std::vector<Table>& tables, const std::vector<Plot>& figures,
                    std::map<std::string, std::string> parts, const nlohmann::ordered_json& report,
                    const FitControl& control) {
  for (const Table& table : tables) {
    if (const Status status = folder.write("tables/" + table.name + ".csv", table_csv(table)); !status) return status;
    parts[table.name] = table.rows.empty() ? "" : table_html(table);
    parts["tables"] += ", <a href=\"tables/" + table.name + ".csv\">" + table.name + "</a>";
  }
  const std::string place = folder.path_of("figures");
  std::error_code ignored;
  fs::create_directories(place, ignored);
  const Status drawn = draw_plots(place, figures);
  // Ctrl-C at a terminal ends gnuplot as well; the report is then interrupted, not wrong.
  if (!control.may_continue(0.99)) return interrupted();
  if (!drawn) return drawn;
  for (const Plot& figure : figures) {
    const auto svg = read_plain_file(place + "/" + figure.name + ".svg", "a drawing of gnuplot");
    if (!svg) return svg.error();
    parts["figures"] += parts[figure.name] = figure_html(figure, *svg);
  }
  const auto style = read_template("style.css");
  if (!style) return style.error();
  parts["style"] = *style;
  parts["jnd"] = escape_html(kJndDefinition);
  parts["rule"] = escape_html(kBestRule);
  parts["origin"] = escape_html(request.command + " · " + request.version + parts["origin"]);
  const auto body = fill_page(page_template, parts);
  if (!body) return body.error();
  parts["body"] = *body;
  const auto page = fill_page("frame.html", parts);
  if (!page) return page.error();
  // Names of recordings may be invalid UTF-8; such bytes are replaced.
  const std::string json = report.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  if (const Status status = folder.write("report.json", json); !status) return status;
  if (const Status status = folder.write("index.html", *page); !status) return status;
  if (!control.may_continue(1.0)) return interrupted();
  return folder.commit();
}

}  // namespace palpate
