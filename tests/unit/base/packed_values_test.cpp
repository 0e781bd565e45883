#include "base/packed_values.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace sumogamma {
namespace {

void expect_the_same_bits(const std::vector<double>& values) {
  const PackedValues packed(values);
  ASSERT_EQ(packed.size(), values.size());
  EXPECT_EQ(packed.empty(), values.empty());
  const std::vector<double> unpacked = packed.unpacked();
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(packed[i]), std::bit_cast<std::uint64_t>(values[i]));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(unpacked[i]), std::bit_cast<std::uint64_t>(values[i]));
  }
}

TEST(PackedValues, HoldTheVeryBits) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  expect_the_same_bits({});
  expect_the_same_bits({1.5});
  expect_the_same_bits(std::vector<double>(50, 13.9));
  expect_the_same_bits({0.0, -0.0, 1e-300, -1e-300, kInfinity, -kInfinity, std::nan("")});
  expect_the_same_bits({1.0, std::nextafter(1.0, 2.0), std::nextafter(1.0, 0.0)});
  std::vector<double> mixed;
  for (int i = 0; i < 1000; ++i) {
    // steady, noisy, noisy across the range of what is near, a ramp
    const double noise = std::sin(12.9898 * i), scale = i < 250 ? 0.0 : i < 500 ? 1e-13 : 8e-12;
    mixed.push_back(i < 750 ? 13.9 * (1.0 + scale * noise) : 0.1 * i);
  }
  expect_the_same_bits(mixed);
}

TEST(PackedValues, TheLastBlockMayBeShort) {
  for (std::size_t size = 14; size < 36; ++size) {
    std::vector<double> values;
    for (std::size_t i = 0; i < size; ++i) values.push_back(1.0 + 1e-14 * static_cast<double>(i));
    expect_the_same_bits(values);
  }
}

}  // namespace
}  // namespace sumogamma
