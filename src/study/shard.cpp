#include "study/shard.h"

#include <charconv>

#include "base/error.h"

namespace sumogamma {

Shard parse_shard(const std::string& text) {
  Shard shard;
  if (text.empty()) return shard;
  const char *const begin = text.data(), *const end = begin + text.size();
  const auto part = std::from_chars(begin, end, shard.part);
  const bool slash = part.ec == std::errc() && part.ptr != end && *part.ptr == '/';
  const auto parts = std::from_chars(slash ? part.ptr + 1 : end, end, shard.parts);
  if (!slash || parts.ec != std::errc() || parts.ptr != end || shard.part < 1 ||
      shard.part > shard.parts || shard.parts > 1000000)
    throw Error("--shard " + text.substr(0, 60),
                "must be i/n, part i from 1 to n: 1/4, 2/4, 3/4, 4/4");
  return shard;
}

}  // namespace sumogamma
