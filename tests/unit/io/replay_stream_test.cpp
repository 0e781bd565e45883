#include "io/replay_stream.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/subprocess.h"
#include "io/replay_marks.h"
#include "support/open_scene.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const AgentName kName = [](AgentId id) -> std::string_view { return id.value ? "other" : "first"; };

/// What the page's own decoder makes of a recording; null where there is no node.
json decoded(const std::string& bytes) {
  if (find_program("node").empty()) return nullptr;
  const fs::path file =
      fs::temp_directory_path() / ("sumogamma_stream_" + std::to_string(getpid()) + ".bin");
  std::ofstream(file, std::ios::binary) << bytes;
  ProcessRequest request;
  request.arguments = {"node", SUMOGAMMA_SOURCE_DIR "/tests/support/decode_replay.mjs",
                       SUMOGAMMA_SOURCE_DIR, file.string()};
  request.time_limit = 60;
  const ProcessResult result = run_process(request);
  fs::remove(file);
  EXPECT_TRUE(result.ok()) << result.errors;
  return json::parse(result.output);
}

#define SKIP_WITHOUT_NODE()         \
  if (find_program("node").empty()) \
  GTEST_SKIP() << "no node in PATH: recordings were NOT read by the page's decoder"

std::string header(const Model& model) { return replay_header("Open", model.road, model.types); }

/// Many of all kinds close together: all that a half-plane can come from off roads.
TEST(ReplayStream, VelocitySpacesAreTheModelsOwn) {
  SKIP_WITHOUT_NODE();
  const Model model = test::open_model();
  const Scene scene = test::random_scene(model, 5, 12, 25);
  Workers workers(1);
  TickGeometry geometry;
  prepare_tick(model, scene, workers, geometry);
  std::vector<InspectedAgent> inspected(scene.size());
  for (std::size_t row = 0; row < scene.size(); ++row) {
    inspected[row].id = scene.id[row];
    inspected[row].velocity = scene.velocity[row];
    inspected[row].chosen =
        gamma_velocity(model, scene, geometry, row, scene.behavior[row], inspected[row].work);
    inspected[row].binding = binding_of(scene, row, inspected[row].chosen, inspected[row].work);
  }
  ReplayEncoder encoder;
  ASSERT_TRUE(encoder.add_step({scene, kName}));
  EXPECT_TRUE(encoder.is_at(scene.time));
  encoder.add_spaces(inspected);
  encoder.end();
  const json found = decoded(header(model) + encoder.take());

  std::size_t soft = 0, hard = 0;
  const auto expect_near = [](const json& point, const Vec2& truth) {
    EXPECT_NEAR(point[0].get<double>(), truth.x(), 6e-4);
    EXPECT_NEAR(point[1].get<double>(), truth.y(), 6e-4);
  };
  for (const InspectedAgent& agent : inspected) {
    SCOPED_TRACE(agent.id.value);
    const json& space = found["spaces"][std::to_string(agent.id.value)][0];
    const ConstraintSet& all = agent.work.constraints;
    expect_near(space["preferred"], agent.work.preferred);
    expect_near(space["answer"], agent.work.result.point);
    expect_near(space["chosen"], agent.chosen);
    expect_near(space["velocity"], agent.velocity);
    EXPECT_NEAR(space["fastest"].get<double>(), agent.work.fastest, 6e-4);
    EXPECT_NEAR(space["violation"].get<double>(), agent.work.result.violation, 6e-4);
    EXPECT_EQ(space["plane"], agent.work.result.binding);
    EXPECT_EQ(space["binding"], static_cast<int>(agent.binding.kind));
    EXPECT_EQ(space["hard"], all.hard_count);
    ASSERT_EQ(space["planes"].size(), all.planes.size());
    hard += all.hard_count;
    soft += all.planes.size() - all.hard_count;
    for (std::size_t i = 0; i < all.planes.size(); ++i) {
      const json& plane = space["planes"][i];
      EXPECT_EQ(plane["kind"], static_cast<int>(all.sources[i].kind));
      EXPECT_EQ(plane["foe"], all.sources[i].foe);
      EXPECT_NEAR(plane["offset"].get<double>(), all.planes[i].point.dot(all.planes[i].normal),
                  6e-4);
      EXPECT_NEAR(plane["normal"][0].get<double>(), all.planes[i].normal.x(), 1e-4);
      EXPECT_NEAR(plane["normal"][1].get<double>(), all.planes[i].normal.y(), 1e-4);
    }
  }
  EXPECT_GT(soft, 10u) << "the scene should hold half-planes of G";
  EXPECT_GT(hard, 10u) << "and of K";
}

TEST(ReplayStream, StepsAreReadAsTheyWere) {
  SKIP_WITHOUT_NODE();
  const Model model = test::open_model();
  Scene scene = test::random_scene(model, 2, 5, 60);
  scene.control[1] = Control::External;
  scene.control[2] = Control::Planned;
  ReplayEncoder encoder(0.1);
  std::vector<Scene> shown;
  std::vector<Binding> bindings(scene.size());
  for (int tick = 0; tick < 40; ++tick) {
    test::step(model, scene, 0.05);
    // whom they wait for changes twice
    scene.context[0].active = true;
    scene.context[0].reason = tick < 20 ? LimitReason::Leader : LimitReason::Signal;
    scene.context[0].foe = tick < 20 ? 3 : -1;
    bindings[3] = {BindingKind::Neighbour, tick % 4 < 2 ? 1 : 0};
    if (encoder.add_step({scene, kName, nullptr, nullptr, bindings})) shown.push_back(scene);
  }
  ASSERT_EQ(shown.size(), 20u);
  encoder.end();
  const json found = decoded(header(model) + encoder.take());
  EXPECT_TRUE(found["ended"].get<bool>());
  ASSERT_EQ(found["agents"].size(), 5u);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    EXPECT_NEAR(found["times"][i].get<double>(), shown[i].time, 1e-9);
    for (std::size_t row = 0; row < 5; ++row) {
      const json& agent = found["agents"][row];
      EXPECT_NEAR(agent["x"][i].get<double>(), shown[i].position[row].x(), 0.006);
      EXPECT_NEAR(agent["y"][i].get<double>(), shown[i].position[row].y(), 0.006);
      EXPECT_NEAR(std::remainder(agent["h"][i].get<double>() - shown[i].heading[row], 2 * kPi), 0,
                  0.001);
      EXPECT_EQ(agent["state"][i].get<int>() >> 5, static_cast<int>(shown[i].control[row]));
    }
    const json& first = found["agents"][0];
    EXPECT_EQ(first["state"][i].get<int>() & 31,
              16 + static_cast<int>(i < 10 ? LimitReason::Leader : LimitReason::Signal));
    EXPECT_EQ(first["foe"][i], i < 10 ? 3 : -1);
    EXPECT_EQ(found["agents"][3]["bind"][i], static_cast<int>(BindingKind::Neighbour));
    EXPECT_EQ(found["agents"][3]["bindFoe"][i], i % 2 == 0 ? 1 : 0);
  }
  EXPECT_EQ(found["agents"][0]["name"], "first");
  EXPECT_NEAR(found["agents"][0]["behaviour"]["speed"].get<double>(), shown[0].preferred_speed[0],
              0.006);
}

/// Who joins a run that goes on reads from where the encoder began again.
TEST(ReplayStream, IsReadableFromWhereItBeganAgain) {
  SKIP_WITHOUT_NODE();
  const Model model = test::open_model();
  Scene scene = test::random_scene(model, 3, 4, 80);
  ReplayEncoder encoder(0.05);
  std::string whole = header(model), late = whole;
  for (int tick = 0; tick < 10; ++tick) {
    test::step(model, scene, 0.05);
    if (tick == 5) {
      encoder.begin_again();
      std::vector<bool> gone(scene.size(), false);
      gone[1] = true;
      remove_agents(scene, gone);
    }
    ASSERT_TRUE(encoder.add_step({scene, kName}));
    const std::string records = encoder.take();
    whole += records;
    if (tick >= 5) late += records;
  }
  const json all = decoded(whole), rest = decoded(late);
  ASSERT_EQ(all["agents"].size(), 4u) << "who was there before is the same agent";
  ASSERT_EQ(rest["agents"].size(), 3u);
  EXPECT_EQ(all["agents"][0]["length"], 10);
  EXPECT_EQ(all["agents"][1]["length"], 5);
  EXPECT_EQ(rest["agents"][0]["length"], 5);
  EXPECT_EQ(rest["times"].back(), all["times"].back());
  EXPECT_EQ(rest["agents"][2]["x"].back(), all["agents"][3]["x"].back());
}

TEST(ReplayStream, PlansAreReadAsTheyWere) {
  SKIP_WITHOUT_NODE();
  const Model model = test::open_model();
  const Scene scene = test::random_scene(model, 3, 4, 80);
  PlanTrace plan;
  plan.ego = scene.id[0];
  plan.time = 12.35;
  plan.action.acceleration = -3;
  plan.action.steering = 0.125;
  plan.beliefs = {
      {scene.id[2], {{0.875, {Vec2(10, -20), Vec2(11.5, -20.25)}}, {0.125, {Vec2(10, -20)}}}}};
  plan.scenarios.resize(2);
  plan.scenarios[0] = {{scene.id[2], 1, {}}};
  plan.scenarios[1] = {{scene.id[0], -1, {Vec2(1, 2), Vec2(3, 4)}}};
  plan.figures = PlanTrace::Figures::Values;
  const double infinity = std::numeric_limits<double>::infinity();
  plan.choices = {{3, -infinity, 0}, {-3, -1234.5678, -2.25}};
  PlanTrace next;
  next.ego = scene.id[0];
  next.time = 12.7;
  next.action.trajectory = {{0, {5, 5}}, {1, {7, 5}}};
  ReplayEncoder encoder;
  ASSERT_TRUE(encoder.add_step({scene, kName}));
  encoder.add_plan(plan);
  encoder.add_plan(next);
  encoder.end();
  const json found = decoded(header(model) + encoder.take());
  EXPECT_TRUE(found["ended"].get<bool>());
  ASSERT_EQ(found["plans"].size(), 2u);
  json expected = {{"time", 12.35},      {"ego", scene.id[0].value}, {"action", 1},
                   {"acceleration", -3}, {"steering", 0.125},        {"trajectory", json::array()},
                   {"figures", 1}};
  expected["choices"] = json::parse(
      R"([{"acceleration": 3}, {"acceleration": -3, "lower": -1234.568, "upper": -2.25}])");
  expected["beliefs"][std::to_string(scene.id[2].value)] = json::parse(
      R"([{"probability": 0.875, "line": [[10, -20], [11.5, -20.25]]},
          {"probability": 0.125, "line": [[10, -20]]}])");
  expected["scenarios"] = json::array(
      {json::array({{{"id", scene.id[2].value}, {"way", 1}, {"line", json::array()}}}),
       json::array(
           {{{"id", scene.id[0].value}, {"way", -1}, {"line", json::parse("[[1, 2], [3, 4]]")}}})});
  EXPECT_EQ(found["plans"][0], expected);
  EXPECT_EQ(found["plans"][1]["action"], 2);
  EXPECT_EQ(found["plans"][1]["trajectory"], json::parse("[[5, 5], [7, 5]]"));
}

TEST(ReplayMarks, SayWhatHappened) {
  CollisionPair pair;
  pair.since = 12;
  pair.a = {3};
  pair.b = {5};
  pair.depth = 0.123;
  pair.duration = 0.4;
  EXPECT_EQ(mark_of(pair, false).words, "");
  EXPECT_EQ(mark_of(pair, true).words, "up to 0.12 m deep, 0.4 s in all");
  EXPECT_EQ(mark_of(pair, true).time, mark_of(pair, false).time);

  Conflict conflict;
  conflict.kind = ConflictKind::Crossing;
  conflict.time_to_collision = 2.0;
  conflict.deceleration = 3.25;
  EXPECT_EQ(mark_of(conflict).kind, ReplayEventKind::Encounter);
  EXPECT_EQ(mark_of(conflict).words, "crossing, 2.0 s to a collision, braking of 3.2 m/s² asked");
  conflict.time_to_collision = 1.4;
  EXPECT_EQ(mark_of(conflict).kind, ReplayEventKind::Conflict);

  StuckAgent stuck;
  stuck.since = 40;
  stuck.reason = LimitReason::Yield;
  stuck.foe = 1;
  stuck.head = 2;
  stuck.head_reason = LimitReason::Signal;
  const ReplayEvent mark = mark_of(stuck, 100, kName);
  EXPECT_EQ(mark.words,
            "stands since 40 s, because of: yield, first of the queue is other (signal)");
  EXPECT_EQ(mark.b, AgentId{1});

  OffenceSpan offence;
  offence.kind = Offence::Sidewalk;
  offence.duration = 2.5;
  EXPECT_EQ(mark_of(offence, true).kind, ReplayEventKind::Sidewalk);
  EXPECT_EQ(mark_of(offence, true).words, "for 2.5 s");
}

}  // namespace
}  // namespace sumogamma
