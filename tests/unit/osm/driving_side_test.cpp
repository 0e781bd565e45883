#include "osm/driving_side.h"

#include <gtest/gtest.h>

#include "osm/osm_reader.h"

namespace sumogamma::osm {
namespace {

struct City {
  const char* name;
  double lat, lon;
};

TEST(LeftHandRegion, KnowsWhoKeepsLeft) {
  const City cities[] = {{"London", 51.507, -0.128},
                         {"Dover", 51.128, 1.313},
                         {"Belfast", 54.597, -5.930},
                         {"Saint Helier", 49.187, -2.107},
                         {"Delhi", 28.644, 77.216},
                         {"Karachi", 24.861, 67.010},
                         {"Kathmandu", 27.717, 85.324},
                         {"Dhaka", 23.810, 90.412},
                         {"Thimphu", 27.472, 89.639},
                         {"Colombo", 6.927, 79.861},
                         {"Male", 4.175, 73.509},
                         {"Bangkok", 13.756, 100.502},
                         {"Chiang Mai", 18.788, 98.985},
                         {"Kuala Lumpur", 3.139, 101.687},
                         {"Singapore", 1.352, 103.820},
                         {"Jakarta", -6.208, 106.846},
                         {"Kota Kinabalu", 5.980, 116.073},
                         {"Dili", -8.557, 125.560},
                         {"Port Moresby", -9.443, 147.180},
                         {"Tokyo", 35.690, 139.692},
                         {"Fukuoka", 33.590, 130.402},
                         {"Sapporo", 43.062, 141.354},
                         {"Naha", 26.212, 127.681},
                         {"Hong Kong", 22.302, 114.177},
                         {"Macau", 22.199, 113.544},
                         {"Sydney", -33.869, 151.209},
                         {"Perth", -31.951, 115.861},
                         {"Darwin", -12.463, 130.844},
                         {"Auckland", -36.850, 174.764},
                         {"Suva", -18.142, 178.442},
                         {"Cape Town", -33.925, 18.424},
                         {"Maputo", -25.969, 32.573},
                         {"Harare", -17.825, 31.034},
                         {"Lusaka", -15.387, 28.323},
                         {"Windhoek", -22.560, 17.066},
                         {"Dar es Salaam", -6.792, 39.208},
                         {"Nairobi", -1.292, 36.822},
                         {"Kampala", 0.348, 32.583},
                         {"Port Louis", -20.161, 57.499},
                         {"Kingston", 17.971, -76.793},
                         {"Nassau", 25.060, -77.345},
                         {"Bridgetown", 13.113, -59.599},
                         {"Port of Spain", 10.655, -61.502},
                         {"Georgetown", 6.801, -58.155},
                         {"Paramaribo", 5.852, -55.204},
                         {"Valletta", 35.899, 14.515},
                         {"Nicosia", 35.186, 33.382},
                         {"Charlotte Amalie", 18.342, -64.931}};
  for (const City& city : cities)
    EXPECT_FALSE(left_hand_region({city.lon, city.lat}).empty()) << city.name;
}

TEST(LeftHandRegion, KnowsWhoKeepsRight) {
  const City cities[] = {{"Calais", 50.951, 1.859},
                         {"Cherbourg", 49.634, -1.622},
                         {"Paris", 48.857, 2.352},
                         {"Amsterdam", 52.373, 4.893},
                         {"Berlin", 52.520, 13.405},
                         {"Tehran", 35.689, 51.389},
                         {"Kabul", 34.555, 69.207},
                         {"Kashgar", 39.470, 75.990},
                         {"Lhasa", 29.653, 91.172},
                         {"Yangon", 16.841, 96.174},
                         {"Mandalay", 21.959, 96.089},
                         {"Vientiane", 17.976, 102.633},
                         {"Phnom Penh", 11.556, 104.928},
                         {"Ho Chi Minh City", 10.823, 106.630},
                         {"Manila", 14.600, 120.984},
                         {"Zamboanga", 6.921, 122.079},
                         {"Davao", 7.191, 125.455},
                         {"Busan", 35.180, 129.076},
                         {"Jeju", 33.500, 126.531},
                         {"Taipei", 25.033, 121.565},
                         {"Vladivostok", 43.120, 131.886},
                         {"Shenzhen", 22.543, 114.058},
                         {"Zhuhai", 22.271, 113.577},
                         {"Guangzhou", 23.130, 113.259},
                         {"Noumea", -22.276, 166.458},
                         {"Port Vila", -17.741, 168.315},
                         {"Honolulu", 21.307, -157.858},
                         {"Addis Ababa", 9.011, 38.762},
                         {"Mogadishu", 2.046, 45.318},
                         {"Juba", 4.852, 31.582},
                         {"Kigali", -1.944, 30.062},
                         {"Bujumbura", -3.382, 29.361},
                         {"Lubumbashi", -11.661, 27.479},
                         {"Luanda", -8.839, 13.289},
                         {"Antananarivo", -18.879, 47.508},
                         {"Saint-Denis", -20.882, 55.451},
                         {"Havana", 23.113, -82.366},
                         {"Santiago de Cuba", 20.017, -75.829},
                         {"Port-au-Prince", 18.594, -72.307},
                         {"San Juan", 18.466, -66.106},
                         {"Miami", 25.762, -80.192},
                         {"Fort-de-France", 14.616, -61.059},
                         {"Pointe-a-Pitre", 16.241, -61.533},
                         {"Cayenne", 4.922, -52.313},
                         {"Caracas", 10.480, -66.904},
                         {"Palermo", 38.116, 13.361},
                         {"Beirut", 33.894, 35.502},
                         {"Monaco", 43.731, 7.420}};
  for (const City& city : cities)
    EXPECT_EQ(left_hand_region({city.lon, city.lat}), "") << city.name;
}

TEST(CountRoundaboutTurns, TellsTheSideOfARing) {
  const std::string folder = std::string(SUMOGAMMA_SOURCE_DIR) + "/tests/support/osm/";
  EXPECT_EQ(count_roundabout_turns(read_osm(folder + "roundabout_right.osm")).counter_clockwise, 1);
  EXPECT_EQ(count_roundabout_turns(read_osm(folder + "roundabout_left.osm")).clockwise, 1);
}

}  // namespace
}  // namespace sumogamma::osm
