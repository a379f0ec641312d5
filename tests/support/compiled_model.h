// Compiles an exported C file with the options of a microcontroller's compiler and loads it.
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "models/export/export_c.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate::test {

// A compiled file. Real: float or double, the type of the numbers in the export.
template <typename Real>
class CompiledModel {
 public:
  CompiledModel(const ModelData& data, const SensorSpec& sensor) {
    load(export_c(data, sensor, sizeof(Real) == sizeof(float)));
  }
  // Compiles and loads the output of `palpate export`.
  explicit CompiledModel(const std::string& text) { load(text); }

  // The force at a time; in single precision by steps, which are computed here as a board would from its clock.
  Real force(double time_s, Real position_m) const {
    if constexpr (sizeof(Real) > sizeof(float)) return force_at(time_s, position_m);
    const double step_s = time_s - std::exchange(last_s_, time_s);
    return force_after(static_cast<Real>(step_s), position_m);
  }
  bool loaded() const { return force_after != nullptr; }

  Real (*force_at)(Real, Real) = nullptr;  // null in single precision
  Real (*force_after)(Real, Real) = nullptr;
  void (*reset)() = nullptr;
  int (*out_of_domain)() = nullptr;

 private:
  void load(const std::string& text) {
    const std::string source = folder_.with_file("model.c", text);
    const std::string library = folder_.file("model.so");
    const auto run = run_program({PALPATE_C_COMPILER, "-std=c99", "-ffreestanding", "-O1", "-Wall", "-Wextra",
                                  "-Wpedantic", "-Wconversion", "-Wdouble-promotion", "-Werror", "-fPIC", "-shared",
                                  source, "-o", library, "-lm"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    library_.reset(dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL));
    EXPECT_NE(library_, nullptr);
    if (library_ == nullptr) return;
    force_at = reinterpret_cast<Real (*)(Real, Real)>(dlsym(library_.get(), "palpate_force"));
    force_after = reinterpret_cast<Real (*)(Real, Real)>(dlsym(library_.get(), "palpate_force_after"));
    reset = reinterpret_cast<void (*)()>(dlsym(library_.get(), "palpate_reset"));
    out_of_domain = reinterpret_cast<int (*)()>(dlsym(library_.get(), "palpate_out_of_domain"));
  }

  struct Close {
    void operator()(void* library) const { dlclose(library); }
  };
  TemporaryFolder folder_;
  mutable double last_s_ = 0.0;
  std::unique_ptr<void, Close> library_;
};

}  // namespace palpate::test
