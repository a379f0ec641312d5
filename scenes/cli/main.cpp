// palpate: the headless program. Exit codes: 0 success; 1 error; 2 wrong usage; 130 stopped by Ctrl-C, 143 by SIGTERM,
// as in a shell. No locale is set, so that numbers are read and printed with '.'.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include "engine/base/text.h"
#include "models/linear/lapack.h"
#include "models/model/vector_loops.h"
#include "scenes/cli/verbs.h"

namespace palpate::cli {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kUsage = 2;

struct Verb {
  void (*add)(CLI::App&, Verbs&);
  const char* example;  // for its --help and the manual page
};
// In the order of the work, which is that of --help.
constexpr Verb kVerbs[] = {
    {add_import, "palpate import rig.csv --units mm,N --tare auto --zero contact --out rec.csv"},
    {add_check, "palpate check rec.csv"},
    {add_fit, "palpate fit --recording rec.csv --out model.json"},
    {add_replay, "palpate replay --recording test.csv --model model.json --plot errors.svg"},
    {add_report, "palpate report --train rec.csv --test test.csv --out report"},
    {add_export, "palpate export model.json --c model.c"},
    {add_record, "palpate record --device bridge:/dev/ttyACM0 --guide --out rec.csv"},
    {add_synth, "palpate synth --material silicone --seed 1 --seconds 60 --out rec.csv"},
    {add_scenes, "palpate scenes"},
    {add_devices, "palpate devices"},
    {add_hard, "palpate hard --out hard"},
    {add_paper, "palpate paper --quick --out paper"},
    {add_study, "palpate study simulate --discriminate --out simulated"},
};

int fail(const std::string& message, int exit_code) {
  const std::string block = "error: " + printable(with_program_name(message), std::string::npos) + "\n";
  std::fflush(stdout);
  std::fwrite(block.data(), 1, block.size(), stderr);
  return exit_code;
}

// Prints the usage error as one line that refers to the verbs or to the verb's help.
int fail_usage(const CLI::App& app, const Verbs& verbs, std::string message) {
  for (char& letter : message)
    if (letter == '\n' || letter == '\r') letter = ' ';
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  if (chosen.empty()) {
    std::vector<std::string> names;
    for (const auto& [command, run] : verbs) names.push_back(command->get_name());
    return fail(message + "; known verbs: " + joined(names) + " (palpate --help explains)", kUsage);
  }
  // The page of the innermost verb has the option.
  std::string page = chosen.front()->get_name();
  for (auto inner = chosen.front()->get_subcommands(); !inner.empty(); inner = inner.front()->get_subcommands())
    page += " " + inner.front()->get_name();
  return fail(message + " (palpate " + page + " --help explains)", kUsage);
}

Status run_chosen(const Verbs& verbs) {
  for (const auto& [command, run] : verbs) {
    if (!command->parsed()) continue;
    if (const Status status = run(); !status) return status;
  }
  std::cout.flush();
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout)
    return Error{"cannot write the results to standard output"};
  return {};
}

// The first word that is not known, for which CLI11 would name a missing option or say "not expected":
// "unknown option --metod; did you mean --method?", "unknown verb "fti"; did you mean fit?"; empty if all are known.
std::string unknown_word(const CLI::App& app, const std::vector<std::string>& words) {
  const auto unknown = [](const std::string& what, const std::string& word, const std::string& dashes,
                          const std::vector<std::string>& known) {
    const std::string nearest = nearest_name(word, known);
    return "unknown " + what + (nearest.empty() ? "" : "; did you mean " + dashes + nearest + "?");
  };
  const CLI::App* verb = &app;
  for (const std::string& word : words) {
    if (word == "--") break;
    std::vector<std::string> known;
    if (word.rfind("--", 0) == 0) {
      const std::string name = word.substr(2, word.find('=') - 2);
      for (const CLI::Option* option : verb->get_options()) {
        known.insert(known.end(), option->get_lnames().begin(), option->get_lnames().end());
      }
      if (std::ranges::find(known, name) == known.end())
        return unknown("option --" + printable(name), name, "--", known);
      const CLI::Option* option = verb->get_option("--" + name);
      const bool last = &word == &words.back() || (&word)[1].starts_with("--");
      if (option->get_items_expected_min() > 0 && word.find('=') == std::string::npos && last)
        return "--" + name + ": found no value, expected one";
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

std::string version_text() {
  return "palpate " PALPATE_VERSION " (commit " PALPATE_COMMIT ", " + blas_name() + ", vectors " + simd::target_name() +
         ")";
}

// The examples of the first verbs, up to the report.
std::string joined_examples() {
  std::string text;
  for (const Verb& one : kVerbs) {
    text += (text.empty() ? "" : "\n  ") + std::string(one.example);
    if (one.add == add_report) break;
  }
  return text;
}

// `palpate help fit` is `palpate fit --help`.
std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.empty() || words.front() != "help") return words;
  words.erase(words.begin());
  words.push_back("--help");
  return words;
}

// `program`: as it was called.
int run_program(const std::string& program, const std::vector<std::string>& words) {
  CLI::App app("Palpate: data-driven haptic rendering, without a window", "palpate");
  app.set_version_flag("--version", version_text);
  Verbs verbs;
  for (const Verb& one : kVerbs) {
    one.add(app, verbs);
    verbs.back().first->footer(std::string("Example:\n  ") + one.example);
  }
  set_command_line(app, program, words);
  app.footer("Example, from a table to a model and its errors on another recording:\n  " + joined_examples());
  try {
    if (words.empty()) return fail_usage(app, verbs, "no verb given");
    app.require_subcommand(1);
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    const Status status = run_chosen(verbs);
    if (status) return kDone;
    // The exit code of a program that a signal has ended, as in a shell.
    return fail(status.error().message, stop_requested() != 0 ? 128 + stop_requested() : kFailed);
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknown_word(app, words);
    if (unknown.empty() && error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      app.exit(error);  // --help, --version and the lists that end a verb
      return std::cout.flush() ? kDone : fail("cannot write to standard output", kFailed);
    }
    return fail_usage(app, verbs, unknown.empty() ? error.what() : unknown);
  }
}

// Keeps freed memory in the process. A fit allocates and frees large blocks some hundred times; returning them to the
// system costs more than filling them (31,000 page faults in a fit of a minute's recording, 7,400 with this).
void keep_freed_memory() {
#if defined(__GLIBC__)
  constexpr int kKept = 64 << 20;
  mallopt(M_MMAP_THRESHOLD, kKept / 2);
  mallopt(M_TRIM_THRESHOLD, kKept);
  mallopt(M_ARENA_MAX, 1);  // threads share freed blocks; they rarely allocate at the same time
  mallopt(M_TOP_PAD, kKept);
#endif
}

}  // namespace
}  // namespace palpate::cli

int main(int argc, char** argv) {
  try {
    palpate::install_signal_handlers();
    palpate::prepare_blas();
    palpate::cli::keep_freed_memory();
    return palpate::cli::run_program(argc > 0 ? argv[0] : "palpate", palpate::cli::words_of(argc, argv));
  } catch (const std::bad_alloc&) {
    return palpate::cli::fail("out of memory", palpate::cli::kFailed);
  } catch (const std::exception& error) {
    return palpate::cli::fail(std::string("unexpected: ") + error.what(), palpate::cli::kFailed);
  }
}
