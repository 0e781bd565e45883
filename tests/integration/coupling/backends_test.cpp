// The same laws for both back ends, against a real SUMO.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "base/error.h"
#include "road/sumo_net_reader.h"
#include "sumo/backend.h"
#include "sumo/sumo_arguments.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

const CouplingScenario& scenario() {
  static const CouplingScenario instance;
  return instance;
}

bool has(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

class Backends : public ::testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<SumoBackend> start(const std::string& config,
                                     std::vector<std::string> more = {}) {
    SumoArguments wish;
    wish.config = config;
    wish.step_length = 0.1;
    wish.user = std::move(more);
    SumoStart request;
    request.arguments = sumo_arguments(wish);
    request.start_timeout = 30;
    request.step_timeout = 30;
    request.signals_by_schedule = by_schedule_;
    return std::string(GetParam()) == "libsumo" ? start_libsumo_backend(request)
                                                : start_traci_backend(request);
  }
  std::unique_ptr<SumoBackend> start() { return start(scenario().config()); }
  bool by_schedule_ = false;

  // steps without ghosts until the condition holds; false: it never did
  static bool run_until(SumoBackend& sumo, SumoStep& step, int most,
                        const std::function<bool()>& holds) {
    for (int i = 0; i < most; ++i) {
      sumo.step({}, {}, step);
      if (holds()) return true;
    }
    return false;
  }

  // the most that the one agent under watch moves at within 20 s [m/s]
  static double fastest_of_watched(SumoBackend& sumo) {
    SumoStep step;
    double fastest = 0;
    for (int i = 0; i < 200; ++i) {
      sumo.step({}, {}, step);
      fastest = std::max(fastest, step.agents.at(0).speed);
    }
    return fastest;
  }
};

TEST_P(Backends, TellsVersionOptionsSignalsAndDetectors) {
  const auto sumo = start();
  EXPECT_NE(sumo->version().find("SUMO"), std::string::npos);
  EXPECT_NE(sumo->option("net-file").find("net.net.xml"), std::string::npos);
  EXPECT_NEAR(std::stod(sumo->option("step-length")), 0.1, 1e-9);
  EXPECT_EQ(sumo->signal_ids().size(), 9u);
  EXPECT_TRUE(has(sumo->signal_ids(), "B1"));
  ASSERT_FALSE(sumo->detectors().empty());
  EXPECT_FALSE(sumo->detectors().front().lane.empty());
  EXPECT_GT(sumo->detectors().front().position, 0);
  EXPECT_DOUBLE_EQ(sumo->time(), 0);
}

TEST_P(Backends, TellsWhoDepartsAndWhatItIs) {
  const auto sumo = start();
  SumoStep step;
  ASSERT_TRUE(run_until(*sumo, step, 5, [&] { return has(step.departed_vehicles, "v0"); }));
  const std::vector<std::string> vehicles = {"v0", "nobody"}, persons = {"walker"};
  const auto details = sumo->details(vehicles, persons);
  ASSERT_EQ(details.size(), 3u);
  EXPECT_EQ(details[0].type_id, "car");
  EXPECT_EQ(details[0].vehicle_class, "passenger");
  EXPECT_DOUBLE_EQ(details[0].length, 4.5);
  EXPECT_DOUBLE_EQ(details[0].width, 1.8);
  EXPECT_DOUBLE_EQ(details[0].height, 1.5);
  EXPECT_DOUBLE_EQ(details[0].max_speed, 33);
  EXPECT_DOUBLE_EQ(details[0].speed_factor, 1);
  EXPECT_EQ(details[0].route, (std::vector<std::string>{"A0A1", "A1A2", "A2B2"}));
  EXPECT_EQ(details[0].lane.substr(0, 4), "A0A1");
  EXPECT_GE(details[0].lane_position, 20);
  EXPECT_EQ(details[1].type_id, "");  // unknown: told, not thrown
  EXPECT_TRUE(details[2].is_person);
  EXPECT_EQ(details[2].vehicle_class, "pedestrian");
  EXPECT_EQ(details[2].route, (std::vector<std::string>{"B0B1", "B1B2"}));
  EXPECT_NEAR(details[2].arrival_position, 30, 1e-6);
}

// what is told as a person's speed is what SUMO lets it walk at
TEST_P(Backends, TellsTheSpeedThatAPersonWalksAt) {
  const auto sumo = start();
  SumoStep step;
  const std::string walker = "walker";
  ASSERT_TRUE(run_until(*sumo, step, 5, [&] { return has(step.departed_persons, walker); }));
  const SumoAgentDetails details = sumo->details({}, {&walker, 1}).at(0);
  sumo->watch(walker, true);
  EXPECT_NEAR(fastest_of_watched(*sumo), details.max_speed * details.speed_factor, 0.02);
}

// a desiredMaxSpeed, which no getter tells, shows in what SUMO lets a bicycle ride
TEST_P(Backends, TellsTheSpeedThatABicycleRidesAt) {
  scenario().folder().write("riders.rou.xml", R"(<routes>
  <vType id="rider" vClass="bicycle" maxSpeed="9" desiredMaxSpeed="4" speedFactor="0.9" speedDev="0"/>
  <vehicle id="rider" type="rider" depart="0"><route edges="C0C1 C1C2"/></vehicle>
</routes>)");
  scenario().write_config("riders.sumocfg", "net.net.xml", "riders.rou.xml");
  const auto sumo = start(scenario().folder().file("riders.sumocfg"));
  SumoStep step;
  const std::string rider = "rider";
  ASSERT_TRUE(run_until(*sumo, step, 5, [&] { return has(step.departed_vehicles, rider); }));
  const SumoAgentDetails details = sumo->details({&rider, 1}, {}).at(0);
  EXPECT_NEAR(details.allowed_speed, 3.6, 1e-9);
  sumo->watch(rider, false);
  EXPECT_NEAR(fastest_of_watched(*sumo), details.allowed_speed, 0.02);
}

TEST_P(Backends, TellsTheStopsOfAVehicle) {
  const auto sumo = start();
  SumoStep step;
  ASSERT_TRUE(run_until(*sumo, step, 20, [&] { return has(step.departed_vehicles, "stopper"); }));
  const std::vector<std::string> vehicles = {"stopper"};
  const auto details = sumo->details(vehicles, {});
  ASSERT_EQ(details.at(0).stops.size(), 1u);
  EXPECT_EQ(details[0].stops[0].lane, "A1B1_1");
  EXPECT_DOUBLE_EQ(details[0].stops[0].start, 60);
  EXPECT_DOUBLE_EQ(details[0].stops[0].end, 80);
  EXPECT_DOUBLE_EQ(details[0].stops[0].duration, 10);
  EXPECT_LT(details[0].stops[0].until, 0);
  EXPECT_FALSE(details[0].is_taxi);
}

// a ghost that stands at its stop is put onto its lane: SUMO serves the stop, and it is a ghost
// again
TEST_P(Backends, ServesTheStopOfAGhost) {
  const auto sumo = start();
  SumoStep step;
  ASSERT_TRUE(run_until(*sumo, step, 20, [&] { return has(step.departed_vehicles, "stopper"); }));
  const std::string stopper = "stopper";
  const auto stop = sumo->details({&stopper, 1}, {}).at(0).stops.at(0);
  const SumoPose first{&stopper, Vec2(60, 150), 90};
  sumo->step({&first, 1}, {}, step);
  const auto stop_state_now = [&] {
    for (const SumoAgent& seen : step.agents)
      if (seen.id == stopper) return seen.stop_state;
    return -1;
  };
  EXPECT_TRUE(sumo->details({&stopper, 1}, {}).at(0).stops.empty()) << "SUMO forgets it";
  sumo->watch(stopper, false);
  // on the stop's lane, its front at the end of it
  const RoadNetwork net = read_sumo_net(scenario().folder().file("net.net.xml"));
  const Lane& lane = net.lane(net.lane_by_name.at(stop.lane));
  const SumoPose there{&stopper, lane.centerline.point_at(stop.end), 90};
  sumo->put_on_lane(there, stop.lane, 0.0);
  sumo->add_stop(stopper, stop);
  double began = -1, ended = -1;
  for (int i = 0; i < 200 && ended < 0; ++i) {
    sumo->step({}, {}, step);
    const int state = stop_state_now();
    if (began < 0 && (state & stop_state::kStopped)) began = step.time;
    if (began >= 0 && !(state & stop_state::kStopped)) ended = step.time;
  }
  EXPECT_NEAR(ended - began, 10, 0.3);
  sumo->step({&there, 1}, {}, step);
  EXPECT_TRUE(step.lost.empty());
}

// vehicles and persons are reported at the very pose that was written, anywhere, at any angle
TEST_P(Backends, ShowsGhostsAtTheirExactPose) {
  const auto sumo = start();
  SumoStep step;
  ASSERT_TRUE(run_until(*sumo, step, 5, [&] { return has(step.departed_vehicles, "v0"); }));
  const std::string car = "v0", person = "walker";
  sumo->watch(car, false);
  sumo->watch(person, true);
  for (int i = 0; i < 200; ++i) {
    const double turn = 0.031 * i;
    SumoPose vehicle{&car, Vec2(70 + 40 * std::cos(turn), 60 + 40 * std::sin(turn)), -3.0 * i};
    SumoPose walker{&person, Vec2(75 + 20 * std::sin(turn), 75 + 5 * turn), 400.0 + i};
    sumo->step({&vehicle, 1}, {&walker, 1}, step);
    ASSERT_TRUE(step.lost.empty()) << step.lost.front();
    ASSERT_EQ(step.agents.size(), 2u) << "step " << i;
    EXPECT_EQ(step.agents[0].id, car);
    EXPECT_TRUE(step.agents[1].is_person);
    EXPECT_LT((step.agents[0].position - vehicle.position).norm(), 1e-9);
    EXPECT_LT((step.agents[1].position - walker.position).norm(), 1e-9);
    EXPECT_LT(std::abs(std::remainder(step.agents[0].angle - vehicle.angle, 360)), 1e-6);
    EXPECT_LT(std::abs(std::remainder(step.agents[1].angle - walker.angle, 360)), 1e-6);
  }
  for (const std::string& warning : sumo->take_warnings())  // the self-test was content
    EXPECT_EQ(warning.rfind("SUMO: ", 0), 0u) << warning;
  const std::vector<std::string> ids = {car};
  EXPECT_EQ(sumo->details(ids, {}).at(0).route.size(), 3u);
  EXPECT_EQ(sumo->details(ids, {}).at(0).lane, "");
}

// this pedestrian model accepts poses and ignores them: the self-test must find it out
TEST_P(Backends, APedestrianModelThatIgnoresPosesIsTold) {
  const auto sumo = start(scenario().config(), {"--pedestrian.model", "nonInteracting"});
  SumoStep step;
  const std::string walker = "walker";
  ASSERT_TRUE(run_until(*sumo, step, 5, [&] { return has(step.departed_persons, walker); }));
  const SumoPose pose{&walker, Vec2(20, 20), 0};
  try {
    for (int i = 0; i < 5; ++i) sumo->step({}, {&pose, 1}, step);
    FAIL() << "nobody noticed";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("--pedestrian.model"), std::string::npos)
        << error.what();
  }
}

TEST_P(Backends, APoseThatIsNotFiniteIsOurBug) {
  const auto sumo = start();
  SumoStep step;
  sumo->step({}, {}, step);
  const std::string id = "v0";
  SumoPose pose{&id, Vec2(std::nan(""), 0), 0};
  EXPECT_THROW(sumo->step({&pose, 1}, {}, step), std::logic_error);
  pose = {&id, Vec2(0, 0), std::numeric_limits<double>::infinity()};
  EXPECT_THROW(sumo->step({&pose, 1}, {}, step), std::logic_error);
  sumo->step({}, {}, step);  // nothing of it reached SUMO
}

TEST_P(Backends, AnAgentThatVanishedDoesNotEndTheRun) {
  const auto sumo = start();
  SumoStep step;
  sumo->step({}, {}, step);
  const std::string ghost = "nobody", car = "v0";
  const std::vector<SumoPose> poses = {{&ghost, Vec2(1, 2), 3}, {&car, Vec2(10, 20), 30}};
  const SumoPose person{&ghost, Vec2(1, 2), 3};
  sumo->set_speed(ghost, false, 1);
  sumo->remove_vehicle("nobody else");
  sumo->override_detectors(std::vector<std::pair<std::string, double>>{{"no loop", 1.0}});
  sumo->watch("nobody", false);
  EXPECT_EQ(sumo->finish_stage("nobody"), StageKind::None);
  for (int i = 0; i < 3; ++i) {
    sumo->step(poses, {&person, 1}, step);
    EXPECT_EQ(step.lost, (std::vector<std::string>{"nobody", "nobody"}));
    EXPECT_TRUE(step.agents.empty());
  }
}

TEST_P(Backends, RemovedVehicleCountsAsArrivedInSumosStatistics) {
  const std::string trips = scenario().folder().file(std::string(GetParam()) + "-trips.xml");
  const auto sumo = start(scenario().config(), {"--tripinfo-output", trips});
  SumoStep step;
  ASSERT_TRUE(run_until(*sumo, step, 5, [&] { return has(step.departed_vehicles, "v0"); }));
  const std::string car = "v0";
  sumo->watch(car, false);
  for (int i = 0; i < 10; ++i) {
    const SumoPose pose{&car, Vec2(50 + i, 50), 90};
    sumo->step({&pose, 1}, {}, step);
  }
  sumo->remove_vehicle(car);
  for (int i = 0; i < 3; ++i) {
    sumo->step({}, {}, step);
    EXPECT_FALSE(has(step.arrived_vehicles, car)) << "removed by us: not told again";
    EXPECT_TRUE(step.agents.empty());
  }
  sumo->close();
  const std::string text = scenario().folder().read(std::string(GetParam()) + "-trips.xml");
  EXPECT_NE(text.find("id=\"v0\""), std::string::npos) << text;
}

TEST_P(Backends, SumoDrivenAgentsArrive) {
  const auto sumo = start();
  SumoStep step;
  std::set<std::string> vehicles, persons;
  for (int i = 0; i < 6000 && vehicles.size() + persons.size() < 5; ++i) {
    sumo->step({}, {}, step);
    vehicles.insert(step.arrived_vehicles.begin(), step.arrived_vehicles.end());
    persons.insert(step.arrived_persons.begin(), step.arrived_persons.end());
  }
  EXPECT_EQ(vehicles, (std::set<std::string>{"v0", "stopper", CouplingScenario::kOddId}));
  EXPECT_EQ(persons, (std::set<std::string>{"walker", "stroller"}));
}

TEST_P(Backends, OddIdsAreAgentsLikeOthers) {
  const auto sumo = start();
  SumoStep step;
  const std::string id = CouplingScenario::kOddId;
  ASSERT_TRUE(run_until(*sumo, step, 40, [&] { return has(step.departed_vehicles, id); }));
  EXPECT_EQ(sumo->details({&id, 1}, {}).at(0).route, (std::vector<std::string>{"C2B2", "B2A2"}));
  sumo->watch(id, false);
  const SumoPose pose{&id, Vec2(11, 12), 13};
  sumo->step({&pose, 1}, {}, step);
  ASSERT_EQ(step.agents.size(), 1u);
  EXPECT_EQ(step.agents[0].id, id);
  EXPECT_LT((step.agents[0].position - pose.position).norm(), 1e-9);
}

// a person's walks end one by one when we say so; the last one ends the person
TEST_P(Backends, FinishesWalksOneByOne) {
  const auto sumo = start();
  SumoStep step;
  const std::string walker = "walker";
  ASSERT_TRUE(run_until(*sumo, step, 5, [&] { return has(step.departed_persons, walker); }));
  double x = 160;
  auto walk = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      x += 0.1;
      const SumoPose pose{&walker, Vec2(x, 100), 90};
      sumo->step({}, {&pose, 1}, step);
      ASSERT_TRUE(step.lost.empty());
    }
  };
  walk(20);
  EXPECT_EQ(sumo->finish_stage(walker), StageKind::Walking);
  const SumoAgentDetails next = sumo->details({}, {&walker, 1}).at(0);
  EXPECT_EQ(next.stage, StageKind::Walking);
  EXPECT_EQ(next.stages_left, 1);
  EXPECT_EQ(next.route, (std::vector<std::string>{"B1B2", "B2C2"}));
  EXPECT_NEAR(next.arrival_position, 40, 1e-6);
  walk(20);
  EXPECT_EQ(sumo->finish_stage(walker), StageKind::None);
  bool arrived = false;
  for (int i = 0; i < 3; ++i) {
    sumo->step({}, {}, step);
    arrived = arrived || has(step.arrived_persons, walker);
  }
  EXPECT_TRUE(arrived);
}

TEST_P(Backends, SignalsChange) {
  const auto sumo = start();
  SumoStep step;
  std::set<std::string> seen;
  for (int i = 0; i < 600; ++i) {
    sumo->step({}, {}, step);
    ASSERT_EQ(step.signal_states.size(), 9u);
    for (const std::string& state : step.signal_states) ASSERT_FALSE(state.empty());
    seen.insert(step.signal_states[4]);
  }
  EXPECT_GT(seen.size(), 2u);
  for (const std::string& state : seen)
    EXPECT_EQ(state.find_first_not_of("rRyYgGsuoO"), std::string::npos) << state;
}

// ghosts pass no detector, so an actuated signal sees an empty road until it is told otherwise
TEST_P(Backends, DetectorsThatAreToldOfTrafficExtendTheGreen) {
  auto changes = [&](bool told) {
    const auto sumo = start();
    const auto& ids = sumo->signal_ids();
    const auto at = static_cast<std::size_t>(std::find(ids.begin(), ids.end(), "B1") - ids.begin());
    SumoStep step;
    int count = 0;
    std::string last;
    for (int i = 0; i < 1200; ++i) {
      if (told) {
        std::vector<std::pair<std::string, double>> ages;
        for (const auto& detector : sumo->detectors())
          ages.emplace_back(detector.id, 0.1 * (i % 10));
        sumo->override_detectors(ages);
      }
      sumo->step({}, {}, step);
      if (step.signal_states.at(at) != last) ++count;
      last = step.signal_states[at];
    }
    return count;
  };
  EXPECT_LT(changes(true), changes(false));
}

// actuated ones, too, whose next switch is put off again and again
TEST_P(Backends, SignalsBySchedulesAreThoseThatAreAskedForAtEachStep) {
  using Shown = std::vector<std::pair<std::string, double>>;
  std::size_t asked = 0;
  auto shown_in = [&](bool by_schedule) {
    by_schedule_ = by_schedule;
    const auto sumo = start();
    SumoStep step;
    std::vector<Shown> all;
    asked = 0;
    for (int i = 0; i < 1200; ++i) {
      std::vector<std::pair<std::string, double>> ages;
      for (const auto& detector : sumo->detectors())
        if (i % 300 < 150) ages.emplace_back(detector.id, 0.1 * (i % 10));
      sumo->override_detectors(ages);
      sumo->step({}, {}, step);
      asked += step.asked_signals.size();
      Shown shown;
      for (std::size_t k = 0; k < step.signal_states.size(); ++k)
        shown.emplace_back(step.signal_states[k], sumo->next_switch(k));
      all.push_back(std::move(shown));
    }
    return all;
  };
  const auto every = shown_in(false);
  EXPECT_EQ(asked, 1200 * every.front().size());
  EXPECT_EQ(shown_in(true), every);
  EXPECT_LT(asked, 0.5 * 1200 * static_cast<double>(every.front().size()));
}

TEST_P(Backends, WatchesInOrderUntilToldOtherwise) {
  const auto sumo = start();
  SumoStep step;
  ASSERT_TRUE(run_until(*sumo, step, 20, [&] { return has(step.departed_vehicles, "stopper"); }));
  sumo->watch("stopper", false);
  sumo->watch("walker", true);
  sumo->watch("v0", false);
  sumo->watch("v0", false);  // once is enough
  sumo->step({}, {}, step);
  ASSERT_EQ(step.agents.size(), 3u);
  EXPECT_EQ(step.agents[0].id, "stopper");
  EXPECT_EQ(step.agents[1].id, "walker");
  EXPECT_EQ(step.agents[2].id, "v0");
  EXPECT_GT(step.agents[2].speed, 1);
  sumo->unwatch("walker", true);
  sumo->step({}, {}, step);
  ASSERT_EQ(step.agents.size(), 2u);
  EXPECT_EQ(step.agents[1].id, "v0");
  // a watched vehicle that we take out leaves no trace, and the run goes on
  sumo->remove_vehicle("stopper");
  sumo->step({}, {}, step);
  ASSERT_EQ(step.agents.size(), 1u);
  // and one that arrives by itself is dropped
  ASSERT_TRUE(run_until(*sumo, step, 3000, [&] { return has(step.arrived_vehicles, "v0"); }));
  EXPECT_TRUE(step.agents.empty());
  sumo->step({}, {}, step);
  EXPECT_TRUE(step.agents.empty());
}

TEST_P(Backends, HoldsTheSpeedOfASumoDrivenVehicle) {
  const auto sumo = start();
  SumoStep step;
  ASSERT_TRUE(run_until(*sumo, step, 5, [&] { return has(step.departed_vehicles, "v0"); }));
  sumo->watch("v0", false);
  for (int i = 0; i < 30; ++i) {
    sumo->set_speed("v0", false, 2);
    sumo->step({}, {}, step);
  }
  EXPECT_NEAR(step.agents.at(0).speed, 2, 1e-6);
  sumo->set_speed("v0", false, -1);
  for (int i = 0; i < 20; ++i) sumo->step({}, {}, step);
  EXPECT_GT(step.agents.at(0).speed, 3);
}

TEST_P(Backends, TimeGoesOnByTheStep) {
  const auto sumo = start();
  SumoStep step;
  for (int i = 1; i <= 10; ++i) {
    sumo->step({}, {}, step);
    EXPECT_NEAR(step.time, 0.1 * i, 1e-9);
    EXPECT_DOUBLE_EQ(sumo->time(), step.time);
  }
}

TEST_P(Backends, CanBeClosedTwiceAndStartedAgain) {
  for (int i = 0; i < 3; ++i) {
    const auto sumo = start();
    SumoStep step;
    sumo->step({}, {}, step);
    sumo->close();
    sumo->close();
    EXPECT_THROW(sumo->step({}, {}, step), SumoError);
    EXPECT_THROW(sumo->option("begin"), SumoError);
  }
}

// the user's mistakes: told in SUMO's words, as an error of the input
class BadInput : public Backends {
 protected:
  std::string message(const std::string& config, std::vector<std::string> more = {}) {
    try {
      const auto sumo = start(config, std::move(more));
      SumoStep step;
      sumo->step({}, {}, step);
    } catch (const SumoError& error) {
      return std::string("SumoError instead of Error: ") + error.what();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_P(BadInput, IsQuoted) {
  const CouplingScenario& files = scenario();
  EXPECT_NE(message(files.folder().file("none.sumocfg")).find("none.sumocfg"), std::string::npos);
  files.write_config("no-net.sumocfg", "missing.net.xml", "routes.rou.xml");
  const std::string no_net = message(files.folder().file("no-net.sumocfg"));
  EXPECT_NE(no_net.find("missing.net.xml"), std::string::npos) << no_net;
  files.folder().write(
      "bad.rou.xml",
      R"(<routes><vehicle id="lost" depart="0"><route edges="A0A1 nowhere"/></vehicle></routes>)");
  files.write_config("bad-edge.sumocfg", "net.net.xml", "bad.rou.xml");
  const std::string bad_edge = message(files.folder().file("bad-edge.sumocfg"));
  EXPECT_NE(bad_edge.find("nowhere"), std::string::npos) << bad_edge;
  EXPECT_EQ(bad_edge.find("SumoError"), std::string::npos) << bad_edge;
  const std::string bad_option = message(files.config(), {"--no-such-option", "1"});
  EXPECT_NE(bad_option.find("no-such-option"), std::string::npos) << bad_option;
  files.folder().write("broken.net.xml", "<net><edge id=");
  files.write_config("broken.sumocfg", "broken.net.xml", "routes.rou.xml");
  const std::string broken = message(files.folder().file("broken.sumocfg"));
  EXPECT_NE(broken.find("broken.net.xml"), std::string::npos) << broken;
  // and none of it spoils the next start
  const auto sumo = start();
  SumoStep step;
  sumo->step({}, {}, step);
}

const auto kBoth = ::testing::Values("traci", "libsumo");
INSTANTIATE_TEST_SUITE_P(Coupling, Backends, kBoth,
                         [](const auto& backend) { return std::string(backend.param); });
INSTANTIATE_TEST_SUITE_P(Coupling, BadInput, kBoth,
                         [](const auto& backend) { return std::string(backend.param); });

}  // namespace
}  // namespace sumogamma
