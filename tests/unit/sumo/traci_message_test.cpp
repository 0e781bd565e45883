#include "sumo/traci_message.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"

namespace sumogamma {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(TraciWriter, WritesTheLayoutOfTheProtocol) {
  TraciWriter message;
  message.get(traci::kVehicle, traci::kSpeed, "v1");
  message.simulation_step();
  const Bytes expected = {0,  0,    0,    0x17,                         // total length 23
                          9,  0xa4, 0x40, 0,    0, 0, 2, 'v', '1',      // get the speed of v1
                          10, 0x02, 0,    0,    0, 0, 0, 0,   0,   0};  // one step
  const auto frame = message.frame();
  EXPECT_EQ(Bytes(frame.begin(), frame.end()), expected);
  EXPECT_EQ(message.command_count(), 2u);
}

TEST(TraciWriter, UsesTheLongFormBeyond255Bytes) {
  TraciWriter message;
  const std::string just_fits(248, 'x'), too_long(249, 'x');
  message.get(traci::kVehicle, traci::kSpeed, just_fits);
  EXPECT_EQ(message.frame()[4], 255);
  message.clear();
  message.get(traci::kVehicle, traci::kSpeed, too_long);
  const auto frame = message.frame();
  EXPECT_EQ(frame[4], 0);
  // the length counts its own five bytes
  EXPECT_EQ(TraciReader(frame.subspan(5, 4)).integer(), 260);
  EXPECT_EQ(frame.size(), 4u + 260u);
}

TEST(TraciWriter, AppendsAnotherWritersCommands) {
  TraciWriter both, one, other;
  one.get(traci::kVehicle, traci::kSpeed, "a");
  other.set_double(traci::kVehicle, traci::kSpeed, "b", 1.5);
  both.append(one);
  both.append(other);
  EXPECT_EQ(both.command_count(), 2u);
  EXPECT_EQ(both.frame().size(), one.frame().size() + other.frame().size() - 4);
}

TEST(TraciReader, ReadsBackWhatWasWritten) {
  TraciWriter message;
  message.typed_double(-1.25);
  message.typed_integer(-7);
  message.typed_string("\xc3\xa9 \" \n");
  message.compound(3);
  TraciReader reader(message.frame().subspan(4));
  EXPECT_EQ(reader.typed_double(), -1.25);
  EXPECT_EQ(reader.typed_integer(), -7);
  EXPECT_EQ(reader.typed_string(), "\xc3\xa9 \" \n");
  EXPECT_EQ(reader.remaining(), 5u);
  EXPECT_THROW(reader.compound(), SumoError);  // three items can't be in no bytes
}

TEST(TraciReader, RefusesAnotherTypeThanExpected) {
  const Bytes integer = {traci::kTypeInteger, 0, 0, 0, 1, 0, 0, 0, 0};
  EXPECT_THROW(TraciReader(integer).typed_double(), SumoError);
  EXPECT_THROW(TraciReader(integer).typed_string(), SumoError);
  EXPECT_THROW(TraciReader(integer).typed_strings(), SumoError);
  EXPECT_THROW(TraciReader(integer).typed_position(), SumoError);
  EXPECT_THROW(TraciReader(integer).compound(), SumoError);
  EXPECT_EQ(TraciReader(integer).typed_integer(), 1);
}

TEST(TraciReader, RefusesCountsBeyondWhatIsThere) {
  const Bytes huge_string = {traci::kTypeString, 0x7f, 0xff, 0xff, 0xff, 'x'};
  EXPECT_THROW(TraciReader(huge_string).typed_string(), SumoError);
  const Bytes negative_string = {traci::kTypeString, 0xff, 0xff, 0xff, 0xff, 'x'};
  EXPECT_THROW(TraciReader(negative_string).typed_string(), SumoError);
  const Bytes huge_list = {traci::kTypeStringList, 0x7f, 0xff, 0xff, 0xff, 0, 0, 0, 0};
  EXPECT_THROW(TraciReader(huge_list).typed_strings(), SumoError);
  const Bytes huge_doubles = {traci::kTypeDoubleList, 0x7f, 0xff, 0xff, 0xff};
  EXPECT_THROW(TraciReader(huge_doubles).skip_value(), SumoError);
  const Bytes unknown = {0x77, 0, 0, 0, 0};
  EXPECT_THROW(TraciReader(unknown).skip_value(), SumoError);
}

TEST(TraciReader, ChecksBlockLengths) {
  EXPECT_EQ(TraciReader(Bytes{3, 1, 2}).block_length(), 2u);
  EXPECT_THROW(TraciReader(Bytes{4, 1, 2}).block_length(), SumoError);  // one byte too few
  EXPECT_EQ(TraciReader(Bytes{4, 1, 2}).block_length(4), 3u);           // within the known fault
  EXPECT_THROW(TraciReader(Bytes{1, 1}).block_length(), SumoError);     // no room for anything
  EXPECT_THROW(TraciReader(Bytes{0, 0, 0, 0, 0, 9}).block_length(), SumoError);
  EXPECT_THROW(TraciReader(Bytes{0, 0, 0, 0, 5, 9}).block_length(), SumoError);
  EXPECT_EQ(TraciReader(Bytes{0, 0, 0, 0, 6, 9}).block_length(), 1u);
  EXPECT_THROW(TraciReader(Bytes{0, 0x80, 0, 0, 0, 9}).block_length(), SumoError);
  EXPECT_THROW(TraciReader(Bytes{}).block_length(), SumoError);
}

TEST(TraciReader, SkipsEveryTypeByItsSize) {
  TraciWriter message;
  message.compound(4);
  message.typed_string("abc");
  message.typed_double(1);
  message.compound(1);
  message.typed_byte(3);
  message.typed_integer(4);
  message.raw_byte(traci::kTypePolygon);
  message.raw_byte(2);
  for (int i = 0; i < 4; ++i) message.raw_double(0);
  message.raw_byte(traci::kTypeColor);
  message.raw_integer(0);
  message.typed_string("end");
  TraciReader reader(message.frame().subspan(4));
  for (int i = 0; i < 3; ++i) reader.skip_value();
  EXPECT_EQ(reader.typed_string(), "end");
  EXPECT_EQ(reader.remaining(), 0u);
}

TEST(TraciReader, RefusesCompoundsWithoutEnd) {
  Bytes nested;
  for (int i = 0; i < 1000; ++i) {
    const Bytes level = {traci::kTypeCompound, 0, 0, 0, 1};
    nested.insert(nested.end(), level.begin(), level.end());
  }
  EXPECT_THROW(TraciReader(nested).skip_value(), SumoError);
}

TEST(TraciReader, ReadsAStatusAndAnAnswer) {
  const Bytes reply = {7,  0xa4, 0,    0, 0, 0, 0,                                           // fine
                       17, 0xb4, 0x40, 0, 0, 0, 1, 'v', 0x0b, 0x3f, 0xf0, 0, 0, 0, 0, 0, 0,  // 1.0
                       9,  0xa4, 0xff, 0, 0, 0, 2, 'n', 'o'};
  TraciReader reader(reply);
  EXPECT_TRUE(reader.status().ok());
  EXPECT_EQ(reader.value(traci::kVehicle, traci::kSpeed).typed_double(), 1.0);
  const TraciStatus refused = reader.status();
  EXPECT_FALSE(refused.ok());
  EXPECT_EQ(refused.text, "no");
  EXPECT_EQ(reader.remaining(), 0u);
  TraciReader other{std::span<const std::uint8_t>(reply).subspan(7)};
  EXPECT_THROW(other.value(traci::kPerson, traci::kSpeed), SumoError);
}

// law: whatever the bytes, reading ends with a value or a SumoError, within the bytes (the
// sanitizers watch)
TEST(TraciReader, SurvivesAnyBytes) {
  const std::uint8_t types[] = {0x01, 0x03, 0x06, 0x07, 0x08, 0x09,
                                0x0b, 0x0c, 0x0e, 0x0f, 0x10, 0x11};
  int values = 0, errors = 0;
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Bytes bytes;
    const std::uint64_t size = random_bits(seed, 0, 0, Draw::Demand) % 60;
    for (std::uint64_t i = 0; i < size; ++i) {
      const std::uint64_t bits = random_bits(seed, 1, i, Draw::Demand);
      // small numbers and type bytes are likelier to get far
      bytes.push_back(bits % 3 == 0   ? types[(bits >> 8) % std::size(types)]
                      : bits % 3 == 1 ? std::uint8_t{0}
                                      : static_cast<std::uint8_t>(bits >> 16));
    }
    TraciReader reader(bytes);
    try {
      switch (seed % 5) {
        case 0:
          reader.skip_value();
          break;
        case 1:
          reader.status();
          break;
        case 2:
          reader.typed_strings();
          break;
        case 3:
          reader.typed_string();
          break;
        default:
          reader.value(traci::kVehicle, 0);
      }
      ++values;
    } catch (const SumoError&) {
      ++errors;
    }
  }
  EXPECT_GT(values, 100);
  EXPECT_GT(errors, 100);
}

}  // namespace
}  // namespace sumogamma
