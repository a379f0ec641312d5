// The answer of a report in words: made once, shown on the page, in report.json and on the terminal.
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <vector>

#include "scenes/report/measure.h"

namespace palpate {

// A part of a sentence. A number names its model and figure, so that
// tests/scenes/report/check_report.py can recompute it.
struct Words {
  std::string text;
  std::string model{};   // of a number, or of a name
  std::string figure{};  // of a number: "within_jnd"
};
using Sentence = std::vector<Words>;

Sentence answer(const ReportData& data);
std::string html_of(const Sentence& sentence);
std::string plain_text_of(const Sentence& sentence);

// Never more than it is: 99.996 % is 99.99 %.
std::string percent(double share);

}  // namespace palpate
