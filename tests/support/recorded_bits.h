#pragma once

#include "base/hash.h"

namespace sumogamma::test {

inline constexpr const char* kOtherLibrary =
    "the recorded bits are those of Debian 12's C library with fused multiply-add";

/// Does the C library compute as where the hashes of exact bits were recorded: Debian 12's, on a
/// processor with fused multiply-add? On one without, or another library, last bits of sines and
/// the like differ, and after some seconds all others do.
inline bool computes_as_recorded() { return hash_of_math_library() == 4397087597476203744ULL; }

}  // namespace sumogamma::test
