// The roles of columns by their names and units, and by elimination.
#include <algorithm>
#include <charconv>
#include <regex>
#include <utility>

#include "engine/base/text.h"
#include "engine/import/table_parts.h"

namespace palpate {
namespace {

// The words of each role. The claim of a column to a role is strongest if its whole name is one of the words, and
// weaker if one of its words is.
constexpr std::string_view kTimeWords =
    "time t zeit temps timestamp stamp seconds secs sec nsecs nanosec milliseconds elapsed x_value millis micros clock "
    "uhrzeit pruefzeit testzeit "
    "zeitstempel datetime tiempo \xE6\x97\xB6\xE9\x97\xB4";
constexpr std::string_view kPositionWords =
    "position pos weg displacement disp depth extension stroke crosshead travel compression indentation penetration "
    "allongement traversenweg standardweg verformung druckverformung deformation verschiebung eindringtiefe tiefe hub "
    "deplacement enfoncement desplazamiento "
    "posicion recorrido profundidad \xE4\xBD\x8D\xE7\xA7\xBB height distance gap deflection encoder x y z";
constexpr std::string_view kForceWords =
    "force f kraft standardkraft pruefkraft normalkraft druckkraft load last fn fx fy fz charge loadcell newton effort "
    "fuerza carga weight mass gewicht masse waage poids peso \xE5\x8A\x9B "
    "\xE8\xBD\xBD\xE8\x8D\xB7 \xE8\x8D\xB7\xE9\x87\x8D";
// Words of columns that are never a position or a force, whatever else is in the name and whatever the unit.
constexpr std::string_view kNeverWords =
    "torque moment drehmoment couple mx my mz tx ty tz acceleration accel acc ax ay az beschleunigung gyro angle "
    "winkel "
    "velocity speed geschwindigkeit vitesse velocidad temperature temp stress spannung peak max error deviation fehler "
    "abweichung offset thickness dicke diameter durchmesser noise rms range resolution slope wear limit threshold "
    "preload min";
// Units that are also those of an acceleration and of a torque, so that a column needs a word for its role as well.
constexpr std::string_view kAmbiguousUnits = "g nm";
// Words of columns that have no role unless they have its unit.
constexpr std::string_view kOtherWords =
    "voltage current status strain dehnung seq index id frame cycle zyklus comment rate volt orientation unit";
// Words of columns that say what a row belongs to.
constexpr std::string_view kIdentifyingWords =
    "specimen sample probe id sensor channel device test trial run series kanal pruefling versuch";
// Words of columns that are a second choice: commanded and not measured values, and times that restart ("Cycle Elapsed
// Time" beside "Total Time").
constexpr std::string_view kSecondWords = "target desired setpoint set soll sollwert command cmd reference ref cycle";

// Claims to a role, which add up. Columns with the unit of a position or a force compete as equals, whatever their
// names, and without any those with a word for it.
constexpr int kRightUnit = 10;
constexpr int kWholeName = 6;
constexpr int kOneWord = 4;
constexpr int kSecondChoice = 2;  // at most

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
  if (is_word_of(list, name)) return is_word_of("x y z fx fy fz", name) ? kOneWord : kWholeName;
  return any_word_in(list, words) ? kOneWord : 0;
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
  // "Position (N)" contradicts itself.
  for (std::size_t role = 0; role < kRoles && unit; ++role)
    if (claims[role] == kWholeName && claims[static_cast<std::size_t>(unit->quantity)] == 0) return {};
  for (std::size_t role = 0; role < kRoles; ++role) {
    const bool right = unit && static_cast<std::size_t>(unit->quantity) == role;
    if (unit && (!right || (claims[role] == 0 && is_word_of(kAmbiguousUnits, unit->name))))
      claims[role] = 0;
    else if (right)
      claims[role] += kRightUnit;
    // A unit that belongs to no role or is unknown ("Weg [%]"): a last choice, whose unit is then an error.
    const bool volts = role == 2 && volts_of(column.parts.foreign_unit) > 0.0;
    if (!column.parts.foreign_unit.empty() && !volts) claims[role] = std::min(claims[role], 1);
    if (claims[role] > 0 && any_word_in(kSecondWords, words))
      claims[role] = claims[role] > kRightUnit ? kSecondChoice : 1;
  }
  if (any_word_in(kNeverWords, words)) return {};
  // "Time_F" and "Time 1 - default sample rate" are times.
  const bool is_time = claims[0] > 0 && !words.empty() && is_word_of(kTimeWords, words.front());
  if (is_time) claims[1] = claims[2] = 0;
  // Only the strongest claims of a column count.
  const int strongest = *std::max_element(claims.begin(), claims.end());
  for (int& claim : claims) claim = claim < strongest ? 0 : claim;
  // A word for force excludes the axis beside it ("force.x"); a word for another quantity excludes all roles.
  if (claims[2] > 0 && !unit) claims[1] = 0;
  if (any_word_in(kOtherWords, words) && !unit && !is_time) claims = {};
  return claims;
}

// The columns that can be a role; none without a claim.
std::vector<std::size_t> strongest_columns(const std::vector<Claims>& claims, std::size_t role) {
  int least = 1;
  for (const Claims& claim : claims) least = std::max(least, claim[role]);
  // Clocks are compared later; positions and forces are not.
  if (role > 0 && least >= kOneWord) least = least >= kRightUnit ? kRightUnit : kOneWord;
  std::vector<std::size_t> best;
  for (std::size_t i = 0; i < claims.size(); ++i)
    if (claims[i][role] >= least) best.push_back(i);
  return best;
}

// A factor beside the name or the unit of a column: "Force x100 (N)", "10*Force", "Force/10", "Force 10^-2 N".
std::string factor_in(std::string_view header) {
  static const std::regex factor(R"(\*|×|10 ?\^|/ ?10+(?![0-9A-Za-z])|)"
                                 R"((^|[^A-Za-z0-9])(x ?10+|10+ ?x)(?![A-Za-z0-9]))");
  std::cmatch found;
  header = header.substr(0, 256);  // std::regex recurses over the text
  if (!std::regex_search(header.data(), header.data() + header.size(), found, factor)) return "";
  return found[2].matched ? found.str(2) : found.str();
}

// Whether the values of a column are successive numbers.
bool counts_rows(const ForeignColumn& column) {
  double last = 0.0, value = 0.0;
  bool counts = column.is_whole && column.values.size() > 2;
  for (std::size_t i = 0; i < column.values.size() && counts; last = value, ++i)
    counts = parse_table_number(column.values[i], '.', value) && (i == 0 || value == last + 1.0);
  return counts;
}

// The column that the user means, or a problem.
std::size_t find_column(const std::vector<ForeignColumn>& columns, std::size_t role, const std::string& wanted,
                        std::string& problem) {
  std::vector<std::size_t> found;
  // The number, else the header as it is, else in any case, else without its unit.
  for (std::size_t way = 0; way < 4 && found.empty(); ++way) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string& header = columns[i].header;
      const std::array names{std::to_string(i + 1), header, lower_ascii(header), lower_ascii(columns[i].parts.name)};
      if (names[way] == (way < 2 ? wanted : lower_ascii(wanted))) found.push_back(i);
    }
  }
  if (found.size() == 1) return found.front();
  problem = found.empty() ? "found no column \"" + printable(wanted) + "\" for the " + kRoleNames[role]
                          : "found " + std::to_string(found.size()) + " columns called \"" + printable(wanted) + '"';
  return 0;
}

bool is_role_word(const std::string& word) {
  return is_word_of(kTimeWords, word) || is_word_of(kPositionWords, word) || is_word_of(kForceWords, word);
}

}  // namespace

NameAndUnit header_parts(std::string_view header) {
  header = trimmed(header);
  std::string spelled;  // R writes "Time (s)" as "Time..s."
  if (const std::size_t at = header.rfind(".."); at != std::string_view::npos && header.ends_with('.') && at > 0)
    header = spelled = replaced(header.substr(0, at), ".", " ") + " (" +
                       std::string(header.substr(at + 2, header.size() - std::min(header.size(), at + 3))) + ")";
  const std::string factor = factor_in(header);
  using Parts = std::pair<std::string_view, std::string_view>;  // name, unit
  const auto split_at = [&](std::size_t at, std::size_t length) {
    const bool inside = at != std::string_view::npos && at > 0;
    return inside ? Parts{trimmed(header.substr(0, at)), trimmed(header.substr(at + length))} : Parts{};
  };
  // The last pair of brackets; a unit may follow it ("Position (z), mm"). Else a slash, the word "in", or any mark.
  const auto [name, in_brackets] = split_at(header.find_last_of("[(<{"), 1);
  const bool bracketed = !name.empty() && in_brackets.find_first_of("])>}") != std::string_view::npos;
  const std::string_view inside = in_brackets.substr(0, in_brackets.find_first_of("])>}"));
  std::vector<Parts> splits{bracketed ? Parts{name, trimmed(inside)} : Parts{}, split_at(header.rfind(','), 1)};
  if (!bracketed)
    for (const Parts& one : {split_at(header.rfind('/'), 1), split_at(header.rfind(" in "), 4),
                             split_at(header.find_last_of(" _,;:-."), 1)})
      splits.push_back(one);
  for (const auto& [before, text] : splits) {
    const auto unit = find_unit(text);
    if (!unit) continue;
    NameAndUnit parts{std::string(before), unit, "", ""};
    // A unit before the unit is that of a torque ("M_N_m"), or contradicts it ("force_N (mN)"); a number scales it.
    const NameAndUnit inner = header_parts(before);
    const bool other = inner.unit && inner.name != before && inner.unit->name != unit->name;
    if (other && inner.unit->quantity == unit->quantity) parts.contradicting = inner.unit->name;
    const bool torque = other && inner.unit->quantity != unit->quantity && inner.unit->quantity != Quantity::time &&
                        unit->quantity != Quantity::time;
    const std::string_view last = before.substr(before.find_last_of(' ') + 1);
    const bool scaled = !bracketed && header[before.size()] == ' ' && last.size() > 1 && last.size() < before.size() &&
                        last.find_first_not_of("x0123456789.,eE+-") == std::string_view::npos;
    if (!torque && !scaled && factor.empty()) return parts;
    return {inner.name, std::nullopt,
            (torque   ? std::string(inner.unit->name)
             : scaled ? std::string(last)
                      : factor) +
                " " + std::string(text),
            ""};
  }
  if (!factor.empty()) return {std::string(header), std::nullopt, factor, ""};
  if (bracketed) return {std::string(name), std::nullopt, std::string(trimmed(inside)), ""};
  // An unknown unit: "Load hN", or what follows a mark after a word for a role ("Kraft/Stein", "Weg in Furlong").
  if (const auto& [before, text] = split_at(header.find_last_of(" _,;:-./"), 1); is_prefixed_unit(text))
    return {std::string(before), std::nullopt, std::string(text), ""};
  for (const std::size_t split : {2u, 3u, 1u}) {
    const auto& [before, text] = splits[split];
    const std::vector<std::string> words = words_of(text);
    if (is_role_word(plain_name(before)) && words.size() == 1 && !is_role_word(words.front()))
      return {std::string(before), std::nullopt, std::string(text), ""};
  }
  // "millis" alone is a name and a unit.
  const auto whole = header.size() > 1 ? find_unit(header) : std::nullopt;
  return {std::string(header), whole && whole->quantity == Quantity::time ? whole : std::nullopt, "", ""};
}

NamedRoles named_roles(const Fields& fields) {
  std::vector<Claims> claims;
  for (const std::string_view field : fields)
    claims.push_back(claims_of({.header = std::string(field), .parts = header_parts(field)}));
  NamedRoles named;
  for (std::size_t role = 0; role < kRoles; ++role) {
    const std::vector<std::size_t> best = strongest_columns(claims, role);
    if (best.empty()) continue;
    ++named.count;
    if (best.size() == 1) named.column[role] = best.front() + 1;
  }
  return named;
}

std::string list_columns(const std::vector<ForeignColumn>& columns) {
  std::vector<std::string> names;
  for (const ForeignColumn& column : columns)
    names.push_back(std::to_string(names.size() + 1) + " \"" + printable(column.header) + '"' +
                    (column.constant ? " (constant)" : ""));
  return joined(names);
}

RoleChoice choose_columns(const std::vector<ForeignColumn>& columns, const RoleRequest& request, bool has_header,
                          bool needs_time) {
  RoleChoice choice;
  std::vector<Claims> claims;
  std::vector<bool> excluded;
  for (const ForeignColumn& column : columns) {
    claims.push_back(has_header ? claims_of(column) : Claims{});
    const bool never = has_header && any_word_in(kNeverWords, words_of(column.parts.name));
    excluded.push_back(never || column.constant || column.is_units);
    if (excluded.back()) claims.back() = {};
    if (column.is_clock && !column.constant) claims.back() = {std::max(1, claims.back()[0]), 0, 0};
  }
  for (std::size_t role = 0; role < kRoles; ++role) {
    if (request[role].empty() || (role == 0 && !needs_time)) continue;
    const std::size_t found = find_column(columns, role, request[role], choice.problem);
    if (!choice.problem.empty()) return choice;
    choice.number[role] = found + 1;
    claims[found] = {};
    excluded[found] = true;
  }
  const auto offer = [&](std::size_t role, const std::vector<std::size_t>& numbers) {
    for (const std::size_t i : numbers)
      choice.readings.push_back({std::string("--columns ") + kRoleNames[role] + "=" + std::to_string(i + 1),
                                 '"' + printable(columns[i].header) + '"'});
  };
  for (std::size_t role = 0; role < kRoles; ++role) {
    std::vector<std::size_t> best = strongest_columns(claims, role);
    for (std::size_t i = 0; role == 0 && i < columns.size(); ++i)
      if (claims[i][0] > 0 && !any_word_in(kSecondWords, words_of(columns[i].parts.name)))
        choice.times.push_back(i + 1);
    if (choice.number[role] > 0) continue;
    if (role == 0 && !needs_time && best.size() != 1) continue;
    if (best.empty()) {
      choice.problem =
          has_header ? std::string("found no column that is clearly the ") + kRoleNames[role] : "found no header";
      // What is left when the other roles are taken.
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto& [name, unit, foreign, contradicting] = columns[i].parts;
        const bool fits = unit ? static_cast<std::size_t>(unit->quantity) == role
                               : foreign.empty() || (role == 2 && volts_of(foreign) > 0.0);
        if (fits && !excluded[i] && claims[i] == Claims{} && !identifies(columns[i]) &&
            !(role == 0 && counts_rows(columns[i])))
          best.push_back(i);
      }
      if (has_header || role > 0) offer(role, best);
      if (!has_header && role == 0 && columns.size() == 3)
        choice.readings.push_back({"--columns time=1,position=2,force=3", "the usual order"});
      return choice;
    }
    if (best.size() > 1) {
      choice.problem = "found " + std::to_string(best.size()) + " columns that can be the " + kRoleNames[role];
      offer(role, best);
      if (role > 0) return choice;
      choice.number[0] = best.front() + 1;  // unless they are one clock
      continue;
    }
    choice.number[role] = best.front() + 1;
    choice.unnamed[role] = claims[best.front()][role] == kRightUnit || claims[best.front()][role] <= kSecondChoice;
    excluded[best.front()] = true;
  }
  for (std::size_t a = 1; a < kRoles; ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (choice.number[a] > 0 && choice.number[a] == choice.number[b])
        choice.problem = "found column \"" + printable(columns[choice.number[a] - 1].header) + "\" for the " +
                         kRoleNames[b] + " and the " + kRoleNames[a];
  return choice;
}

double fraction_unit_s(const ForeignColumn& column) {
  const std::vector<std::string> words = words_of(column.parts.name);
  const auto unit = column.parts.unit ? column.parts.unit : words.empty() ? std::nullopt : find_unit(words.back());
  return unit && unit->quantity == Quantity::time && unit->to_si < 1.0 ? unit->to_si : 0.0;
}

bool identifies(const ForeignColumn& column) { return any_word_in(kIdentifyingWords, words_of(column.parts.name)); }

}  // namespace palpate
