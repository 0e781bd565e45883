// Drives a scenario by a loop of one's own: own_loop SCENARIO [OPTIONS as behind `sumo-gamma run`]
#include <sumo_gamma/session.h>

#include <cstdio>

int main(int argc, char** argv) {
  try {
    sumogamma::Session session({argv + 1, argv + argc});
    while (!session.finished()) {
      session.observe();
      session.step();
      session.advance();
    }
    session.close();
    std::printf("%.2f s, %zu agents, state hash %s\n", session.time(), session.size(),
                session.state_hash().c_str());
  } catch (const sumogamma::Error& error) {
    std::fprintf(stderr, "own_loop: %s\n", error.what());
    return 2;
  }
}
