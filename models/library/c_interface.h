// The model handle of the C interface, and its error reports: text in the caller's buffer, never an exception.
// Thread guarantee: pure functions, any thread.
#pragma once

#include <cstddef>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/result.h"
#include "models/library/palpate/palpate.h"
#include "models/model/fitted_model.h"

struct palpate_model {
  explicit palpate_model(std::shared_ptr<const palpate::FittedModel> fitted, std::string report_json = {})
      : model(std::move(fitted)), report(std::move(report_json)) {
    for (const palpate::FeatureSpec& spec : model->features()) feature_names.push_back(palpate::feature_name(spec));
  }

  std::shared_ptr<const palpate::FittedModel> model;
  std::string report;
  std::vector<std::string> feature_names;
};

namespace palpate::library {

// The caller's buffer for one error message; `text` may be null.
struct ErrorBuffer {
  char* text = nullptr;
  std::size_t size = 0;

  // Returns 0, or -1 after writing the error's text, for functions that return a status.
  int report(const Status& status) const noexcept {
    if (status) return 0;
    fail(status.error().message);
    return -1;
  }

  // Writes as much of `message` as fits, in whole UTF-8 characters, with a terminating zero. Returns null, for
  // functions that return handles.
  std::nullptr_t fail(std::string_view message) const noexcept {
    if (text == nullptr || size == 0) return nullptr;
    std::size_t count = message.size() < size ? message.size() : size - 1;
    if (count < message.size()) {
      while (count > 0 && (static_cast<unsigned char>(message[count]) & 0xC0U) == 0x80U) --count;
    }
    message.copy(text, count);
    text[count] = '\0';
    return nullptr;
  }
};

// Returns the result of `work`, or `failed` if it throws, with the text at `buffer`. Without an error the text is
// empty.
template <typename T, typename Work>
T guarded(T failed, ErrorBuffer buffer, Work&& work) noexcept {
  buffer.fail("");
  try {
    return work(buffer);
  } catch (const std::bad_alloc&) {
    buffer.fail("out of memory");
  } catch (const std::exception& error) {
    buffer.fail(error.what());
  } catch (...) {
    buffer.fail("unexpected: an exception that is not a std::exception");
  }
  return failed;
}

}  // namespace palpate::library
