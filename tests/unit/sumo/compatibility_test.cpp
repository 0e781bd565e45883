#include "sumo/compatibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// SUMO's own schemas, of the SUMO that is installed.
class SumoSchemas : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* home = std::getenv("SUMO_HOME");
    folder_ = fs::path(home != nullptr ? home : "/usr/share/sumo") / "data/xsd";
    if (!fs::exists(folder_ / "sumoConfiguration.xsd"))
      GTEST_SKIP() << "no schemas of SUMO's in " << folder_;
  }
  std::set<std::string> names_in(const std::string& file, const std::string& what) const {
    std::set<std::string> names;
    const std::string text = content(folder_ / file);
    const std::regex name("xsd:" + what + " name=\"([^\"]+)\"");
    for (auto hit = std::sregex_iterator(text.begin(), text.end(), name);
         hit != std::sregex_iterator(); ++hit)
      names.insert((*hit)[1]);
    const std::regex include("xsd:include schemaLocation=\"([^\"]+)\"");
    for (auto hit = std::sregex_iterator(text.begin(), text.end(), include);
         hit != std::sregex_iterator(); ++hit)
      names.merge(names_in((*hit)[1], what));
    return names;
  }
  std::set<std::string> elements() const {
    std::set<std::string> names = names_in("routes_file.xsd", "element");
    names.merge(names_in("additional_file.xsd", "element"));
    return names;
  }
  std::set<std::string> options() const {
    std::set<std::string> names;
    const std::string text = content(folder_ / "sumoConfiguration.xsd");
    const std::regex name("xsd:element name=\"([^\"]+)\" type=\"\\w+OptionType\"");
    for (auto hit = std::sregex_iterator(text.begin(), text.end(), name);
         hit != std::sregex_iterator(); ++hit)
      names.insert((*hit)[1]);
    return names;
  }

  fs::path folder_;
};

TEST_F(SumoSchemas, EveryElementOfRouteAndAdditionalFilesHasARow) {
  ASSERT_GT(elements().size(), 80u);
  for (const std::string& name : elements())
    EXPECT_NE(find_compatibility(ScenarioPart::Element, name), nullptr) << name;
}

TEST_F(SumoSchemas, EveryOptionOfAConfigurationHasARow) {
  ASSERT_GT(options().size(), 300u);
  for (const std::string& name : options())
    EXPECT_NE(find_compatibility(ScenarioPart::Option, name), nullptr) << name;
}

TEST_F(SumoSchemas, NoRowIsAboutNothing) {
  const std::set<std::string> known_elements = elements(), known_options = options();
  std::set<std::string> attributes = names_in("routes_file.xsd", "attribute");
  attributes.merge(names_in("additional_file.xsd", "attribute"));
  for (const CompatibilityRow& row : compatibility_table()) {
    const std::string name(row.name);
    if (row.part == ScenarioPart::Element) {
      EXPECT_TRUE(known_elements.contains(name)) << name;
    } else if (row.part == ScenarioPart::Attribute) {
      const std::size_t point = name.find('.');
      ASSERT_NE(point, std::string::npos) << name;
      EXPECT_TRUE(known_elements.contains(name.substr(0, point))) << name;
      const std::size_t equals = name.find('=');
      EXPECT_TRUE(attributes.contains(name.substr(point + 1, equals - point - 1))) << name;
    } else if (row.part == ScenarioPart::Option && name.back() == '*') {
      EXPECT_TRUE(std::any_of(known_options.begin(), known_options.end(), [&](const auto& option) {
        return find_compatibility(ScenarioPart::Option, option) == &row;
      })) << name;
    } else if (row.part == ScenarioPart::Option) {
      EXPECT_TRUE(known_options.contains(name)) << name;
    }
  }
}

// the page shows the table and nothing else: "| `rerouter` | followed | ... |"
TEST(CompatibilityPage, ShowsTheTable) {
  std::set<std::string> expected, found;
  for (const CompatibilityRow& row : compatibility_table())
    expected.insert("| `" + std::string(row.name) + "` | " + std::string(name_of(row.treatment)) +
                    " | " + std::string(row.note) + (row.note.empty() ? "|" : " |"));
  std::ifstream page(fs::path(SUMOGAMMA_SOURCE_DIR) / "docs/compatibility.md");
  for (std::string line; std::getline(page, line);)
    if (line.rfind("| `", 0) == 0) found.insert(line);
  for (const std::string& line : expected) EXPECT_TRUE(found.contains(line)) << "missing: " << line;
  for (const std::string& line : found)
    EXPECT_TRUE(expected.contains(line)) << "not in the table: " << line;
}

TEST(FindCompatibility, TheLongestStartWins) {
  const auto treatment = [](const char* option) {
    return find_compatibility(ScenarioPart::Option, option)->treatment;
  };
  EXPECT_EQ(treatment("device.toc.probability"), Treatment::NotFollowed);
  EXPECT_EQ(treatment("device.ssm.range"), Treatment::FollowedBySumo);
  EXPECT_EQ(treatment("device.ssm.probability"), Treatment::Refused);
  EXPECT_EQ(treatment("mesosim"), Treatment::Refused);
  EXPECT_EQ(find_compatibility(ScenarioPart::Option, "no-such-option"), nullptr);
  EXPECT_EQ(find_compatibility(ScenarioPart::Element, "seed"), nullptr);
}

}  // namespace
}  // namespace sumogamma
