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

}  // namespace
}  // namespace sumogamma
