// A type, a rule and a preferred velocity of one's own: own_rules SCENARIO
#include <sumo_gamma/session.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace {

// a rule: nobody drives faster than 5 m/s within 60 m of the middle of the map, as before a school
void slow_down_at_school(sumogamma::Session& session) {
  const auto x = session.x(), y = session.y();
  const auto allowed = session.allowed_speed();
  for (std::size_t row = 0; row < session.size(); ++row)
    if (session.type(row) != "pedestrian" && std::hypot(x[row], y[row]) < 60.0)
      allowed[row] = std::min(allowed[row], 5.0);
}

// a preferred velocity: people on foot would like to stroll along their heading
void stroll(sumogamma::Session& session) {
  const auto heading = session.heading();
  for (std::size_t row = 0; row < session.size(); ++row)
    if (session.type(row) == "pedestrian" && session.driven(row))
      session.prefer(row, 0.5 * std::cos(heading[row]), 0.5 * std::sin(heading[row]));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    // a type: longer gaps for all cars of this run, and one that the program doesn't know
    std::vector<std::string> words(argv + 1, argv + argc);
    words.insert(words.end(),
                 {"--set", "types.car.headway=2", "--set", "types.tuk_tuk.base=\"motorcycle\"",
                  "--set", "types.tuk_tuk.width=1.3"});
    sumogamma::Session session(words);
    double fastest_inside = 0.0;
    while (!session.finished()) {
      session.observe();
      slow_down_at_school(session);
      stroll(session);
      session.step();
      session.advance();
      const auto x = session.x(), y = session.y(), speed = session.speed();
      for (std::size_t row = 0; row < session.size(); ++row)
        if (session.time() > 20.0 && std::hypot(x[row], y[row]) < 30.0)
          fastest_inside = std::max(fastest_inside, speed[row]);
    }
    session.close();
    std::printf("fastest near the school: %.2f m/s\n", fastest_inside);
  } catch (const sumogamma::Error& error) {
    std::fprintf(stderr, "own_rules: %s\n", error.what());
    return 2;
  }
}
