#include "base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace sumogamma {
namespace {

class WorkersOf : public ::testing::TestWithParam<std::size_t> {};

TEST_P(WorkersOf, EveryRowIsVisitedOnceInConsecutiveRanges) {
  Workers workers(GetParam());
  for (const std::size_t rows : {0U, 1U, 2U, 3U, 7U, 8U, 64U, 1001U}) {
    std::vector<int> visits(rows, 0);
    std::vector<std::size_t> worker_of(rows, 0);
    workers.for_each_range(rows, [&](std::size_t worker, std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        ++visits[row];
        worker_of[row] = worker;
      }
    });
    EXPECT_EQ(visits, std::vector<int>(rows, 1)) << rows << " rows";
    EXPECT_TRUE(std::is_sorted(worker_of.begin(), worker_of.end()));
    if (rows > 0) {
      EXPECT_LT(worker_of.back(), workers.count());
    }
  }
}

TEST_P(WorkersOf, TheSameBitsWhateverTheCount) {
  const auto sums_of = [](std::size_t count) {
    Workers workers(count);
    std::vector<double> result(501, 0.0);
    for (int round = 0; round < 50; ++round) {
      workers.for_each_range(result.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
          result[row] += 1.0 / (static_cast<double>(row) + round + 1.0);
      });
    }
    return result;
  };
  EXPECT_EQ(sums_of(GetParam()), sums_of(1));
}

TEST_P(WorkersOf, AFailureReachesTheCallerAndTheNextRoundWorks) {
  Workers workers(GetParam());
  for (const std::size_t bad_row : {0U, 50U, 99U}) {
    try {
      workers.for_each_range(100, [&](std::size_t, std::size_t begin, std::size_t end) {
        if (begin <= bad_row && bad_row < end) throw std::runtime_error(std::to_string(bad_row));
      });
      FAIL() << "row " << bad_row << " threw and nobody heard";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), std::to_string(bad_row));
    }
    std::atomic<std::size_t> rows{0};
    workers.for_each_range(
        100, [&](std::size_t, std::size_t begin, std::size_t end) { rows += end - begin; });
    EXPECT_EQ(rows, 100U);
  }
}

TEST_P(WorkersOf, APoolThatNeverWorkedEnds) {
  for (int round = 0; round < 20; ++round) {
    const Workers idle(GetParam());
    EXPECT_EQ(idle.count(), GetParam());
  }
}

INSTANTIATE_TEST_SUITE_P(Counts, WorkersOf, ::testing::Values(1, 2, 3, 8, 32));

TEST(Workers, NoneAskedForIsOne) {
  Workers workers(0);
  EXPECT_EQ(workers.count(), 1U);
  std::thread::id runner;
  workers.for_each_range(
      1, [&](std::size_t, std::size_t, std::size_t) { runner = std::this_thread::get_id(); });
  EXPECT_EQ(runner, std::this_thread::get_id());
}

TEST(Workers, TwoWorkersAreTwoThreads) {
  Workers workers(2);
  std::vector<std::thread::id> runner(2);
  workers.for_each_range(2, [&](std::size_t worker, std::size_t begin, std::size_t) {
    EXPECT_EQ(worker, begin);
    runner[worker] = std::this_thread::get_id();
  });
  EXPECT_EQ(runner[0], std::this_thread::get_id());
  EXPECT_NE(runner[1], runner[0]);
}

}  // namespace
}  // namespace sumogamma
