// The answer of a report in words, which page, report.json and terminal show.
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <vector>

#include "scenes/report/measure.h"

namespace palpate {

// A part of a sentence: text, a model's name, or a number. A number has its model and figure of merit, so that
// tests/scenes/report/check_report.py can recompute it.
struct SentencePart {
  std::string text;
  std::string model{};   // name of the model; empty for text
  std::string figure{};  // figure of merit of a number, e.g. "within_jnd"; else empty
};
using Sentence = std::vector<SentencePart>;

Sentence answer(const ReportData& data);
std::string html_of(const Sentence& sentence);
std::string plain_text_of(const Sentence& sentence);

// Two decimals, rounded down: 99.996 % is "99.99 %".
std::string percent(double share);

}  // namespace palpate
