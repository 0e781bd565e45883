#include "demand/count_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "demand/trip_weights.h"

namespace sumogamma {
namespace {

RoutedTrip trip(std::vector<std::string> edges, double weight = 1) {
  RoutedTrip trip;
  trip.edges = std::move(edges);
  trip.duration = 60;
  trip.length = 500;
  trip.weight = weight;
  return trip;
}

/// 360 departures an hour on trips of 60 s.
TripPool pool(std::vector<RoutedTrip> trips) {
  TripPool pool;
  pool.agents = 6;
  pool.trips = std::move(trips);
  return pool;
}

TEST(CountFit, GehIsThatOfTwoFlows) {
  EXPECT_DOUBLE_EQ(geh(100, 100), 0);
  EXPECT_DOUBLE_EQ(geh(0, 0), 0);
  EXPECT_NEAR(geh(120, 100), std::sqrt(2 * 400 / 220.0), 1e-12);
}

TEST(CountFit, FlowsBecomeWhatWasCounted) {
  TripPool cars = pool({trip({"a", "b"}), trip({"a", "c"}), trip({"d", "c"})});
  std::vector<TripPool*> vehicles = {&cars};
  const auto fits = fit_counts({{"a", "", 500}, {"c", "", 300}, {"a", "b", 400}}, vehicles);
  ASSERT_EQ(fits.size(), 3u);
  for (const CountFit& fit : fits) {
    EXPECT_NEAR(fit.per_hour, fit.count.per_hour, 0.5) << fit.count.edge;
    EXPECT_LT(fit.geh, 0.1);
  }
  // departures an hour by trip: 400 turn onto b, 100 onto c, 200 come from d
  EXPECT_NEAR(cars.trips[0].weight, 400, 0.5);
  EXPECT_NEAR(cars.trips[1].weight, 100, 0.5);
  EXPECT_NEAR(cars.trips[2].weight, 200, 0.5);
  EXPECT_NEAR(cars.agents, 700 * 60 / 3600.0, 0.05) << "Little's law";
}

TEST(CountFit, LeavesAloneWhatIsNotCountedOrFixed) {
  TripPool cars = pool({trip({"a", "b"}), trip({"x", "y"})});
  TripPool buses = pool({trip({"a", "b"})});
  buses.fixed = true;
  std::vector<TripPool*> vehicles = {&cars, &buses};
  const auto fits = fit_counts({{"b", "", 500}}, vehicles);
  EXPECT_NEAR(fits.front().per_hour, 500, 1e-6);
  EXPECT_NEAR(cars.trips[0].weight, 140, 1e-6) << "360 of them are buses, which stay";
  EXPECT_NEAR(cars.trips[1].weight, 180, 1e-6);
  EXPECT_NEAR(buses.agents, 6, 1e-9);
}

TEST(CountFit, SaysWhatNoTripLeadsOver) {
  TripPool cars = pool({trip({"a", "b"})});
  std::vector<TripPool*> vehicles = {&cars};
  const auto fits = fit_counts({{"elsewhere", "", 50}, {"b", "a", 50}}, vehicles);
  EXPECT_EQ(fits[0].per_hour, 0);
  EXPECT_EQ(fits[1].per_hour, 0);
  EXPECT_EQ(fits[1].geh, 10);
  EXPECT_NEAR(cars.agents, 6, 1e-9);
}

}  // namespace
}  // namespace sumogamma
