// The first word of a command line that a program does not know, for which CLI11 would name a missing option or say
// "not expected". Main thread only.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/text.h"

namespace palpate::cli {

// "unknown option --metod; did you mean --method?", "unknown verb "fti"; did you mean fit?"; empty if all are known.
inline std::string unknown_word(const CLI::App& app, int argc, char** argv) {
  const auto unknown = [](const std::string& what, const std::string& word, const std::string& dashes,
                          const std::vector<std::string>& known) {
    const std::string nearest = nearest_name(word, known);
    return "unknown " + what + (nearest.empty() ? "" : "; did you mean " + dashes + nearest + "?");
  };
  const CLI::App* verb = &app;
  for (int i = 1; i < argc && std::string_view(argv[i]) != "--"; ++i) {
    const std::string word = argv[i];
    std::vector<std::string> known;
    if (word.rfind("--", 0) == 0) {
      const std::string name = word.substr(2, word.find('=') - 2);
      for (const CLI::Option* option : verb->get_options()) {
        known.insert(known.end(), option->get_lnames().begin(), option->get_lnames().end());
      }
      if (std::ranges::find(known, name) == known.end())
        return unknown("option --" + printable(name), name, "--", known);
      continue;
    }
    const auto subs = verb->get_subcommands([](const CLI::App*) { return true; });
    if (subs.empty() || word.rfind('-', 0) == 0) continue;
    for (const CLI::App* sub : subs) known.push_back(sub->get_name());
    const auto found = std::ranges::find(known, word);
    if (found == known.end()) return unknown("verb \"" + printable(word) + "\"", word, "", known);
    verb = subs[static_cast<std::size_t>(found - known.begin())];
  }
  return {};
}

}  // namespace palpate::cli
