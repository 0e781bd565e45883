#include "io/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "base/error.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string complaint(const fs::path& folder, bool force = false) {
  try {
    const OutputFolder output(folder, force);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(OutputFolder, BelongsToOneRun) {
  const TemporaryFolder folder;
  {
    const OutputFolder mine(folder.file("out"), false);
    EXPECT_THAT(complaint(folder.file("out")), HasSubstr("another run writes into it"));
    EXPECT_THAT(complaint(folder.file("out"), true), HasSubstr("another run writes into it"));
    EXPECT_EQ(complaint(folder.file("other")), "");
  }
  EXPECT_EQ(complaint(folder.file("out")), "");
}

TEST(OutputFolder, KeepsWhatAnotherRunLeft) {
  const TemporaryFolder folder;
  folder.write("trips.csv", "agent");
  folder.write("replay.html", "old");
  folder.write("mine.txt", "kept");
  EXPECT_THAT(complaint(folder.file("")), HasSubstr("--force"));
  EXPECT_EQ(folder.read("trips.csv"), "agent");
  EXPECT_EQ(complaint(folder.file(""), true), "");
  // a page of the other run would pass for this one's
  EXPECT_FALSE(fs::exists(folder.file("replay.html")));
  EXPECT_EQ(folder.read("mine.txt"), "kept");
}

TEST(OutputFolder, LeavesNothingWhereNothingWasWritten) {
  const TemporaryFolder folder;
  { const OutputFolder output(folder.file("out"), false); }
  EXPECT_FALSE(fs::exists(folder.file("out")));
  {
    const OutputFolder output(folder.file("out"), false);
    folder.write("out/results.json", "{}");
  }
  EXPECT_TRUE(fs::exists(folder.file("out")));
}

TEST(RequirePageName, APageReplacesPagesAlone) {
  const TemporaryFolder folder;
  folder.write("results.json", "{}");
  folder.write("page.html", "<html>");
  EXPECT_THROW(require_page_name(folder.file("results.json")), Error);
  require_page_name(folder.file("page.html"));
  require_page_name(folder.file("new"));
}

}  // namespace
}  // namespace sumogamma
