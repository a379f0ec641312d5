#include "engine/import/column_roles.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "engine/base/text.h"

namespace palpate {
namespace {

// The words of each role. The claim of a column to a role is strongest if its whole name is one of the words, weaker if
// one of its words is, and weakest if a word contains one (German compounds: "Standardkraft").
constexpr std::string_view kTimeWords =
    "time t zeit temps timestamp stamp seconds secs elapsed x_value millis micros clock uhrzeit pruefzeit testzeit "
    "zeitstempel datetime tiempo \xE6\x97\xB6\xE9\x97\xB4";
constexpr std::string_view kPositionWords =
    "position pos weg displacement disp depth extension stroke crosshead travel compression indentation penetration "
    "allongement traversenweg standardweg verschiebung eindringtiefe tiefe hub deplacement enfoncement desplazamiento "
    "posicion recorrido profundidad \xE4\xBD\x8D\xE7\xA7\xBB height encoder x y z";
constexpr std::string_view kForceWords =
    "force f kraft load last fn fx fy fz charge loadcell newton effort fuerza carga \xE5\x8A\x9B "
    "\xE8\xBD\xBD\xE8\x8D\xB7 \xE8\x8D\xB7\xE9\x87\x8D";
// Words of columns that have none of these roles, whatever other word is in the name.
constexpr std::string_view kOtherWords =
    "torque moment temperature temp voltage current status velocity speed geschwindigkeit acceleration accel stress "
    "strain spannung dehnung seq index id frame cycle zyklus tx ty tz mx my mz comment rate volt orientation";
// Words of columns that are a second choice: commanded and not measured values, raw values, and times that restart
// ("Cycle Elapsed Time" beside "Total Time").
constexpr std::string_view kSecondWords = "target desired setpoint soll sollwert command cmd reference raw cycle";

constexpr std::string_view kVelocityWords = "velocity speed geschwindigkeit vitesse velocidad";

constexpr int kWholeName = 6;
constexpr int kOneWord = 4;
constexpr int kInsideWord = 2;
constexpr int kRightUnit = 3;
constexpr int kSecondChoice = 3;  // subtracted

// Returns lower case, with umlauts and accents as plain letters.
std::string plain_name(std::string_view text) {
  std::string plain = lower_ascii(text);
  constexpr std::pair<std::string_view, std::string_view> kLetters[] = {
      {"\xC3\xBC", "ue"}, {"\xC3\x9C", "ue"}, {"\xC3\xA4", "ae"}, {"\xC3\xA9", "e"}, {"\xC3\x89", "e"},
      {"\xC3\xB6", "oe"}, {"\xC3\xA8", "e"},  {"\xC3\xB3", "o"},  {"\xC3\xAD", "i"}, {"\xC3\x9F", "ss"}};
  for (const auto& [from, to] : kLetters)
    for (std::size_t at = 0; (at = plain.find(from, at)) != std::string::npos; at += to.size())
      plain.replace(at, from.size(), to);
  return plain;
}

// "field.wrench.force.z" -> field, wrench, force, z; "crossheadPos" stays one lower-case word
// unless a capital begins a new one.
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words(1);
  char last = ' ';
  for (const char c : name) {
    const bool capital = c >= 'A' && c <= 'Z';
    const bool was_small = last >= 'a' && last <= 'z';
    const bool letter = capital || (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80;
    if ((!letter || (capital && was_small)) && !words.back().empty()) words.emplace_back();
    if (letter) words.back() += c;
    last = c;
  }
  for (std::string& word : words) word = plain_name(word);
  if (words.back().empty()) words.pop_back();
  return words;
}

bool any_word_in(std::string_view list, const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return is_word_of(list, word); });
}

int name_claim(std::string_view list, const std::string& name, const std::vector<std::string>& words) {
  // The name of an axis alone may be any quantity along it.
  if (is_word_of(list, name)) return name == "x" || name == "y" || name == "z" ? kOneWord : kWholeName;
  if (any_word_in(list, words)) return kOneWord;
  while (!list.empty()) {
    const std::string_view known = list.substr(0, list.find(' '));
    list.remove_prefix(std::min(known.size() + 1, list.size()));
    for (const std::string& word : words) {
      // Shorter words are parts of unrelated words.
      if (known.size() >= 3 && word.size() > known.size() && (word.starts_with(known) || word.ends_with(known)))
        return kInsideWord;
    }
  }
  return 0;
}

using Claims = std::array<int, kRoles>;

Claims name_claims(const ForeignColumn& column, const std::vector<std::string>& words) {
  std::string name = plain_name(column.parts.name);
  if (name.starts_with('%')) name.erase(0, 1);
  return {name_claim(kTimeWords, name, words), name_claim(kPositionWords, name, words),
          name_claim(kForceWords, name, words)};
}

// How strongly a column claims each role; 0: not at all.
Claims claims_of(const ForeignColumn& column) {
  const std::vector<std::string> words = words_of(column.parts.name);
  Claims claims = name_claims(column, words);
  const auto& unit = column.parts.unit;
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (unit) claims[role] = static_cast<std::size_t>(unit->quantity) == role ? claims[role] + kRightUnit : 0;
    // A unit that belongs to no role or is unknown ("Weg [%]"): a last choice, whose unit is then an error.
    const bool volts = role == 2 && volts_of(column.parts.foreign_unit) > 0.0;
    if (!column.parts.foreign_unit.empty() && !volts) claims[role] = std::min(claims[role], 1);
    if (claims[role] > 0 && any_word_in(kSecondWords, words)) claims[role] = std::max(1, claims[role] - kSecondChoice);
  }
  if (column.constant) claims[0] = 0;
  // Only the strongest claims of a column count.
  const int strongest = *std::max_element(claims.begin(), claims.end());
  for (int& claim : claims) claim = claim < strongest ? 0 : claim;
  // A word for force excludes the axis beside it ("force.x"); a word for another quantity excludes all roles.
  if (claims[2] > 0 && !unit) claims[1] = 0;
  if (any_word_in(kOtherWords, words) && !unit) claims = {};
  return claims;
}

// The parts of a header. What follows a mark of units after a word for a role ("Kraft/Stein", "Weg in Furlong") is an
// unknown unit.
NameAndUnit header_parts(std::string_view header) {
  NameAndUnit parts = split_name_and_unit(header);
  if (parts.unit || !parts.foreign_unit.empty()) return parts;
  for (const std::string_view mark : {"/", " in ", ","}) {
    const std::size_t at = header.rfind(mark);
    if (at == std::string_view::npos) continue;
    const std::string name = plain_name(trimmed(header.substr(0, at)));
    const std::string_view last = trimmed(header.substr(at + mark.size()));
    const std::vector<std::string> words = words_of(last);
    const auto is_role = [](const std::string& word) {
      return is_word_of(kTimeWords, word) || is_word_of(kPositionWords, word) || is_word_of(kForceWords, word);
    };
    if (!is_role(name) || words.size() != 1 || is_role(words.front())) continue;
    return {std::string(trimmed(header.substr(0, at))), std::nullopt, std::string(last)};
  }
  return parts;
}

// The columns with the strongest claim to a role; none without a claim.
std::vector<std::size_t> strongest_columns(const std::vector<Claims>& claims, std::size_t role) {
  int strongest = 1;
  for (const Claims& claim : claims) strongest = std::max(strongest, claim[role]);
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < claims.size(); ++i)
    if (claims[i][role] == strongest) best.push_back(i);
  return best;
}

// A role other than `role` that is the whole name of a column; kRoles: none.
std::size_t contradicted_role(const ForeignColumn& column, std::size_t role) {
  const Claims claims = name_claims(column, words_of(column.parts.name));
  const auto whole = std::find(claims.begin(), claims.end(), kWholeName);
  return claims[role] > 0 ? kRoles : static_cast<std::size_t>(whole - claims.begin());
}

// The factor of a unit such as "mm/s" to m/s; 0 if `text` is no unit of velocity.
double velocity_unit(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return 0.0;
  const auto length = find_unit(text.substr(0, slash));
  const auto time = find_unit(text.substr(slash + 1));
  if (!length || !time || length->quantity != Quantity::length || time->quantity != Quantity::time) return 0.0;
  return length->to_si / time->to_si;
}

std::string flag_for(std::size_t role, const std::string& what) {
  return std::string("--columns ") + kRoleNames[role] + "=" + what;
}

Result<std::size_t> find_column(const std::vector<ForeignColumn>& columns, std::size_t role,
                                const std::string& wanted) {
  const std::string lower = lower_ascii(wanted);
  std::vector<std::size_t> found;
  // The header as it is, else in any case, else without its unit.
  for (int way = 0; way < 3 && found.empty(); ++way) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto& [header, parts, constant] = columns[i];
      if (way == 0 ? header == wanted : lower_ascii(way == 1 ? header : parts.name) == lower) found.push_back(i);
    }
  }
  if (found.size() == 1) return found.front();
  if (found.size() > 1) {
    return Error{"found " + std::to_string(found.size()) + " columns called \"" + printable(wanted) +
                 "\", expected one; give the number, as in " + flag_for(role, std::to_string(found.front() + 1)) +
                 "; the columns are " + list_columns(columns)};
  }
  std::size_t number = 0;
  const auto parsed = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
  const bool is_number = parsed.ec == std::errc() && parsed.ptr == wanted.data() + wanted.size();
  if (is_number && number >= 1 && number <= columns.size()) return number - 1;
  return Error{"found no column \"" + printable(wanted) + "\" for the " + kRoleNames[role] + ", expected one of " +
               list_columns(columns)};
}

Error no_column(const std::vector<ForeignColumn>& columns, std::size_t role, bool has_header) {
  const std::string time_advice = role == 0 ? ", or --rate HZ if the rows are evenly spaced" : "";
  if (!has_header) {
    return Error{"found no header, expected names of columns; say which column is which: --columns " +
                 std::string(role == 0 ? "time=1,position=2,force=3" : "position=1,force=2") + time_advice +
                 "; the first row is " + list_columns(columns)};
  }
  return Error{std::string("found no column that is clearly the ") + kRoleNames[role] + "; add " +
               flag_for(role, "NAME") + " (a name or a number)" + time_advice + "; the columns are " +
               list_columns(columns)};
}

}  // namespace

bool NamedRoles::contradicts(const NamedRoles& other) const {
  const auto differs = [&](std::size_t role) {
    return column[role] > 0 && other.column[role] > 0 && column[role] != other.column[role];
  };
  return differs(1) && differs(2);
}

NamedRoles named_roles(const std::vector<std::string_view>& fields) {
  std::vector<Claims> claims;
  for (const std::string_view field : fields) claims.push_back(claims_of({std::string(field), header_parts(field)}));
  NamedRoles named;
  for (std::size_t role = 0; role < kRoles; ++role) {
    const std::vector<std::size_t> best = strongest_columns(claims, role);
    if (best.empty()) continue;
    ++named.count;
    named.strength += claims[best.front()][role];
    if (best.size() == 1) named.column[role] = best.front() + 1;
  }
  return named;
}

std::vector<ForeignColumn> foreign_columns(const TableLayout& layout,
                                           const std::vector<std::vector<std::string_view>>& rows) {
  const auto& first = rows.front();
  std::vector<ForeignColumn> columns(layout.columns);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    ForeignColumn& column = columns[i];
    if (!layout.names.empty()) {
      column.header = layout.names[i];
      column.parts = header_parts(column.header);
    } else if (i < first.size()) {
      column.header = first[i];
    }
    if (i < layout.units.size()) {
      if (const auto unit = find_unit(layout.units[i]))
        column.parts.unit = unit;
      else if (!column.parts.unit && layout.units[i].find_first_not_of("-[]() ") != std::string_view::npos)
        column.parts.foreign_unit = layout.units[i];
    }
    const auto changes = [&](const auto& row) { return i < std::min(row.size(), first.size()) && row[i] != first[i]; };
    column.constant = rows.size() > 1 && std::none_of(rows.begin(), rows.end(), changes);
  }
  return columns;
}

std::string list_columns(const std::vector<ForeignColumn>& columns) {
  std::vector<std::string> names;
  for (const ForeignColumn& column : columns)
    names.push_back(std::to_string(names.size() + 1) + " \"" + printable(column.header) + "\"");
  return joined(names);
}

Result<RoleColumns> choose_columns(const std::vector<ForeignColumn>& columns, const RoleRequest& request,
                                   bool has_header, bool needs_time) {
  RoleColumns chosen;
  const auto choose = [&](std::size_t role, std::size_t index, bool guessed) {
    chosen[role] = {index + 1, has_header ? columns[index].header : "", "", guessed};
  };
  std::vector<Claims> claims;
  for (const ForeignColumn& column : columns) claims.push_back(has_header ? claims_of(column) : Claims{});
  for (std::size_t role = needs_time ? 0 : 1; role < kRoles; ++role) {
    if (request[role].empty()) continue;
    const auto found = find_column(columns, role, request[role]);
    if (!found) return found.error();
    choose(role, *found, false);
    claims[*found] = {};
  }
  for (std::size_t role = needs_time ? 0 : 1; role < kRoles; ++role) {
    if (chosen[role].number > 0) continue;
    const std::vector<std::size_t> best = strongest_columns(claims, role);
    if (best.empty()) return no_column(columns, role, has_header);
    if (best.size() > 1) {
      std::vector<std::string> flags;
      for (const std::size_t index : best) flags.push_back(flag_for(role, std::to_string(index + 1)));
      return Error{"found " + std::to_string(best.size()) + " columns that can be the " + kRoleNames[role] + "; add " +
                   joined(flags, " or ") + "; the columns are " + list_columns(columns)};
    }
    const std::size_t index = best.front(), named = contradicted_role(columns[index], role);
    if (named < kRoles)
      return Error{"found column \"" + printable(columns[index].header) + "\", named as a " + kRoleNames[named] +
                   ", with the unit " + std::string(columns[index].parts.unit->name) + " of a " + kRoleNames[role] +
                   ", expected a name and a unit that agree; correct the header, or confirm the role with " +
                   flag_for(role, std::to_string(index + 1)) + "; the columns are " + list_columns(columns)};
    choose(role, index, true);
  }
  for (std::size_t a = 0; a < kRoles; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (chosen[a].number == 0 || chosen[a].number != chosen[b].number) continue;
      return Error{"found column \"" + printable(columns[chosen[a].number - 1].header) + "\" for the " + kRoleNames[b] +
                   " and the " + kRoleNames[a] + ", expected a column for each; the columns are " +
                   list_columns(columns)};
    }
  }
  return chosen;
}

std::optional<VelocityColumn> find_velocity(const std::vector<ForeignColumn>& columns) {
  std::optional<VelocityColumn> found;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::vector<std::string> words = words_of(columns[i].parts.name);
    const double to_si = velocity_unit(columns[i].parts.foreign_unit);
    if (to_si == 0.0 || !any_word_in(kVelocityWords, words) || any_word_in(kSecondWords, words)) continue;
    if (found) return std::nullopt;
    found = VelocityColumn{i, to_si};
  }
  return found;
}

}  // namespace palpate
