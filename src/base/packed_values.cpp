#include "base/packed_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sumogamma {
namespace {

/// How many numbers that a double could be lie between two of the same sign.
std::int64_t steps_between(double from, double to) {
  return std::bit_cast<std::int64_t>(to) - std::bit_cast<std::int64_t>(from);
}

bool fits(std::int64_t steps) {
  using Limits = std::numeric_limits<std::int16_t>;
  return steps >= Limits::min() && steps <= Limits::max();
}

}  // namespace

PackedValues::PackedValues(std::span<const double> values) : size_(values.size()) {
  blocks_.reserve((size_ + kBlock - 1) / kBlock);
  for (std::size_t begin = 0; begin < size_; begin += kBlock)
    append(values.subspan(begin, std::min(kBlock, size_ - begin)));
  near_.shrink_to_fit();
  any_.shrink_to_fit();
}

void PackedValues::append(std::span<const double> values) {
  const double first = values.front();
  const auto all = [&](auto holds) {
    return std::all_of(values.begin(), values.end(), [&](double value) {
      return std::signbit(value) == std::signbit(first) && holds(steps_between(first, value));
    });
  };
  if (all([](std::int64_t steps) { return steps == 0; })) {
    blocks_.push_back({first, 0, Kind::Same});
  } else if (all(fits)) {
    blocks_.push_back({first, static_cast<std::uint32_t>(near_.size()), Kind::Near});
    for (const double value : values)
      near_.push_back(static_cast<std::int16_t>(steps_between(first, value)));
  } else {
    blocks_.push_back({first, static_cast<std::uint32_t>(any_.size()), Kind::Any});
    any_.insert(any_.end(), values.begin(), values.end());
  }
}

std::vector<double> PackedValues::unpacked() const {
  std::vector<double> values(size_);
  for (std::size_t i = 0; i < size_; ++i) values[i] = (*this)[i];
  return values;
}

}  // namespace sumogamma
