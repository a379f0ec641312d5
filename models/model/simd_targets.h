// The instruction sets for which Highway does not compile the loops; to be included before its headers. AVX3_DL adds
// nothing that these loops use; processors with SSSE3 but without SSE4 are older than ten years. SVE vectors have no
// size at compile time and cannot be stored in arrays; every arm64 machine has NEON.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
