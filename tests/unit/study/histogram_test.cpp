#include "study/histogram.h"

#include <gtest/gtest.h>

#include <limits>

#include "study/coupling_metrics.h"

namespace sumogamma {
namespace {

TEST(Histogram, QuantilesAreExactToOneBin) {
  Histogram histogram(0.1, 200);
  for (int i = 1; i <= 1000; ++i) histogram.add(0.01 * i);
  EXPECT_NEAR(histogram.quantile(0.5), 5.0, 0.1);
  EXPECT_NEAR(histogram.quantile(0.95), 9.5, 0.1);
  EXPECT_DOUBLE_EQ(histogram.quantile(1.0), 10.0);
}

TEST(Histogram, NeverAboveTheMaximum) {
  Histogram histogram(1.0, 10);
  histogram.add(0.2);
  EXPECT_LE(histogram.quantile(0.95), 0.2);
}

TEST(Histogram, LargeValuesEndInTheMaximum) {
  Histogram histogram(1.0, 10);
  for (int i = 0; i < 10; ++i) histogram.add(1e6 + i);
  EXPECT_DOUBLE_EQ(histogram.quantile(0.5), 1e6 + 9);
}

TEST(Histogram, EmptyAndNotFinite) {
  Histogram histogram(1.0, 10);
  EXPECT_EQ(histogram.quantile(0.95), 0.0);
  histogram.add(std::numeric_limits<double>::quiet_NaN());
  histogram.add(std::numeric_limits<double>::infinity());
  EXPECT_EQ(histogram.total(), 0u);
}

TEST(Coupling, ErrorsBetweenWrittenAndReported) {
  CouplingMonitor monitor;
  for (int i = 0; i < 999; ++i) monitor.add({1, 2}, {1, 2.005});
  monitor.add({0, 0}, {3, 4});
  monitor.add_lane_mismatch();
  const CouplingResult result = monitor.result();
  EXPECT_DOUBLE_EQ(result.position_error_max_m, 5.0);
  EXPECT_NEAR(result.position_error_p99_m, 0.005, 0.0006);
  EXPECT_EQ(result.lane_mismatches, 1u);
  EXPECT_EQ(result.compared, 1000u);
}

}  // namespace
}  // namespace sumogamma
