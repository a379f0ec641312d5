// Recordings that the reader must refuse, with the place and the parts of each message.
#pragma once

#include <string>
#include <vector>

namespace palpate::test {

struct BrokenRecording {
  const char* name;                // for the test's output
  std::string text;                // the file
  std::string place;               // line:column
  std::vector<std::string> parts;  // parts of the message, in this order: found, expected, advice
};

const std::vector<BrokenRecording>& broken_recordings();

// `count` good rows at 1 kHz from row number `first`, ended by `line_end`.
std::string good_rows(int count, int first = 0, const std::string& line_end = "\n");

// The header row for these rows, and a whole good file.
std::string good_header();
std::string good_recording();

}  // namespace palpate::test
