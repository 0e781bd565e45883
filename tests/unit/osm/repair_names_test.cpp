#include "osm/repair_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "base/error.h"

namespace sumogamma::osm {
namespace {

TEST(RepairNames, AreUnique) {
  RepairSet names;
  for (const RepairName& repair : all_repairs())
    EXPECT_TRUE(names.insert(std::string(repair.name)).second) << repair.name;
}

TEST(RepairNames, AnUnknownOneIsRefusedWithTheNearest) {
  EXPECT_NO_THROW(check_names({"bends", "kerbs", "swallowed-roads"}));
  try {
    check_names({"bends", "curbs"});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("curbs"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("kerbs?"));
  }
}

TEST(RepairNames, TheTableInTheDocumentationIsThisOne) {
  std::ifstream stream(SUMOGAMMA_SOURCE_DIR "/docs/import.md");
  std::ostringstream text;
  text << stream.rdbuf();
  std::string table;
  for (const RepairName& repair : all_repairs())
    table += "| `" + std::string(repair.name) + "` | " + std::string(repair.mends) + " |\n";
  EXPECT_THAT(text.str(), ::testing::HasSubstr(table)) << "it should be:\n" << table;
}

}  // namespace
}  // namespace sumogamma::osm
