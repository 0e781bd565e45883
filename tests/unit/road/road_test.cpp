#include "road/road.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "road/road_archive.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {
namespace fs = std::filesystem;

class RoadCacheTest : public ::testing::Test {
 protected:
  RoadCacheTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write(network_, testing::kSmallNet);
  }
  ~RoadCacheTest() override { fs::remove_all(folder_); }

  static void write(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
  }
  static std::string bytes_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  Road read(const RoadCache& cache) {
    Workers alone;
    return read_road(network_, cache, alone);
  }
  std::vector<fs::path> kept() const {
    std::vector<fs::path> files;
    if (fs::exists(cache_.folder))
      for (const auto& entry : fs::directory_iterator(cache_.folder)) files.push_back(entry.path());
    return files;
  }

  const fs::path folder_ =
      fs::temp_directory_path() /
      ("road_cache_" +
       std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
  const fs::path network_ = folder_ / "a.net.xml";
  const RoadCache cache_{folder_ / "deep" / "cache", 0};
};

TEST_F(RoadCacheTest, TheSameRoadIsReadFromIt) {
  const std::string worked_out = archive_of(read({}));
  EXPECT_EQ(archive_of(read(cache_)), worked_out);
  ASSERT_EQ(kept().size(), 1u);
  const auto written = fs::last_write_time(kept().front());
  const Road again = read(cache_);
  EXPECT_EQ(archive_of(again), worked_out);
  EXPECT_EQ(kept().size(), 1u);
  EXPECT_GE(fs::last_write_time(kept().front()), written);
  // what the bytes don't hold
  EXPECT_EQ(again.network.lane_by_name, read({}).network.lane_by_name);
  EXPECT_EQ(again.network.edge_by_name.at("out"), read({}).network.edge_by_name.at("out"));
  EXPECT_EQ(again.network.lanes.back().centerline.length(),
            read({}).network.lanes.back().centerline.length());
}

TEST_F(RoadCacheTest, AnotherNetworkIsReadAnew) {
  read(cache_);
  std::string other = testing::kSmallNet;
  other.replace(other.find("13.9"), 4, "11.1");
  write(network_, other);
  EXPECT_EQ(archive_of(read(cache_)), archive_of(read({})));
  EXPECT_EQ(kept().size(), 2u);
}

TEST_F(RoadCacheTest, WhatIsDamagedIsMadeAgain) {
  read(cache_);
  const std::string whole = bytes_of(kept().front());
  for (const std::string& damaged :
       {std::string(), whole.substr(0, 5), whole.substr(0, whole.size() / 2), whole + "x",
        std::string(whole.size(), 'x'), "x" + whole.substr(1)}) {
    write(kept().front(), damaged);
    EXPECT_EQ(archive_of(read(cache_)), archive_of(read({})));
    EXPECT_EQ(bytes_of(kept().front()), whole);
  }
}

TEST_F(RoadCacheTest, BytesThatArentWholeAreNoRoad) {
  const std::string whole = archive_of(read({}));
  ASSERT_TRUE(road_of(whole));
  EXPECT_FALSE(road_of(whole + "x"));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(road_of(std::string_view(whole).substr(0, size))) << size;
}

TEST_F(RoadCacheTest, DoesNoHarmWhereNothingCanBeKept) {
  write(folder_ / "deep", "a file where the folder should be");
  EXPECT_EQ(archive_of(read(cache_)), archive_of(read({})));
}

TEST_F(RoadCacheTest, SmallNetworksArentKept) {
  read({cache_.folder, 1 << 20});
  EXPECT_TRUE(kept().empty());
}

TEST_F(RoadCacheTest, KeepsWhatWasUsedLast) {
  fs::create_directories(cache_.folder);
  const fs::path old = cache_.folder / "0123456789abcdef.road", foreign = cache_.folder / "notes";
  write(old, std::string(1 << 16, ' '));
  write(foreign, "somebody's");
  fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(1));
  read({cache_.folder, 0, 1 << 16});
  EXPECT_FALSE(fs::exists(old));
  EXPECT_TRUE(fs::exists(foreign));
  EXPECT_EQ(kept().size(), 2u);
}

TEST_F(RoadCacheTest, AMissingNetworkIsAnErrorAsEver) {
  fs::remove(network_);
  EXPECT_THROW(read(cache_), Error);
}

}  // namespace
}  // namespace sumogamma
