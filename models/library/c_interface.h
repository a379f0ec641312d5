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

// The caller's buffer for one text; `text` may be null.
struct TextBuffer {
  char* text = nullptr;
  std::size_t size = 0;

  // Writes as much of `message` as fits, in whole UTF-8 characters, with a terminating zero.
  void write(std::string_view message) const noexcept {
    if (text == nullptr || size == 0) return;
    std::size_t count = message.size() < size ? message.size() : size - 1;
    if (count < message.size()) {
      while (count > 0 && (static_cast<unsigned char>(message[count]) & 0xC0U) == 0x80U) --count;
    }
    message.copy(text, count);
    text[count] = '\0';
  }
};

// Returns the value of the Result that `work` returns, or `failed` if it has an error or `work` throws, with the text
// of the error at `buffer`. Without an error the text is empty.
template <typename T, typename Work>
T guarded(T failed, TextBuffer buffer, Work&& work) noexcept {
  buffer.write("");
  try {
    const Result<T> done = work();
    if (done) return *done;
    buffer.write(done.error().message);
  } catch (const std::bad_alloc&) {
    buffer.write("out of memory");
  } catch (const std::exception& error) {
    buffer.write(error.what());
  } catch (...) {
    buffer.write("unexpected: an exception that is not a std::exception");
  }
  return failed;
}

// For functions that return a handle, or null after an error.
template <typename T, typename Work>
T* made(char* error, std::size_t error_size, Work&& work) noexcept {
  return guarded<T*>(nullptr, {error, error_size}, std::forward<Work>(work));
}

// For functions that return 0, or -1 after an error. `work` returns a Status.
template <typename Work>
int status_of(char* error, std::size_t error_size, Work&& work) noexcept {
  return guarded<int>(-1, {error, error_size}, [&]() -> Result<int> {
    const Status status = work();
    if (!status) return status.error();
    return 0;
  });
}

}  // namespace palpate::library
