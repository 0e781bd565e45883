#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.h"
#include "base/random.h"
#include "road/lane_locator.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

/// The text with a few places damaged: bytes changed, pieces dropped or doubled.
std::string damage(std::string text, std::uint64_t seed) {
  const std::uint64_t faults = 1 + random_bits(seed, 0, 0, Draw::Demand) % 4;
  for (std::uint64_t fault = 1; fault <= faults; ++fault) {
    const std::size_t at = random_bits(seed, fault, 0, Draw::Demand) % text.size();
    const std::size_t size = 1 + random_bits(seed, fault, 1, Draw::Demand) % 40;
    switch (random_bits(seed, fault, 2, Draw::Demand) % 4) {
      case 0:
        text[at] = static_cast<char>(random_bits(seed, fault, 3, Draw::Demand));
        break;
      case 1:
        text.erase(at, size);
        break;
      case 2:
        text.insert(at, text.substr(at, size));
        break;
      default:
        // a digit elsewhere: numbers out of order, indices out of range
        for (std::size_t i = at; i < text.size(); ++i)
          if (text[i] >= '0' && text[i] <= '9') {
            text[i] = static_cast<char>('0' + random_bits(seed, fault, 4, Draw::Demand) % 10);
            break;
          }
    }
  }
  return text;
}

// law: a damaged network is either read into one that every index of is valid, or refused by an
// Error that names it
TEST(NetReaderProperty, DamageIsRefusedOrHarmless) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("sumogamma_damaged_" + std::to_string(getpid()) + ".net.xml");
  int refused = 0, accepted = 0;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(seed);
    std::ofstream(file, std::ios::binary) << damage(testing::kSmallNet, seed);
    try {
      const RoadNetwork net = read_sumo_net(file);
      ++accepted;
      for (const Connection& connection : net.connections) {
        ASSERT_LT(index_of(connection.from), net.lanes.size());
        ASSERT_LT(index_of(connection.to), net.lanes.size());
        ASSERT_LT(index_of(connection.junction), net.junctions.size());
      }
      const LaneLocator locator(net);
      std::vector<LaneHit> hits;
      locator.find_containing({50, 0}, hits);
      locator.find_nearest({50, 0}, vehicle_class::kAll, 0.0);
    } catch (const Error& error) {
      ++refused;
      ASSERT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
    }
  }
  std::filesystem::remove(file);
  EXPECT_GT(refused, 100);
  EXPECT_GT(accepted, 100);
}

}  // namespace
}  // namespace sumogamma
