#pragma once

#include <cstdint>
#include <cstring>
#include <string>
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

/// A hash of 64 bits, eight bytes at a time, for files: this machine's own, as FNV-1a takes long
/// over many megabytes.
inline std::uint64_t hash_of_bytes(std::string_view bytes) {
  std::uint64_t hash = kFnvBasis ^ bytes.size();
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t count = bytes.size() < sizeof word ? bytes.size() : sizeof word;
    std::memcpy(&word, bytes.data(), count);
    bytes.remove_prefix(count);
    hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 29;
  }
  return hash;
}

/// 16 hexadecimal digits.
std::string hash_text(std::uint64_t hash);

/// Differs where sines and the like have other last bits: another version of the C library, or a
/// processor without fused multiply-add.
std::uint64_t hash_of_math_library();

}  // namespace sumogamma
