#include "osm/driving_side.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <span>

namespace sumogamma::osm {
namespace {

using Outline = std::span<const GeoPoint>;

constexpr GeoPoint kBritain[] = {{-11, 51},   {-11, 55.6}, {-8.8, 58.8}, {-1.5, 61.2},
                                 {0.5, 61.2}, {2.2, 52.9}, {1.9, 51.5},  {1.55, 51.05},
                                 {0.9, 50.7}, {-1, 50.3},  {-4, 49.8},   {-6.6, 49.7}};
constexpr GeoPoint kIndianSubcontinent[] = {
    {61.6, 25.0}, {61.8, 26.3}, {63.2, 27.2}, {61.0, 29.8}, {66.3, 29.9}, {66.4, 31.0},
    {69.3, 31.9}, {70.0, 33.5}, {71.1, 34.1}, {71.6, 36.4}, {74.6, 37.0}, {76.0, 36.0},
    {78.0, 35.5}, {79.2, 33.0}, {78.7, 31.5}, {81.0, 30.2}, {82.0, 30.3}, {84.0, 29.1},
    {86.0, 28.1}, {88.1, 27.9}, {88.9, 27.3}, {89.5, 28.2}, {92.1, 27.8}, {94.0, 29.2},
    {96.2, 29.3}, {97.4, 28.2}, {97.0, 27.5}, {95.2, 26.6}, {94.6, 25.2}, {94.2, 23.9},
    {93.3, 23.9}, {93.0, 22.0}, {92.6, 21.3}, {92.3, 20.7}, {90.0, 20.0}, {82.5, 9.0},
    {82.2, 5.5},  {79.0, 5.5},  {75.5, 8.0},  {72.0, 15.0}, {67.5, 22.5}};
constexpr GeoPoint kSouthEastAsia[] = {
    {97.3, 18.5},  {98.0, 19.8},   {99.9, 20.5},   {100.6, 20.2},  {100.5, 19.5},  {101.2, 19.5},
    {101.0, 17.9}, {102.1, 18.2},  {102.7, 17.85}, {103.3, 18.4},  {104.7, 17.4},  {104.8, 16.4},
    {105.6, 15.5}, {105.5, 14.4},  {103.0, 14.3},  {102.5, 13.6},  {102.9, 11.7},  {101.5, 9.0},
    {102.5, 7.5},  {105.0, 3.0},   {109.0, 5.0},   {116.7, 7.6},   {119.3, 5.3},   {119.6, 4.6},
    {125.5, 4.9},  {127.2, 4.9},   {132.0, 1.0},   {141.0, -2.0},  {150.0, -1.0},  {156.2, -4.0},
    {163.0, -8.0}, {163.0, -12.5}, {150.0, -12.0}, {141.0, -11.0}, {127.0, -11.3}, {105.0, -9.5},
    {94.0, 2.0},   {94.5, 6.5},    {97.8, 7.5},    {98.4, 10.0},   {98.75, 10.4},  {99.4, 11.7},
    {99.1, 13.0},  {98.2, 15.1},   {98.6, 16.3},   {97.7, 17.8}};
constexpr GeoPoint kJapan[] = {
    {122.6, 23.5}, {122.8, 25.0}, {127.5, 30.0}, {128.4, 33.0},  {129.0, 34.6}, {129.6, 34.85},
    {132.0, 36.7}, {138.0, 39.0}, {139.0, 43.0}, {141.2, 45.75}, {142.5, 45.6}, {145.4, 44.4},
    {146.2, 43.3}, {142.5, 38.0}, {142.0, 33.0}, {143.0, 24.0},  {131.0, 23.5}};
constexpr GeoPoint kHongKong[] = {{113.82, 22.13},  {113.82, 22.18},  {113.9, 22.43},
                                  {114.03, 22.505}, {114.12, 22.535}, {114.23, 22.56},
                                  {114.45, 22.55},  {114.45, 22.13}};
constexpr GeoPoint kSouthernAfrica[] = {
    {41.6, -1.7},   {41.0, -0.9},   {41.0, 3.0},   {41.9, 3.95},  {39.5, 3.45},   {38.1, 3.6},
    {36.0, 4.45},   {34.0, 4.25},   {33.5, 3.75},  {31.2, 3.75},  {30.85, 3.5},   {31.3, 2.2},
    {30.0, 0.8},    {29.6, -0.6},   {29.6, -1.4},  {30.5, -1.06}, {30.85, -1.7},  {30.85, -2.35},
    {30.5, -2.4},   {30.8, -3.3},   {30.1, -4.1},  {29.4, -4.45}, {29.5, -6.0},   {30.7, -8.2},
    {28.9, -8.5},   {28.6, -9.5},   {28.7, -10.7}, {28.4, -11.8}, {29.8, -12.15}, {29.8, -13.45},
    {29.0, -13.4},  {28.3, -12.45}, {27.2, -11.6}, {26.0, -11.9}, {24.0, -11.0},  {23.9, -12.9},
    {22.0, -13.0},  {22.0, -16.2},  {23.4, -17.6}, {21.0, -17.9}, {18.4, -17.4},  {14.0, -17.4},
    {11.7, -17.25}, {11.5, -20.0},  {14.0, -30.0}, {17.0, -36.0}, {28.0, -36.0},  {36.0, -27.0},
    {41.5, -16.0},  {41.0, -10.3},  {40.0, -6.0},  {41.7, -3.0}};
constexpr GeoPoint kGuianas[] = {{-60.0, 8.6},  {-60.7, 7.5},  {-61.4, 5.9},  {-60.1, 5.1},
                                 {-60.1, 4.5},  {-59.6, 3.9},  {-59.9, 2.5},  {-59.7, 1.8},
                                 {-58.8, 1.2},  {-56.5, 1.9},  {-54.6, 2.3},  {-54.0, 3.6},
                                 {-54.45, 5.0}, {-54.03, 5.5}, {-53.95, 5.8}, {-57.0, 6.3}};
constexpr GeoPoint kBahamas[] = {{-79.35, 27.3}, {-79.35, 25.2}, {-79.0, 23.4}, {-76.5, 21.9},
                                 {-74.5, 20.75}, {-73.0, 20.75}, {-72.6, 22.5}, {-76.5, 27.3}};

struct Region {
  std::string_view name;
  Outline outline;
};
constexpr Region kRegions[] = {{"Great Britain and Ireland", kBritain},
                               {"Indian subcontinent", kIndianSubcontinent},
                               {"South-east Asia and Melanesia", kSouthEastAsia},
                               {"Japan", kJapan},
                               {"Hong Kong", kHongKong},
                               {"southern and eastern Africa", kSouthernAfrica},
                               {"Guyana and Suriname", kGuianas},
                               {"Bahamas", kBahamas}};

struct BoxRegion {
  std::string_view name;
  GeoBox box;
};
constexpr BoxRegion kBoxes[] = {{"Australia", {112.5, -44, 154, -10}},
                                {"New Zealand", {166, -47.5, 179.1, -34}},
                                {"New Zealand", {-177, -44.5, -176, -43.6}},
                                {"Norfolk Island", {167.85, -29.2, 168.1, -28.9}},
                                {"Christmas Island", {105.4, -10.7, 105.8, -10.3}},
                                {"Channel Islands", {-2.75, 49.1, -2.0, 49.78}},
                                {"Malta", {14.1, 35.7, 14.65, 36.15}},
                                {"Cyprus", {32.2, 34.5, 34.65, 35.75}},
                                {"Macau", {113.52, 22.1, 113.6, 22.217}},
                                {"Maldives", {72, -1, 74, 7.5}},
                                {"Andaman and Nicobar Islands", {92, 6.5, 94.1, 14}},
                                {"Mauritius", {57.2, -20.6, 57.9, -19.9}},
                                {"Mauritius", {63.2, -19.85, 63.6, -19.6}},
                                {"Seychelles", {46, -10.5, 56.5, -3.5}},
                                {"Jamaica", {-78.5, 17.6, -76.1, 18.6}},
                                {"Turks and Caicos Islands", {-72.6, 21.0, -71.0, 22.05}},
                                {"Cayman Islands", {-81.5, 19.2, -79.7, 19.8}},
                                {"Barbados", {-59.75, 12.95, -59.35, 13.4}},
                                {"Trinidad and Tobago", {-61.95, 10.0, -60.4, 10.6}},
                                {"Trinidad and Tobago", {-61.8, 10.6, -60.4, 11.45}},
                                {"Grenada", {-61.85, 11.95, -61.35, 12.55}},
                                {"Saint Vincent", {-61.5, 12.55, -61.1, 13.4}},
                                {"Saint Lucia", {-61.1, 13.7, -60.85, 14.15}},
                                {"Dominica", {-61.5, 15.2, -61.2, 15.65}},
                                {"Antigua and Barbuda", {-61.95, 16.95, -61.6, 17.75}},
                                {"Montserrat", {-62.26, 16.65, -62.12, 16.83}},
                                {"Saint Kitts and Nevis", {-62.9, 17.08, -62.5, 17.43}},
                                {"Anguilla", {-63.2, 18.145, -62.9, 18.35}},
                                {"Virgin Islands", {-65.1, 17.65, -64.2, 18.8}},
                                {"Bermuda", {-64.95, 32.2, -64.6, 32.45}},
                                {"Falkland Islands", {-61.5, -52.6, -57.5, -50.9}},
                                {"Saint Helena", {-5.9, -16.1, -5.6, -15.8}},
                                {"Fiji", {176.8, -19.3, 180, -15.9}},
                                {"Fiji", {-180, -19.3, -178, -15.9}},
                                {"Samoa", {-172.9, -14.1, -171.3, -13.3}},
                                {"Tonga", {-176.3, -22.4, -173.6, -15.5}},
                                {"Kiribati", {172.5, -3, 177, 3.6}},
                                {"Nauru", {166.85, -0.6, 167, -0.45}},
                                {"Tuvalu", {176, -10.9, 180, -5.6}},
                                {"Cook Islands", {-166, -22, -157.2, -8.9}},
                                {"Niue", {-170, -19.2, -169.7, -18.9}}};

}  // namespace

std::string_view left_hand_region(GeoPoint place) {
  for (const Region& region : kRegions)
    if (ring_has(region.outline, place)) return region.name;
  for (const BoxRegion& region : kBoxes)
    if (region.box.contains(place)) return region.name;
  return {};
}

bool has_turns_on_red(GeoPoint place) {
  constexpr GeoBox kWith[] = {{-124.9, 25.85, -66.9, 49.0},  // contiguous United States, and
                              {-141.0, 49.0, -52.5, 70.0},   // Canada
                              {-125.0, 41.6, -52.5, 49.0},   // its south and east
                              {-170.0, 54.0, -129.9, 71.5},  // Alaska
                              {-160.6, 18.8, -154.7, 22.4},  // Hawaii
                              {-82.1, 24.4, -79.9, 25.85}};  // the south of Florida
  constexpr GeoBox kWithout[] = {{-74.26, 40.49, -73.70, 40.92}, {-73.98, 45.40, -73.47, 45.71}};
  const auto contains = [&](const GeoBox& box) { return box.contains(place); };
  return std::any_of(std::begin(kWith), std::end(kWith), contains) &&
         std::none_of(std::begin(kWithout), std::end(kWithout), contains);
}

RoundaboutTurns count_roundabout_turns(const OsmMap& map) {
  RoundaboutTurns turns;
  for (const MapWay& way : map.ways) {
    if (!tag_is(way.tags, "junction", {"roundabout", "circular"}) || way.nodes.size() < 4 ||
        way.nodes.front() != way.nodes.back() || tag_is(way.tags, "oneway", {"no", "-1"}))
      continue;
    const LocalMetric metric(map.nodes.at(way.nodes[0]).place);
    double twice_area = 0;
    for (std::size_t i = 0; i + 1 < way.nodes.size(); ++i) {
      const GeoPoint a = map.nodes.at(way.nodes[i]).place, b = map.nodes.at(way.nodes[i + 1]).place;
      twice_area += metric.east(a) * metric.north(b) - metric.east(b) * metric.north(a);
    }
    ++(twice_area < 0 ? turns.clockwise : turns.counter_clockwise);
  }
  return turns;
}

}  // namespace sumogamma::osm
