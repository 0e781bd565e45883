// What a SUMO, or something that is none, can do to us over the socket.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <limits>

#include "base/error.h"
#include "sumo/backend.h"
#include "sumo/sumo_process.h"
#include "support/fake_sumo_server.h"

namespace sumogamma {
namespace {

using Bytes = FakeSumoServer::Bytes;
using Then = FakeSumoServer::Then;

SumoStart joining(int port) {
  SumoStart start;
  start.connect_host = "127.0.0.1";
  start.connect_port = port;
  start.start_timeout = 0.5;
  start.step_timeout = 0.5;
  return start;
}

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void set_length(Bytes& reply, std::int32_t length) {
  Bytes bytes;
  FakeSumoServer::put_integer(bytes, length);
  std::copy(bytes.begin(), bytes.end(), reply.begin());
}

// spoils the reply to the first step
FakeSumoServer::Spoil at_step(std::function<Then(Bytes&)> spoil) {
  return [spoil](int message, Bytes& reply) { return message == 3 ? spoil(reply) : Then::Send; };
}

// the first step against that server must end with a SumoError soon, and later calls at once
void expect_sumo_error(FakeSumoServer& server, const std::string& words = "") {
  server.serve();
  const auto sumo = start_traci_backend(joining(server.port()));
  SumoStep step;
  const double seconds = seconds_of([&] {
    try {
      sumo->step({}, {}, step);
      ADD_FAILURE() << "no error";
    } catch (const SumoError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  });
  EXPECT_LT(seconds, 5);
  EXPECT_LT(seconds_of([&] { EXPECT_THROW(sumo->step({}, {}, step), SumoError); }), 0.1);
  sumo->close();
}

TEST(TraciFaults, AnHonestServerIsNoFault) {
  FakeSumoServer server;
  server.signals = {"south", "north"};
  server.serve();
  const auto sumo = start_traci_backend(joining(server.port()));
  EXPECT_EQ(sumo->version(), "SUMO fake");
  EXPECT_EQ(sumo->signal_ids(), (std::vector<std::string>{"south", "north"}));
  EXPECT_TRUE(sumo->take_warnings().empty());
  SumoStep step;
  sumo->step({}, {}, step);
  EXPECT_DOUBLE_EQ(step.time, 0.1);
  EXPECT_EQ(step.signal_states, (std::vector<std::string>{"rG", "rG"}));
  EXPECT_EQ(sumo->sumo_warnings(), -1);
}

// one exchange a step, however many agents
TEST(TraciFaults, AStepIsOneMessage) {
  FakeSumoServer server;
  server.serve();
  const auto sumo = start_traci_backend(joining(server.port()));
  SumoStep step;
  const std::vector<std::string> ids(500, "v");
  std::vector<SumoPose> poses;
  for (const std::string& id : ids) poses.push_back({&id, Vec2(1, 2), 3});
  sumo->step(poses, {}, step);  // and the self-test around it
  const int before = server.messages();
  for (int i = 0; i < 10; ++i) {
    sumo->set_speed("v", false, 1);
    sumo->step(poses, {}, step);
  }
  EXPECT_EQ(server.messages() - before, 10);
}

// a SUMO that maps ghosts onto lanes all the same is driven the other way, and the user is told
// once
TEST(TraciFaults, ASumoThatKeepsGhostsOnLanesGetsTheFallback) {
  FakeSumoServer server;
  server.lane = "a_0";
  server.serve();
  const auto sumo = start_traci_backend(joining(server.port()));
  SumoStep step;
  const std::string id = "v";
  const SumoPose pose{&id, Vec2(3, 4), 5};
  sumo->step({&pose, 1}, {}, step);
  EXPECT_EQ(server.keep_route, 2);
  EXPECT_EQ(sumo->take_warnings().size(), 1u);
  for (int i = 0; i < 3; ++i) sumo->step({&pose, 1}, {}, step);
  EXPECT_EQ(server.keep_route, 3);
  EXPECT_TRUE(sumo->take_warnings().empty());
}

TEST(TraciFaults, NobodyListens) {
  const SumoStart start = joining(free_port());
  try {
    start_traci_backend(start);
    FAIL();
  } catch (const SumoError& error) {
    FAIL() << "the port is the user's input: " << error.what();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("--remote-port"), std::string::npos) << error.what();
  }
}

TEST(TraciFaults, UnknownHost) {
  SumoStart start = joining(1);
  start.connect_host = "no.such.host.invalid";
  EXPECT_THROW(start_traci_backend(start), Error);
}

TEST(TraciFaults, AServerThatSaysNothing) {
  FakeSumoServer server([](int, Bytes&) { return Then::Hang; });
  server.serve();
  EXPECT_LT(seconds_of([&] { EXPECT_THROW(start_traci_backend(joining(server.port())), Error); }),
            3);
}

TEST(TraciFaults, AServerOfAnotherProtocol) {
  FakeSumoServer server([](int, Bytes& reply) {
    const std::string text = "SSH-2.0-OpenSSH_9.2\r\n";
    reply.assign(text.begin(), text.end());
    return Then::Send;
  });
  server.serve();
  EXPECT_THROW(start_traci_backend(joining(server.port())), Error);
}

TEST(TraciFaults, AnOldOrNewProtocolIsAWarning) {
  for (const std::int32_t protocol : {17, 23}) {
    FakeSumoServer server;
    server.protocol = protocol;
    server.serve();
    const auto sumo = start_traci_backend(joining(server.port()));
    const auto warnings = sumo->take_warnings();
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find(std::to_string(protocol)), std::string::npos);
  }
}

TEST(TraciFaults, LengthZero) {
  FakeSumoServer server(at_step([](Bytes& reply) {
    set_length(reply, 0);
    return Then::Send;
  }));
  expect_sumo_error(server, "length");
}

TEST(TraciFaults, LengthNegativeOrHuge) {
  for (const std::int32_t length : {-1, std::numeric_limits<std::int32_t>::max(), 3}) {
    FakeSumoServer server(at_step([length](Bytes& reply) {
      set_length(reply, length);
      return Then::Send;
    }));
    expect_sumo_error(server, "length");
  }
}

// a length within the limit that is not filled: we must wait in bounded time and memory
TEST(TraciFaults, LengthBeyondWhatComes) {
  FakeSumoServer server(at_step([](Bytes& reply) {
    set_length(reply, 400 << 20);
    return Then::Send;
  }));
  expect_sumo_error(server, "time limit");
}

// a step's own reply, and the one about signals behind it
constexpr int kStepReply = 3, kSignalsReply = 4;

// cuts a reply at every place, and expects an error each time; returns how long it is uncut
std::size_t expect_error_wherever_cut(int which) {
  std::atomic<std::size_t> whole = 0;
  for (std::size_t keep = 4; keep == 4 || keep < whole; ++keep) {
    FakeSumoServer server([which, keep, &whole](int message, Bytes& reply) {
      if (message != which) return Then::Send;
      whole = reply.size();
      reply.resize(keep);
      set_length(reply, static_cast<std::int32_t>(keep));
      return Then::Send;
    });
    server.signals = {"a"};
    expect_sumo_error(server);
  }
  return whole;
}

// law: a reply cut anywhere is an error, never a step
TEST(TraciFaults, EveryTruncationOfAStep) {
  EXPECT_GT(expect_error_wherever_cut(kStepReply) + expect_error_wherever_cut(kSignalsReply), 100u);
}

// changes a reply at every place; returns how long it is, and adds what came of it to `errors`
std::size_t change_every_byte(int which, int& errors) {
  std::atomic<std::size_t> whole = 0;
  for (std::size_t at = 4; at == 4 || at < whole; ++at) {
    FakeSumoServer server([which, at, &whole](int message, Bytes& reply) {
      if (message != which) return Then::Send;
      whole = reply.size();
      reply[at] = static_cast<std::uint8_t>(reply[at] ^ 0x55);
      return Then::Send;
    });
    server.signals = {"a"};
    server.serve();
    const auto sumo = start_traci_backend(joining(server.port()));
    SumoStep step;
    try {
      sumo->step({}, {}, step);
    } catch (const SumoError&) {
      ++errors;
    }
  }
  return whole;
}

// law: one byte changed anywhere ends in a step or an error, in bounded time
TEST(TraciFaults, EveryByteOfAStepChanged) {
  int errors = 0;
  const std::size_t whole =
      change_every_byte(kStepReply, errors) + change_every_byte(kSignalsReply, errors);
  EXPECT_GT(errors, 10);
  EXPECT_GT(whole, 100u);
}

TEST(TraciFaults, DiesBeforeTheReply) {
  FakeSumoServer server(at_step([](Bytes&) { return Then::Close; }));
  expect_sumo_error(server, "closed the connection");
}

TEST(TraciFaults, DiesInTheMiddleOfTheReply) {
  FakeSumoServer server(at_step([](Bytes& reply) {
    reply.resize(reply.size() / 2);
    return Then::SendAndClose;
  }));
  expect_sumo_error(server, "closed the connection");
}

TEST(TraciFaults, Hangs) {
  FakeSumoServer server(at_step([](Bytes&) { return Then::Hang; }));
  expect_sumo_error(server, "time limit");
}

TEST(TraciFaults, AStepThatIsRefused) {
  FakeSumoServer server(at_step([](Bytes& reply) {
    Bytes refusal(4, 0);
    refusal.insert(refusal.end(),
                   {11, traci::kSimulationStep, 0xff, 0, 0, 0, 4, 'o', 'o', 'p', 's'});
    reply = refusal;
    set_length(reply, static_cast<std::int32_t>(reply.size()));
    return Then::Send;
  }));
  expect_sumo_error(server, "oops");
}

TEST(TraciFaults, ARefusalForOneAgentConcernsThatAgentAlone) {
  FakeSumoServer server;
  server.refused = {"gone"};
  server.serve();
  const auto sumo = start_traci_backend(joining(server.port()));
  SumoStep step;
  const std::string gone = "gone", here = "here";
  const std::vector<SumoPose> poses = {{&gone, Vec2(0, 0), 0}, {&here, Vec2(1, 1), 1}};
  sumo->watch(gone, false);
  sumo->watch(here, false);
  sumo->set_speed(gone, false, 3);
  for (int i = 0; i < 3; ++i) {
    sumo->step(poses, {}, step);
    EXPECT_EQ(step.lost, std::vector<std::string>{"gone"});
    ASSERT_EQ(step.agents.size(), 1u);
    EXPECT_EQ(step.agents[0].id, "here");
  }
}

TEST(TraciFaults, AnswersToAnotherCommandAreNotBelieved) {
  FakeSumoServer server(at_step([](Bytes& reply) {
    reply[5] = traci::kClose;
    return Then::Send;
  }));
  expect_sumo_error(server, "another command");
}

// SUMO writes the length of some subscription blocks 4 too large
TEST(TraciFaults, ABlockLengthFourTooLargeIsForgiven) {
  FakeSumoServer server(at_step([](Bytes& reply) {
    const std::size_t length_at = 4 + 7 + 4 + 1;  // frame, status, count, the zero of the long form
    reply[length_at + 3] = static_cast<std::uint8_t>(reply[length_at + 3] + 4);
    return Then::Send;
  }));
  server.serve();
  const auto sumo = start_traci_backend(joining(server.port()));
  SumoStep step;
  EXPECT_NO_THROW(sumo->step({}, {}, step));
  EXPECT_DOUBLE_EQ(step.time, 0.1);
}

TEST(TraciFaults, IdsOfAnyBytes) {
  FakeSumoServer server;
  server.serve();
  const auto sumo = start_traci_backend(joining(server.port()));
  SumoStep step;
  for (const std::string& id : {std::string(), std::string("a b\n\"<&;|\0z", 11),
                                std::string(300, 'x'), std::string("\xff\xfe")}) {
    const SumoPose pose{&id, Vec2(3, 4), 5};
    sumo->watch(id, false);
    sumo->step({&pose, 1}, {}, step);
    EXPECT_TRUE(step.lost.empty());
    ASSERT_EQ(step.agents.size(), 1u);
    EXPECT_EQ(step.agents[0].id, id);
    EXPECT_EQ(step.agents[0].position, Vec2(3, 4));
    sumo->unwatch(id, false);
  }
}

}  // namespace
}  // namespace sumogamma
