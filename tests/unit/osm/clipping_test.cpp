#include "osm/clipping.h"

#include <gtest/gtest.h>

namespace sumogamma::osm {
namespace {

ClipperLib::Path square(double left, double low, double side) {
  return to_clipper(
      {{left, low}, {left + side, low}, {left + side, low + side}, {left, low + side}});
}

double area_of(const ClipperLib::Paths& paths) {
  double area = 0;
  for (const ClipperLib::Path& path : paths) area += ClipperLib::Area(path);
  return area / (kClipperScale * kClipperScale);
}

TEST(Without, TakesOffOneByOneWhatClipperTakesOffAtOnce) {
  // 10 000 squares of 3 m, a metre apart, over one of 100 m: far more than Clipper bears at once
  std::vector<ClipperLib::Paths> squares;
  for (int i = 0; i < 100; ++i)
    for (int k = 0; k < 100; ++k) squares.push_back({square(i, k, 3)});
  const ClipperLib::Paths left = without({square(-1, -1, 104)}, squares);
  EXPECT_NEAR(area_of(left), 104.0 * 104.0 - 102.0 * 102.0, 1e-6);
}

TEST(Without, HolesOfWhatIsTakenOffStay) {
  ClipperLib::Path hole = square(4, 4, 2);
  ClipperLib::ReversePath(hole);
  const std::vector<ClipperLib::Paths> ring(70, ClipperLib::Paths{square(0, 0, 10), hole});
  EXPECT_NEAR(area_of(without({square(2, 2, 6)}, ring)), 4.0, 1e-6);
  EXPECT_NEAR(area_of(without({square(2, 2, 6)}, {{square(20, 20, 5)}})), 36.0, 1e-6);
  EXPECT_TRUE(without({}, ring).empty());
}

}  // namespace
}  // namespace sumogamma::osm
