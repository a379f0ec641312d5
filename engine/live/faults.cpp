#include "engine/live/faults.h"

namespace palpate {

std::vector<std::string> alarm_words(FaultSource source, std::uint32_t bits) {
  std::vector<std::string> words;
  for (const Fault& fault : kFaults) {
    if (fault.alarm && fault.source == source && (bits & fault.bit) != 0) words.emplace_back(fault.sentence);
  }
  return words;
}

}  // namespace palpate
