#include "base/staged_folder.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"

namespace sumogamma {
namespace {
namespace fs = std::filesystem;

class StagedFolderTest : public ::testing::Test {
 protected:
  StagedFolderTest() {
    root_ =
        fs::temp_directory_path() /
        ("staged_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  ~StagedFolderTest() override { fs::remove_all(root_); }
  static void put(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }
  static std::string get(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  fs::path root_;
};

TEST_F(StagedFolderTest, AppearsOnCommitAndNotBefore) {
  StagedFolder folder(root_ / "a" / "b");
  put(folder.path() / "file", "text");
  EXPECT_FALSE(fs::exists(root_ / "a" / "b"));
  folder.commit();
  EXPECT_EQ(get(root_ / "a" / "b" / "file"), "text");
}

TEST_F(StagedFolderTest, LeavesNothingWithoutCommit) {
  {
    StagedFolder folder(root_ / "a" / "b" / "c");
    put(folder.path() / "file", "text");
  }
  EXPECT_TRUE(fs::is_empty(root_));
}

TEST_F(StagedFolderTest, RefusesAFolderThatIsNotEmpty) {
  put(root_ / "mine", "precious");
  EXPECT_THROW(StagedFolder folder(root_), Error);
  EXPECT_EQ(get(root_ / "mine"), "precious");
}

TEST_F(StagedFolderTest, RefusesAFile) {
  put(root_ / "mine", "precious");
  EXPECT_THROW(StagedFolder folder(root_ / "mine"), Error);
  EXPECT_THROW(StagedFolder folder(root_ / "mine" / "below"), Error);
  EXPECT_EQ(get(root_ / "mine"), "precious");
}

TEST_F(StagedFolderTest, ReplacesOnlyItsOwnFiles) {
  fs::create_directory(root_ / "out");
  put(root_ / "out" / "file", "old");
  put(root_ / "out" / "results", "kept");
  StagedFolder folder(root_ / "out", true);
  put(folder.path() / "file", "new");
  EXPECT_EQ(get(root_ / "out" / "file"), "old");
  folder.commit();
  EXPECT_EQ(get(root_ / "out" / "file"), "new");
  EXPECT_EQ(get(root_ / "out" / "results"), "kept");
}

TEST_F(StagedFolderTest, TakesATrailingSlash) {
  StagedFolder folder((root_ / "out").string() + "/");
  put(folder.path() / "file", "text");
  folder.commit();
  EXPECT_EQ(get(root_ / "out" / "file"), "text");
}

}  // namespace
}  // namespace sumogamma
