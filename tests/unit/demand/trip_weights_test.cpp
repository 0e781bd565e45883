#include "demand/trip_weights.h"

#include <gtest/gtest.h>

#include <numeric>

#include "support/plain_net.h"

namespace sumogamma {
namespace {

/// On the crossroads of support/plain_net.h: the east-west road has two lanes each way and goes
/// first, the north-south road has one.
class TripWeights : public ::testing::Test {
 protected:
  RoutedTrip trip(const std::string& from, const std::string& to, double length = 400,
                  double duration = 40) const {
    RoutedTrip trip;
    trip.edges = {from, to};
    std::vector<ConnectionId> step;
    for (const LaneId lane : road_.edge(road_.edge_by_name.at(from)).lanes)
      for (const ConnectionId way : road_.lane(lane).outgoing)
        if (road_.lane(road_.connection(way).to).edge == road_.edge_by_name.at(to)) {
          step.push_back(way);
          break;
        }
    EXPECT_FALSE(step.empty()) << from << ' ' << to;
    trip.steps = {step};
    trip.length = length;
    trip.duration = duration;
    return trip;
  }
  static TripPool pool(double agents, std::vector<RoutedTrip> trips) {
    TripPool pool;
    pool.agents = agents;
    pool.trips = std::move(trips);
    return pool;
  }
  static double total(const TripPool& pool) {
    return std::accumulate(pool.trips.begin(), pool.trips.end(), 0.0,
                           [](double sum, const RoutedTrip& trip) { return sum + trip.weight; });
  }

  const RoadNetwork road_ = testing::read_plain_net(testing::crossroads("priority"));
};

TEST_F(TripWeights, WhereThereIsRoomAllTripsAreEquallyLikely) {
  std::vector<TripPool> pools = {pool(4, {trip("WC", "CE"), trip("SC", "CN")})};
  const BusiestLane busiest = weigh_trips(road_, pools);
  EXPECT_EQ(pools[0].trips[0].weight, 1.0);
  EXPECT_EQ(pools[0].trips[1].weight, 1.0);
  EXPECT_EQ(road_.lane(busiest.lane).name, "SC_0");
  EXPECT_LT(busiest.load, 0.9);
}

// 30 agents for 40 s: 2,700 cars an hour, half of which are 2.5 times what gets out of the minor
// road
TEST_F(TripWeights, TripsMoveFromFullLanesToOthers) {
  std::vector<RoutedTrip> trips;
  for (int i = 0; i < 10; ++i) {
    trips.push_back(trip("WC", "CE", 400 + i));
    trips.push_back(trip("SC", "CN", 400 + i));
  }
  std::vector<TripPool> pools = {pool(30, trips)};
  const BusiestLane busiest = weigh_trips(road_, pools);
  for (std::size_t i = 0; i < 20; i += 2) {
    EXPECT_GT(pools[0].trips[i].weight, 1.5);
    EXPECT_LT(pools[0].trips[i + 1].weight, 0.5);
  }
  EXPECT_NEAR(total(pools[0]), 20.0, 1e-9);
  EXPECT_LE(busiest.load, 1.0);
}

TEST_F(TripWeights, WhatCannotBeIsSharedOut) {
  std::vector<TripPool> pools = {pool(300, {trip("WC", "CE"), trip("EC", "CW")})};
  const BusiestLane busiest = weigh_trips(road_, pools);
  EXPECT_NEAR(pools[0].trips[0].weight, 1.0, 0.01);
  // 27,000 cars an hour over four lanes of 1,900
  EXPECT_NEAR(busiest.load, 27000.0 / 7600.0, 0.05);
}

// 900 cars an hour turn right out of the outer lane; of 1,800 that go straight on fewer take it
TEST_F(TripWeights, DriversTakeTheLaneThatIsLessFull) {
  std::vector<TripPool> pools = {pool(10, {trip("WC", "CS")}), pool(20, {trip("WC", "CE")})};
  const BusiestLane busiest = weigh_trips(road_, pools);
  EXPECT_EQ(road_.lane(busiest.lane).name, "WC_0");
  EXPECT_NEAR(busiest.load, (900 + 0.4 * 1800) / 1900, 0.01);
}

TEST_F(TripWeights, LongTripsStayAsOftenAsTheyWere) {
  std::vector<RoutedTrip> trips;
  for (int i = 0; i < 10; ++i) trips.push_back(trip("WC", "CE", 200 + i, 20));
  for (int i = 0; i < 40; ++i) trips.push_back(trip("SC", "CN", 800 + i, 80));
  std::vector<TripPool> pools = {pool(200, std::move(trips))};
  weigh_trips(road_, pools);
  double longs = 0;
  for (const RoutedTrip& trip : pools[0].trips) longs += trip.length > 500 ? trip.weight : 0;
  EXPECT_NEAR(longs, 40.0, 1e-6);
}

}  // namespace
}  // namespace sumogamma
