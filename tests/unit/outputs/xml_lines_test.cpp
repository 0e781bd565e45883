#include "outputs/xml_lines.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

TEST(XmlLines, AreReadAndWrittenAsTheyWere) {
  const std::string text = "        <ride id=\"a&amp;b &lt;\" depart=\"1.00\" x=\"\"/>";
  XmlLine line = parse_line(text);
  EXPECT_EQ(line.element, "ride");
  EXPECT_TRUE(line.closed);
  EXPECT_EQ(line.get("id"), "a&b <");
  EXPECT_EQ(line.number("depart"), 1.0);
  EXPECT_EQ(line.number("x", -3.0), -3.0);
  EXPECT_TRUE(line.has("x"));
  EXPECT_FALSE(line.has("y"));
  EXPECT_EQ(text_of(line), text);
  line.set("y", "1");
  line.set("x", "<");
  EXPECT_EQ(text_of(line), "        <ride id=\"a&amp;b &lt;\" depart=\"1.00\" x=\"&lt;\"/>");
}

TEST(XmlLines, OtherLinesAreNoElements) {
  for (const char* text : {"", "    </step>", "<!-- <a/> -->", "<?xml version=\"1.0\"?>", "words",
                           "<", "    <half id=\"1"})
    EXPECT_EQ(parse_line(text).element, "") << text;
}

std::string copied(const std::string& text) {
  const TemporaryFolder folder;
  folder.write("in.xml", text);
  copy_lines(folder.file("in.xml"), folder.file("out.xml"), [](XmlLine& line) {
    if (line.element == "drop") return LineFate::Drop;
    if (line.element != "set") return LineFate::Keep;
    line.set("a", "2");
    return LineFate::Rewrite;
  });
  return folder.read("out.xml");
}

TEST(XmlLines, WhatIsDroppedIsDroppedWithWhatIsInIt) {
  EXPECT_EQ(copied("<!-- x\n<drop/>\n-->\n<r>\n    <drop>\n        <set a=\"1\"/>\n    </drop>\n"
                   "    <set a=\"1\"/>\n    <drop a=\"1\"/>\n</r>\n"),
            "<!-- x\n<drop/>\n-->\n<r>\n    <set a=\"2\"/>\n</r>\n");
}

TEST(XmlLines, AFileThatSumoDidNotEndIsEnded) {
  EXPECT_EQ(copied("<r>\n    <s>\n        <set a=\"1\"/>\n        <set a="),
            "<r>\n    <s>\n        <set a=\"2\"/>\n    </s>\n</r>\n");
  EXPECT_EQ(copied(""), "");
}

}  // namespace
}  // namespace sumogamma
