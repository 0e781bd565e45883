#include "base/error.h"

#include <gtest/gtest.h>

namespace sumogamma {
namespace {

TEST(Error, SaysWhereAndThenWhat) {
  const Error error("town.osm", "no roads in it, expected at least one highway");
  EXPECT_STREQ(error.what(), "town.osm: no roads in it, expected at least one highway");
}

// main() tells exit code 3 from 2 by the type, so SUMO's failures must be caught as themselves and
// as errors
TEST(Error, SumosFailureIsAnErrorOfItsOwnKind) {
  EXPECT_THROW(throw SumoError("sumo", "gone"), SumoError);
  EXPECT_THROW(throw SumoError("sumo", "gone"), Error);
  try {
    throw Error("--agents", "0 is too few, expected 1 or more");
  } catch (const SumoError&) {
    FAIL() << "a user's mistake was taken for SUMO's";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "--agents: 0 is too few, expected 1 or more");
  }
}

TEST(Error, IsOneLineWhateverItQuotes) {
  EXPECT_STREQ(Error("a\nb.toml:3", "'\x1b[31m\r\t\x7f' is no number").what(),
               "a b.toml:3: ' [31m   ' is no number");
  EXPECT_STREQ(Error("Straße.toml", "is empty").what(), "Straße.toml: is empty");
}

}  // namespace
}  // namespace sumogamma
