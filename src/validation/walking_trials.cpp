#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "validation/trial.h"
#include "validation/walk_room.h"

namespace sumogamma {

namespace {

double draw(std::uint64_t seed, std::uint64_t k, double low, double high) {
  return random_uniform(seed, k, 0, Draw::Demand, low, high);
}

/// `count` people on a jittered lattice over a rectangle, so that nobody stands on anybody.
std::vector<Walker> people_in(const Vec2& low, const Vec2& high, std::size_t count,
                              std::uint64_t seed) {
  const Vec2 size = high - low;
  const double room = std::sqrt(size.x() * size.y() / static_cast<double>(count));
  const auto columns = static_cast<std::size_t>(std::ceil(size.x() / room));
  const std::size_t lines = (count + columns - 1) / columns;
  const Vec2 cell(size.x() / static_cast<double>(columns), size.y() / static_cast<double>(lines));
  std::vector<Walker> people(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double free = std::max(0.0, 0.5 * (std::min(cell.x(), cell.y()) - 0.5));
    const Vec2 middle(static_cast<double>(k % columns) + 0.5,
                      static_cast<double>(k / columns) + 0.5);
    people[k].position = low + middle.cwiseProduct(cell) +
                         Vec2(draw(seed, 3 * k, -free, free), draw(seed, 3 * k + 1, -free, free));
    // Weidmann's spread of the speeds that people like
    people[k].speed = std::clamp(1.34 + 0.26 * (draw(seed, 3 * k + 2, -1.7, 1.7)), 0.7, 2.0);
  }
  return people;
}

/// A wall with openings: the pieces of the line from `from` to `to` outside of the openings, each
/// from and to along it [m], in order.
void add_wall(const Vec2& from, const Vec2& to, const std::vector<std::pair<double, double>>& open,
              Room& room) {
  const Vec2 way = (to - from).normalized();
  double at = 0.0;
  for (const auto& [begin, end] : open) {
    if (begin > at) room.walls.push_back({from + at * way, from + begin * way});
    at = end;
  }
  room.walls.push_back({from + at * way, to});
}

/// The last time somebody passed a gate [s]; not a number where somebody never did.
double last_passing(const std::vector<Walked>& walked, std::size_t gate) {
  double last = 0.0;
  for (const Walked& of : walked) {
    if (of.passed.size() <= gate) return std::nan("");
    last = std::max(last, of.passed[gate]);
  }
  return last;
}

std::vector<double> passings(const std::vector<Walked>& walked, std::size_t gate) {
  std::vector<double> times;
  for (const Walked& of : walked)
    if (of.passed.size() > gate) times.push_back(of.passed[gate]);
  std::sort(times.begin(), times.end());
  return times;
}

/// People a second between the tenth and the ninetieth of a hundred.
double flow_of(const std::vector<double>& times) {
  if (times.size() < 20) return std::nan("");
  const std::size_t first = times.size() / 10, last = times.size() * 9 / 10;
  return static_cast<double>(last - first) / (times[last] - times[first]);
}

// ---- R1 -----------------------------------------------------------------------------------------

std::vector<double> corridor(std::uint64_t, Workers& workers) {
  Room room;
  add_wall({-1, 0}, {42, 0}, {}, room);
  add_wall({-1, 2}, {42, 2}, {}, room);
  room.walkers = {{{0.0, 1.0}, 1.33, {{{40, 0}, {40, 2}}}, 0.0}};
  return {last_passing(walk(room, 60.0, workers), 0)};
}

// ---- R4 -----------------------------------------------------------------------------------------

constexpr double kDensities[] = {0.5, 1.0, 2.0, 3.0};

double weidmann(double density) {
  return 1.34 * (1.0 - std::exp(-1.913 * (1.0 / density - 1.0 / 5.4)));
}

double mean_speed_at(double density, std::uint64_t seed, Workers& workers) {
  constexpr double kLength = 26.0, kWidth = 2.0, kFrom = 10.0, kTo = 70.0;  // [m], [s]
  Room room;
  room.period = kLength;
  add_wall({-kLength, 0}, {2 * kLength, 0}, {}, room);
  add_wall({-kLength, kWidth}, {2 * kLength, kWidth}, {}, room);
  const auto count = static_cast<std::size_t>(std::lround(density * kLength * kWidth));
  room.walkers = people_in({0, 0}, {kLength, kWidth}, count, seed);
  double sum = 0.0, samples = 0.0;
  walk(room, kTo, workers, [&](double time, const Scene& scene, std::size_t walkers) {
    if (time < kFrom) return;
    for (std::size_t row = 0; row < walkers; ++row) sum += scene.velocity[row].x();
    samples += static_cast<double>(walkers);
  });
  return sum / samples;
}

std::vector<double> fundamental_diagram(std::uint64_t seed, Workers& workers) {
  std::vector<double> values;
  double squares = 0.0;
  for (const double density : kDensities) {
    values.push_back(mean_speed_at(density, seed, workers));
    const double off = values.back() - weidmann(density);
    squares += off * off / static_cast<double>(std::size(kDensities));
  }
  values.push_back(std::sqrt(squares));
  return values;
}

// ---- R5 -----------------------------------------------------------------------------------------

std::vector<double> reaction_times(std::uint64_t seed, Workers& workers) {
  Room room;
  add_wall({0, 0}, {8, 0}, {}, room);
  add_wall({0, 5}, {8, 5}, {}, room);
  add_wall({0, 0}, {0, 5}, {}, room);
  add_wall({8, 0}, {8, 5}, {{2.0, 3.0}}, room);
  room.walkers = people_in({0.5, 0.5}, {7, 4.5}, 10, seed);
  // nearest to the door first: nobody has to get past anybody who stands
  std::sort(room.walkers.begin(), room.walkers.end(),
            [](const Walker& a, const Walker& b) { return a.position.x() > b.position.x(); });
  for (std::size_t k = 0; k < room.walkers.size(); ++k) {
    room.walkers[k].starts_at = 10.0 * static_cast<double>(k + 1);
    room.walkers[k].gates = {{{8, 2}, {8, 3}}};
  }
  const std::vector<Walked> walked = walk(room, 130.0, workers);
  double worst = 0.0;
  for (std::size_t k = 0; k < walked.size(); ++k) {
    if (walked[k].started < 0.0) return {std::nan("")};
    worst = std::max(worst, std::abs(walked[k].started - room.walkers[k].starts_at));
  }
  return {worst};
}

// ---- R6 -----------------------------------------------------------------------------------------

std::vector<double> corner(std::uint64_t seed, Workers& workers) {
  Room room;
  room.walls = {{{10, 12}, {10, 2}, {0, 2}, {0, 0}, {12, 0}, {12, 12}}};
  room.walkers = people_in({0.3, 0}, {6, 2}, 20, seed);
  for (Walker& walker : room.walkers) walker.gates = {{{10, 0}, {10, 2}}, {{12, 11.5}, {10, 11.5}}};
  double outside = 0.0;
  const auto walked = walk(room, 90.0, workers, [&](double, const Scene& scene, std::size_t rows) {
    for (std::size_t row = 0; row < rows; ++row) {
      const Vec2& p = scene.position[row];
      const bool in_one = p.y() > 0 && p.y() < 2 && p.x()<12, in_two = p.x()> 10 && p.x() < 12;
      outside += !in_one && !(in_two && p.y() > 0);
    }
  });
  return {outside, static_cast<double>(passings(walked, 1).size())};
}

// ---- R9 -----------------------------------------------------------------------------------------

double time_out_of_hall(bool four, std::uint64_t seed, Workers& workers) {
  const std::vector<std::pair<double, double>> doors{{9.5, 10.5}, {19.5, 20.5}};
  Room room;
  add_wall({0, 0}, {0, 20}, {}, room);
  add_wall({30, 0}, {30, 20}, {}, room);
  add_wall({0, 20}, {30, 20}, doors, room);
  add_wall({0, 0}, {30, 0}, four ? doors : std::vector<std::pair<double, double>>{}, room);
  room.walkers = people_in({0.4, 0.4}, {29.6, 19.6}, 1000, seed);
  for (Walker& walker : room.walkers) {
    const bool up = !four || walker.position.y() > 10.0;
    const double from = walker.position.x() < 15.0 ? doors[0].first : doors[1].first;
    walker.gates = {up ? Gate{{from + 1, 20}, {from, 20}} : Gate{{from, 0}, {from + 1, 0}}};
  }
  return last_passing(walk(room, 600.0, workers), 0);
}

std::vector<double> exits(std::uint64_t seed, Workers& workers) {
  const double four = time_out_of_hall(true, seed, workers);
  const double two = time_out_of_hall(false, seed, workers);
  return {two / four};
}

// ---- R12 ----------------------------------------------------------------------------------------

std::vector<double> room_corridor_room(std::uint64_t seed, Workers& workers) {
  Room room;
  add_wall({0, 0}, {10, 0}, {}, room);
  add_wall({0, 10}, {10, 10}, {}, room);
  add_wall({0, 0}, {0, 10}, {}, room);
  add_wall({10, 0}, {10, 10}, {{4.5, 5.5}}, room);
  add_wall({10, 4.5}, {15, 4.5}, {}, room);
  add_wall({10, 5.5}, {15, 5.5}, {}, room);
  add_wall({15, 0}, {15, 10}, {{4.5, 5.5}}, room);
  add_wall({15, 0}, {25, 0}, {}, room);
  add_wall({15, 10}, {25, 10}, {}, room);
  add_wall({25, 0}, {25, 10}, {{4.5, 5.5}}, room);
  room.walkers = people_in({0.4, 0.4}, {6, 9.6}, 150, seed);
  for (Walker& walker : room.walkers)
    for (const double x : {10.0, 15.0, 25.0}) walker.gates.push_back({{x, 4.5}, {x, 5.5}});
  const std::vector<Walked> walked = walk(room, 600.0, workers);
  return {flow_of(passings(walked, 2)) - flow_of(passings(walked, 0))};
}

// ---- P1 -----------------------------------------------------------------------------------------

constexpr double kWidths[] = {1.0, 1.5, 2.0, 2.5};

std::vector<double> bottleneck(std::uint64_t seed, Workers& workers) {
  std::vector<double> values;
  for (const double width : kWidths) {
    Room room;
    const double low = 4.0 - 0.5 * width;
    add_wall({0, 0}, {20, 0}, {}, room);
    add_wall({0, 8}, {20, 8}, {}, room);
    add_wall({20, 0}, {20, 8}, {{low, low + width}}, room);
    room.walkers = people_in({4, 0.4}, {19, 7.6}, 200, seed);
    for (Walker& walker : room.walkers) walker.gates = {{{20, low}, {20, low + width}}};
    values.push_back(flow_of(passings(walk(room, 150.0, workers), 0)) / width);
  }
  values.push_back((values[3] * kWidths[3]) / (values[0] * kWidths[0]));
  return values;
}

std::vector<Criterion> diagram_criteria() {
  std::vector<Criterion> criteria;
  for (const double density : kDensities)
    criteria.push_back({"mean speed at " + std::to_string(density).substr(0, 3) + " people/m²",
                        "m/s",
                        {weidmann(density) - 0.26, weidmann(density) + 0.26},
                        "Weidmann 1993 ± his spread of 0.26 m/s",
                        false,
                        ""});
  criteria.push_back({"root mean square distance to Weidmann's curve",
                      "m/s",
                      {0.0, 0.15},
                      "this project's",
                      true,
                      ""});
  return criteria;
}

std::vector<Criterion> bottleneck_criteria() {
  std::vector<Criterion> criteria;
  for (const double width : kWidths)
    criteria.push_back({"specific flow, " + std::to_string(width).substr(0, 3) + " m wide",
                        "1/(m s)",
                        {1.2, 1.9},
                        "Kretz et al. 2006, Seyfried et al. 2009",
                        true,
                        ""});
  criteria.push_back({"flow through 2.5 m over flow through 1 m",
                      "",
                      {1.5, kAny},
                      "flow rises with the width (Seyfried et al. 2009)",
                      false,
                      ""});
  return criteria;
}

}  // namespace

std::vector<Trial> walking_trials() {
  const auto one = [](Criterion criterion) { return std::vector<Criterion>{std::move(criterion)}; };
  return {
      {"R1", "Does a walker keep its speed?",
       "One person walks 40 m of a corridor of 2 m at 1.33 m/s.", "",
       one({"time", "s", {26.0, 34.0}, "RiMEA 4.0, test 1", false, ""}), corridor},
      {"R4", "Are people slower the denser they are?",
       "A corridor of 26 m by 2 m, repeated at its ends, all walk one way; speeds from 10 to 70 s.",
       "", diagram_criteria(), fundamental_diagram},
      {"R5", "Does everybody start when it has reacted?",
       "Ten people in a room of 8 m by 5 m with reaction times of 10 to 100 s.", "",
       one({"latest or earliest start against its time",
            "s",
            {0.0, 0.6},
            "RiMEA 4.0, test 5",
            false,
            ""}),
       reaction_times},
      {"R6",
       "Is a corner walked round and not through?",
       "Twenty people round a right-angled corner of a corridor of 2 m.",
       "",
       {{"samples outside the walls", "", {0.0, 0.0}, "RiMEA 4.0, test 6", false, ""},
        {"people who arrive within 90 s", "", {20.0, 20.0}, "RiMEA 4.0, test 6", false, ""}},
       corner},
      {"R9", "Do half as many exits take twice as long?",
       "1,000 people leave a hall of 30 m by 20 m through doors of 1 m: four, or two of them.", "",
       one({"time with two doors over time with four",
            "",
            {1.6, 2.4},
            "RiMEA 4.0, test 9; JuPedSim's test asks for 2 ± 50 %",
            false,
            ""}),
       exits},
      {"R12", "Does the first bottleneck rule the second?",
       "150 people leave a room by a corridor of 1 m by 5 m into another, and that by a door of 1 "
       "m.",
       "",
       one({"flow at the last door less flow at the first",
            "1/s",
            {-0.05, kAny},
            "RiMEA 4.0, test 12",
            true,
            ""}),
       room_corridor_room},
      {"P1", "How many pass a bottleneck?",
       "200 people leave a room 8 m wide by an opening of 1 to 2.5 m.", "", bottleneck_criteria(),
       bottleneck},
  };
}

}  // namespace sumogamma
