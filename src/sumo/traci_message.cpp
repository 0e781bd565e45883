#include "sumo/traci_message.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "base/error.h"

namespace sumogamma {
namespace {

constexpr std::size_t kFrameLength = 4;
constexpr int kDeepestCompound = 16;

[[noreturn]] void broken(const std::string& what) {
  throw SumoError("SUMO", "broken reply over TraCI: " + what + "; is the other side a SUMO?");
}

template <typename Word>
void append_big_endian(std::vector<std::uint8_t>& bytes, Word word) {
  std::uint8_t buffer[sizeof(Word)];
  for (std::size_t i = 0; i < sizeof(Word); ++i)
    buffer[i] = static_cast<std::uint8_t>(word >> (8 * (sizeof(Word) - 1 - i)));
  bytes.insert(bytes.end(), buffer, buffer + sizeof(Word));
}

template <typename Word>
Word big_endian(const std::uint8_t* bytes) {
  Word word = 0;
  for (std::size_t i = 0; i < sizeof(Word); ++i) word = static_cast<Word>((word << 8) | bytes[i]);
  return word;
}

}  // namespace

void TraciWriter::clear() {
  bytes_.assign(kFrameLength, 0);
  command_count_ = 0;
}

void TraciWriter::raw_integer(std::int32_t value) {
  append_big_endian(bytes_, static_cast<std::uint32_t>(value));
}

void TraciWriter::raw_double(double value) {
  append_big_endian(bytes_, std::bit_cast<std::uint64_t>(value));
}

void TraciWriter::raw_string(std::string_view value) {
  raw_integer(static_cast<std::int32_t>(value.size()));
  bytes_.insert(bytes_.end(), value.begin(), value.end());
}

void TraciWriter::typed_byte(std::uint8_t value) {
  raw_byte(traci::kTypeByte);
  raw_byte(value);
}

void TraciWriter::typed_integer(std::int32_t value) {
  raw_byte(traci::kTypeInteger);
  raw_integer(value);
}

void TraciWriter::typed_double(double value) {
  raw_byte(traci::kTypeDouble);
  raw_double(value);
}

void TraciWriter::typed_string(std::string_view value) {
  raw_byte(traci::kTypeString);
  raw_string(value);
}

void TraciWriter::typed_strings(const std::vector<std::string>& values) {
  raw_byte(traci::kTypeStringList);
  raw_integer(static_cast<std::int32_t>(values.size()));
  for (const std::string& value : values) raw_string(value);
}

void TraciWriter::compound(std::int32_t items) {
  raw_byte(traci::kTypeCompound);
  raw_integer(items);
}

void TraciWriter::begin_command(std::uint8_t command, std::size_t body_size) {
  ++command_count_;
  const std::size_t total = body_size + 2;
  if (total <= 255) {
    raw_byte(static_cast<std::uint8_t>(total));
  } else {
    raw_byte(0);
    raw_integer(static_cast<std::int32_t>(total + 4));
  }
  raw_byte(command);
}

void TraciWriter::get(std::uint8_t domain, std::uint8_t variable, std::string_view id) {
  begin_command(domain, 5 + id.size());
  raw_byte(variable);
  raw_string(id);
}

void TraciWriter::get(std::uint8_t domain, std::uint8_t variable, std::string_view id,
                      std::int32_t argument) {
  begin_command(domain, 5 + id.size() + 5);
  raw_byte(variable);
  raw_string(id);
  typed_integer(argument);
}

void TraciWriter::get(std::uint8_t domain, std::uint8_t variable, std::string_view id,
                      std::string_view argument) {
  begin_command(domain, 5 + id.size() + 5 + argument.size());
  raw_byte(variable);
  raw_string(id);
  typed_string(argument);
}

void TraciWriter::set_byte(std::uint8_t domain, std::uint8_t variable, std::string_view id,
                           std::uint8_t value) {
  begin_command(traci::set_command(domain), 5 + id.size() + 2);
  raw_byte(variable);
  raw_string(id);
  typed_byte(value);
}

void TraciWriter::set_integer(std::uint8_t domain, std::uint8_t variable, std::string_view id,
                              std::int32_t value) {
  begin_command(traci::set_command(domain), 5 + id.size() + 5);
  raw_byte(variable);
  raw_string(id);
  typed_integer(value);
}

void TraciWriter::set_pair(std::uint8_t domain, std::uint8_t variable, std::string_view id,
                           double first, double second) {
  begin_command(traci::set_command(domain), 1 + (4 + id.size()) + 5 + 9 + 9);
  raw_byte(variable);
  raw_string(id);
  compound(2);
  typed_double(first);
  typed_double(second);
}

void TraciWriter::set_double(std::uint8_t domain, std::uint8_t variable, std::string_view id,
                             double value) {
  begin_command(traci::set_command(domain), 5 + id.size() + 9);
  raw_byte(variable);
  raw_string(id);
  typed_double(value);
}

void TraciWriter::subscribe(std::uint8_t domain, std::string_view id,
                            std::span<const std::uint8_t> variables) {
  constexpr double kForEver = 1073741824.0;
  begin_command(traci::subscribe_command(domain), 8 + 8 + 4 + id.size() + 1 + variables.size());
  raw_double(-kForEver);
  raw_double(kForEver);
  raw_string(id);
  raw_byte(static_cast<std::uint8_t>(variables.size()));
  for (const std::uint8_t variable : variables) raw_byte(variable);
}

void TraciWriter::simulation_step() {
  begin_command(traci::kSimulationStep, 8);
  raw_double(0);
}

void TraciWriter::append(const TraciWriter& commands) {
  bytes_.insert(bytes_.end(), commands.bytes_.begin() + kFrameLength, commands.bytes_.end());
  command_count_ += commands.command_count_;
}

std::span<const std::uint8_t> TraciWriter::frame() {
  if (bytes_.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw SumoError("SUMO", "a message of more than 2 GB can't be sent over TraCI");
  std::vector<std::uint8_t> length;
  append_big_endian(length, static_cast<std::uint32_t>(bytes_.size()));
  std::memcpy(bytes_.data(), length.data(), kFrameLength);
  return bytes_;
}

void TraciReader::need(std::size_t count) const {
  if (count > remaining())
    broken(std::to_string(count) + " bytes expected, " + std::to_string(remaining()) + " left");
}

std::uint8_t TraciReader::byte() {
  need(1);
  return bytes_[position_++];
}

std::int32_t TraciReader::integer() {
  need(4);
  const auto value = static_cast<std::int32_t>(big_endian<std::uint32_t>(&bytes_[position_]));
  position_ += 4;
  return value;
}

double TraciReader::real() {
  need(8);
  const auto value = std::bit_cast<double>(big_endian<std::uint64_t>(&bytes_[position_]));
  position_ += 8;
  return value;
}

std::size_t TraciReader::count(std::size_t smallest_item) {
  const std::int32_t value = integer();
  if (value < 0) broken("a count of " + std::to_string(value));
  const auto items = static_cast<std::size_t>(value);
  if (items > remaining() / smallest_item)
    broken("a count of " + std::to_string(value) + " with " + std::to_string(remaining()) +
           " bytes left");
  return items;
}

std::string TraciReader::string() {
  const std::size_t length = count(1);
  std::string value(length, '\0');
  if (length > 0) std::memcpy(value.data(), &bytes_[position_], length);
  position_ += length;
  return value;
}

void TraciReader::expect_type(std::uint8_t type) {
  const std::uint8_t found = byte();
  if (found != type)
    broken("a value of type " + std::to_string(found) + " where type " + std::to_string(type) +
           " was expected");
}

std::int32_t TraciReader::typed_integer() {
  expect_type(traci::kTypeInteger);
  return integer();
}

double TraciReader::typed_double() {
  expect_type(traci::kTypeDouble);
  return real();
}

std::string TraciReader::typed_string() {
  expect_type(traci::kTypeString);
  return string();
}

std::vector<std::string> TraciReader::typed_strings() {
  expect_type(traci::kTypeStringList);
  const std::size_t items = count(4);
  std::vector<std::string> values;
  // an item takes at least its length field on the wire, but a std::string 8 times as much: grow
  // with what is read
  values.reserve(std::min<std::size_t>(items, 4096));
  for (std::size_t i = 0; i < items; ++i) values.push_back(string());
  return values;
}

std::int32_t TraciReader::compound() {
  expect_type(traci::kTypeCompound);
  return static_cast<std::int32_t>(count(1));
}

std::pair<double, double> TraciReader::typed_position() {
  const std::uint8_t type = byte();
  if (type != traci::kTypePosition2d && type != traci::kTypePosition3d)
    broken("a value of type " + std::to_string(type) + " where a position was expected");
  const double x = real();
  const double y = real();
  if (type == traci::kTypePosition3d) real();
  return {x, y};
}

void TraciReader::skip_value(int depth) {
  if (depth > kDeepestCompound) broken("compounds nested too deeply");
  const std::uint8_t type = byte();
  std::size_t bytes = 0;
  switch (type) {
    case traci::kTypePosition2d:
      bytes = 16;
      break;
    case traci::kTypePosition3d:
      bytes = 24;
      break;
    case traci::kTypeUByte:
    case traci::kTypeByte:
      bytes = 1;
      break;
    case traci::kTypeInteger:
    case traci::kTypeColor:
      bytes = 4;
      break;
    case traci::kTypeDouble:
      bytes = 8;
      break;
    case traci::kTypeString:
      string();
      return;
    case traci::kTypeDoubleList:
      bytes = 8 * count(8);
      break;
    case traci::kTypePolygon: {
      const std::uint8_t points = byte();
      bytes = 16 * (points != 0 ? points : count(16));
      break;
    }
    case traci::kTypeStringList:
      for (std::size_t left = count(4); left > 0; --left) string();
      return;
    case traci::kTypeCompound:
      for (std::size_t left = count(1); left > 0; --left) skip_value(depth + 1);
      return;
    default:
      broken("unknown value type " + std::to_string(type));
  }
  need(bytes);
  position_ += bytes;
}

std::size_t TraciReader::block_length(std::size_t slack) {
  std::size_t header = 1;
  std::size_t length = byte();
  if (length == 0) {
    header = 5;
    const std::int32_t extended = integer();
    if (extended <= 0) broken("a block length of " + std::to_string(extended));
    length = static_cast<std::size_t>(extended);
  }
  if (length <= header || length - header > remaining() + slack)
    broken("a block length of " + std::to_string(length) + " with " + std::to_string(remaining()) +
           " bytes left");
  return length - header;
}

TraciStatus TraciReader::status() {
  const std::size_t length = block_length();
  TraciReader block(bytes_.subspan(position_, length));
  position_ += length;
  TraciStatus status;
  status.command = block.byte();
  status.result = block.byte();
  status.text = block.string();
  return status;
}

TraciReader TraciReader::value(std::uint8_t domain, std::uint8_t variable) {
  const std::size_t length = block_length();
  TraciReader block(bytes_.subspan(position_, length));
  position_ += length;
  const std::uint8_t response = block.byte();
  const std::uint8_t found = block.byte();
  if (response != traci::get_response(domain) || found != variable)
    broken("an answer to another question");
  // the id comes back as it was sent: no need of a copy
  const std::size_t id_length = block.count(1);
  block.position_ += id_length;
  return block;
}

}  // namespace sumogamma
