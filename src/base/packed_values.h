#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sumogamma {

/// A list of numbers, to the last bit, that takes a quarter of the room where neighbours are nearly
/// the same: in blocks, each value by how many numbers a double could be it is from the block's
/// first.
class PackedValues {
 public:
  PackedValues() = default;
  explicit PackedValues(std::span<const double> values);

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// Precondition: index < size().
  double operator[](std::size_t index) const {
    const Block& block = blocks_[index / kBlock];
    const std::size_t place = index % kBlock;
    switch (block.kind) {
      case Kind::Same:
        return block.first;
      case Kind::Near:
        return std::bit_cast<double>(std::bit_cast<std::int64_t>(block.first) +
                                     near_[block.begin + place]);
      default:
        return any_[block.begin + place];
    }
  }
  /// All of them.
  std::vector<double> unpacked() const;

 private:
  static constexpr std::size_t kBlock = 16;
  enum class Kind : std::uint32_t { Same, Near, Any };
  struct Block {
    double first;
    std::uint32_t begin;  ///< in near_ or any_
    Kind kind;
  };
  void append(std::span<const double> values);

  std::size_t size_ = 0;
  std::vector<Block> blocks_;
  std::vector<std::int16_t> near_;
  std::vector<double> any_;
};

}  // namespace sumogamma
