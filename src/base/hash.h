#pragma once

#include <cstdint>
#include <string_view>

namespace sumogamma {

inline constexpr std::uint64_t kFnvBasis = 0xcbf29ce484222325ULL;

/// One byte more in an FNV-1a hash of 64 bits (Fowler, Noll, Vo), which begins with kFnvBasis.
constexpr std::uint64_t fnv1a(std::uint64_t hash, unsigned char byte) {
  return (hash ^ byte) * 0x100000001b3ULL;
}

/// The same hash of a whole text.
constexpr std::uint64_t fnv1a(std::string_view text) {
  std::uint64_t hash = kFnvBasis;
  for (const char letter : text) hash = fnv1a(hash, static_cast<unsigned char>(letter));
  return hash;
}

}  // namespace sumogamma
