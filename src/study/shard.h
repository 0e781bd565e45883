#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sumogamma {

/// Part i of n (1 <= i <= n) of what is to be done, for several machines.
struct Shard {
  std::size_t part = 1, parts = 1;
};

/// "2/4"; all of it for an empty text. Throws Error naming --shard.
Shard parse_shard(const std::string& text);

/// That part of a list, its entries by turns: each is in exactly one part, whole numbers of them as
/// even as possible.
template <typename List>
auto shard_of(const List& all, Shard shard) {
  std::vector<typename List::value_type> part;
  for (std::size_t i = shard.part - 1; i < all.size(); i += shard.parts) part.push_back(all[i]);
  return part;
}

}  // namespace sumogamma
