#include "osm/network_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "base/error.h"

namespace sumogamma::osm {
namespace {

TEST(LoadNetwork, AFileThatIsNoNetworkIsNamed) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("sumogamma_net_" + std::to_string(getpid()));
  for (const char* text : {"<net", "no XML", "<routes/>"}) {
    std::ofstream(file) << text;
    try {
      load_network(file);
      FAIL() << "accepted " << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(file.filename().string()), std::string::npos);
    }
  }
  std::filesystem::remove(file);
  EXPECT_THROW(load_network(file), Error);
}

}  // namespace
}  // namespace sumogamma::osm
