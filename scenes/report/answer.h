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

class Sentence {
 public:
  Sentence& operator<<(const std::string& text) { return *this << SentencePart{text}; }
  Sentence& operator<<(const SentencePart& part) {
    parts_.push_back(part);
    return *this;
  }
  std::string html() const;
  std::string plain_text() const;

 private:
  std::vector<SentencePart> parts_;
};

Sentence answer(const ReportData& data);

// Two decimals, rounded down: 99.996 % is "99.99 %".
std::string percent(double share);

}  // namespace palpate
