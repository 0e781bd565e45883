#include "ego/ego_protocol.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

#include "base/random.h"
#include "ego/ego_socket.h"

namespace sumogamma {
namespace {

using nlohmann::json;

std::string refusal(const std::string& bytes) {
  MessageFormat format{};
  try {
    decode_message(bytes, format);
  } catch (const ProtocolError& error) {
    return error.what;
  }
  return "";
}

TEST(EgoProtocol, ReadsTheSameFromTextAndBytes) {
  const json message{{"type", "step"}, {"action", {{"acceleration", 0.1 + 0.2}}}};
  for (const MessageFormat format : {MessageFormat::Json, MessageFormat::Cbor}) {
    MessageFormat seen{};
    const json read = decode_message(encode_message(message, format), seen);
    EXPECT_EQ(seen, format);
    EXPECT_EQ(action_of(read["action"]).acceleration, 0.1 + 0.2) << "every bit of it";
  }
}

TEST(EgoProtocol, RefusesWhatIsNoMessage) {
  for (const char* bytes : {"{", "{}", "[]", "{\"type\": 3}", "{\"type\": \"step\"} x", "\xa1",
                            "NaN", "{\"type\": NaN}", "\xff\xff\xff\xff"})
    EXPECT_NE(refusal(bytes), "") << bytes;
  EXPECT_EQ(refusal("{\"type\": \"step\"}"), "");
}

TEST(EgoProtocol, RefusesWhatIsNestedWithoutEnd) {
  EXPECT_NE(refusal(std::string(60000, '\x81')), "");
  EXPECT_NE(refusal("{\"type\":" + std::string(30000, '[') + std::string(30000, ']') + "}"), "");
  // an array of four thousand million items, of which none comes
  EXPECT_NE(refusal(std::string("\xa1\x61\x61\x9a\xff\xff\xff\xff", 8)), "");
}

TEST(EgoProtocol, NeverDoesAnythingButReadOrRefuse) {
  const std::string good = encode_message(
      {{"type", "step"}, {"action", {{"trajectory", {{0.5, 1.0, 2.0}}}}}}, MessageFormat::Cbor);
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    std::string bytes = good;
    const std::uint64_t changes = 1 + random_bits(seed, 0, 0, Draw::Demand) % 6;
    for (std::uint64_t k = 1; k <= changes; ++k) {
      const std::uint64_t bits = random_bits(seed, k, 0, Draw::Demand);
      bytes[bits % bytes.size()] = static_cast<char>(bits >> 32);
    }
    if (seed % 3 == 0) bytes.resize(seed % bytes.size());
    MessageFormat format{};
    try {
      const json message = decode_message(bytes, format);
      if (message.contains("action")) action_of(message["action"]);
    } catch (const ProtocolError&) {
    }
  }
}

TEST(EgoProtocol, AnActionIsFiniteAndOfOneOfThreeKinds) {
  EXPECT_EQ(action_of({{"acceleration", -3}}).acceleration, -3.0);
  EXPECT_EQ(action_of({{"acceleration", 1}, {"steering", 0.2}}).steering, 0.2);
  EXPECT_EQ(action_of({{"trajectory", {{0.5, 1, 2}, {1.0, 3, 4}}}}).trajectory.size(), 2u);
  for (const json& wrong :
       {json(3), json({{"steering", 1}}), json({{"acceleration", "fast"}}),
        json({{"acceleration", std::nan("")}}), json({{"acceleration", 1}, {"steering", nullptr}}),
        json({{"trajectory", json::array()}}), json({{"trajectory", {{1, 2}}}}),
        json({{"trajectory", {{0, 1, 1}}}}), json({{"trajectory", {{1, 1, 1}, {1, 2, 2}}}})})
    EXPECT_THROW(action_of(wrong), ProtocolError) << wrong;
}

TEST(EgoProtocol, AQuestionHasBounds) {
  EXPECT_EQ(futures_request_of({{"plan", {1, -3}}, {"samples", 4}}).samples, 4);
  EXPECT_EQ(futures_request_of({{"plan", {1, -3}}}).plan.size(), 2u);
  EXPECT_FALSE(futures_request_of({{"ways", "believed"}}).knows);
  EXPECT_TRUE(futures_request_of({{"ways", "true"}}).knows);
  for (const json& wrong :
       {json({{"samples", 0}}), json({{"samples", 201}}), json({{"samples", 1.5}}),
        json({{"plan", "brake"}}), json({{"plan", {nullptr}}}), json({{"ways", "mine"}}),
        json({{"ways", true}})})
    EXPECT_THROW(futures_request_of(wrong), ProtocolError) << wrong;
}

class EgoSocket : public ::testing::Test {
 protected:
  EgoSocket() {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) throw std::runtime_error("no socketpair");
    server_ = std::make_unique<EgoConnection>(ends[0]);
    other_ = ends[1];
  }
  ~EgoSocket() override { hang_up(); }
  void put(const std::string& bytes) {
    ASSERT_EQ(write(other_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  void hang_up() {
    if (other_ >= 0) close(other_);
    other_ = -1;
  }
  Received::Kind next() { return server_->receive(0.05, {}).kind; }

  std::unique_ptr<EgoConnection> server_;
  int other_ = -1;
};

TEST_F(EgoSocket, PutsMessagesTogether) {
  put(std::string("\0\0", 2));
  EXPECT_EQ(next(), Received::Kind::Late);
  put(std::string("\0\3ab", 4));
  EXPECT_EQ(next(), Received::Kind::Late);
  put(std::string("c\0\0\0\1x", 6));
  EXPECT_EQ(server_->receive(0.05, {}).bytes, "abc");
  EXPECT_EQ(server_->receive(0.05, {}).bytes, "x");
  EXPECT_EQ(next(), Received::Kind::Late);
}

TEST_F(EgoSocket, RefusesLengthsBeforeItReads) {
  put(std::string("\x40\0\0\0", 4));  // a gigabyte
  EXPECT_EQ(next(), Received::Kind::Bad);
}

TEST_F(EgoSocket, RefusesAnEmptyMessage) {
  put(std::string("\0\0\0\0", 4));
  EXPECT_EQ(next(), Received::Kind::Bad);
}

TEST_F(EgoSocket, TellsAnEndAmidAMessageFromOneBetweenTwo) {
  put(std::string("\0\0\0\5ab", 6));
  hang_up();
  EXPECT_EQ(next(), Received::Kind::Bad);
}

TEST_F(EgoSocket, TellsThatTheOtherSideIsGone) {
  hang_up();
  EXPECT_EQ(next(), Received::Kind::Closed);
  EXPECT_FALSE(server_->send(std::string(1 << 20, 'x'), 0.2));
}

TEST_F(EgoSocket, StopsWaitingWhereTheProgramIsToEnd) {
  EXPECT_EQ(server_->receive(60.0, [] { return true; }).kind, Received::Kind::Late);
}

}  // namespace
}  // namespace sumogamma
