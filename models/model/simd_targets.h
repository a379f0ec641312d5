// The instruction sets that Highway does not compile our loops for; before its headers.
// AVX3_DL adds nothing these loops use; machines with SSSE3 but not SSE4 are older than
// ten years. Vectors of SVE have no size when they are compiled, so that no array can hold
// them: on arm64 there is NEON, which all of them have.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
