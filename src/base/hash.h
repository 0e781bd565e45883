#pragma once

#include <cstdint>

namespace sumogamma {

inline constexpr std::uint64_t kFnvBasis = 0xcbf29ce484222325ULL;

/// One byte more in an FNV-1a hash of 64 bits (Fowler, Noll, Vo), which begins with kFnvBasis.
constexpr std::uint64_t fnv1a(std::uint64_t hash, unsigned char byte) {
  return (hash ^ byte) * 0x100000001b3ULL;
}

}  // namespace sumogamma
