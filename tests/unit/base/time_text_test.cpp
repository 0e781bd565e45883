#include "base/time_text.h"

#include <gtest/gtest.h>

namespace sumogamma {
namespace {

TEST(ParseTime, ReadsSecondsAndClockTimes) {
  EXPECT_EQ(parse_time("90"), 90.0);
  EXPECT_EQ(parse_time(" 0.05 "), 0.05);
  EXPECT_EQ(parse_time("-1"), -1.0);
  EXPECT_EQ(parse_time("1:02:03"), 3723.0);
  EXPECT_EQ(parse_time("0:00:01.5"), 1.5);
  EXPECT_EQ(parse_time("2:00:00:10"), 2 * 86400.0 + 10);
  EXPECT_EQ(parse_time("-0:01:00"), -60.0);
}

TEST(ParseTime, RefusesWhatIsNoTime) {
  for (const char* text : {"", " ", "soon", "1s", "1:2", "1:2:3:4:5", "1:-2:3", "::", "nan", "inf",
                           "1e999", "--1", "1:2:"})
    EXPECT_FALSE(parse_time(text)) << text;
}

}  // namespace
}  // namespace sumogamma
