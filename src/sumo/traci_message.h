#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sumogamma {

/// Numbers of the TraCI protocol that this client speaks (SUMO's TraCI documentation, "Protocol"
/// and "Value retrieval").
namespace traci {
inline constexpr std::uint8_t kGetVersion = 0x00, kSimulationStep = 0x02, kSetOrder = 0x03,
                              kClose = 0x7f;

/// A domain's get command; set, subscribe and the responses are fixed offsets from it.
inline constexpr std::uint8_t kInductionLoop = 0xa0, kTrafficLight = 0xa2, kVehicle = 0xa4,
                              kEdge = 0xaa, kSimulation = 0xab, kPerson = 0xae, kLaneDomain = 0xa3,
                              kRouteDomain = 0xa6, kVehicleType = 0xa5;
constexpr std::uint8_t set_command(std::uint8_t domain) {
  return static_cast<std::uint8_t>(domain + 0x20);
}
constexpr std::uint8_t subscribe_command(std::uint8_t domain) {
  return static_cast<std::uint8_t>(domain + 0x30);
}
constexpr std::uint8_t get_response(std::uint8_t domain) {
  return static_cast<std::uint8_t>(domain + 0x10);
}
constexpr std::uint8_t subscribe_response(std::uint8_t domain) {
  return static_cast<std::uint8_t>(domain + 0x40);
}

inline constexpr std::uint8_t kTypePosition2d = 0x01, kTypePosition3d = 0x03, kTypePolygon = 0x06,
                              kTypeUByte = 0x07, kTypeByte = 0x08, kTypeInteger = 0x09,
                              kTypeDouble = 0x0b, kTypeString = 0x0c, kTypeStringList = 0x0e,
                              kTypeCompound = 0x0f, kTypeDoubleList = 0x10, kTypeColor = 0x11;
inline constexpr std::uint8_t kOk = 0x00, kNotImplemented = 0x01, kRefused = 0xff;

inline constexpr std::uint8_t kColor = 0x45, kColorType = 0x11;
inline constexpr std::uint8_t kIdList = 0x00, kPosition = 0x42, kAngle = 0x43, kSpeed = 0x40,
                              kMaxSpeed = 0x41, kLength = 0x44, kVehicleClass = 0x49, kWidth = 0x4d,
                              kHeight = 0xbc, kType = 0x4f, kLane = 0x51, kEdges = 0x54,
                              kLanePosition = 0x56, kSpeedFactor = 0x5e, kStops = 0x74,
                              kAllowedSpeed = 0xb7, kMoveToXy = 0xb4, kRemove = 0x81, kStage = 0xc0,
                              kStagesLeft = 0xc2, kRemoveStage = 0xc5, kAcceleration = 0x46,
                              kDeceleration = 0x47, kEmergencyDeceleration = 0x7b, kHeadway = 0x48,
                              kMinGap = 0x4c, kImperfection = 0x5d, kSpeedMode = 0xb3,
                              kLaneChangeMode = 0xb6, kPreviousSpeed = 0x3c,
                              kVirtualDetection = 0x22, kSignalState = 0x20, kNextSwitch = 0x2d,
                              kOption = 0x32, kTime = 0x66, kStepLength = 0x7b, kStop = 0x12,
                              kStopState = 0xb5, kRouteIndex = 0x69, kParameter = 0x7e,
                              kRidesIn = 0xc3, kRoute = 0x57, kTravelTime = 0x58, kFindRoute = 0x86,
                              kAddRoute = 0x80, kAddFull = 0x85;
inline constexpr std::uint8_t kDepartedVehicles = 0x74, kArrivedVehicles = 0x7a,
                              kDepartedPersons = 0x25, kArrivedPersons = 0x27,
                              kTeleportCount = 0x75, kEmergencyStopCount = 0x89,
                              kCollidingCount = 0x80, kPendingVehicles = 0x94;
inline constexpr std::uint8_t kRemovedAsArrived = 2;
inline constexpr int kStageWaiting = 1, kStageWalking = 2, kStageDriving = 3;
}  // namespace traci

/// A message under construction: commands in order, big-endian, behind a length that frame() fills
/// in.
class TraciWriter {
 public:
  TraciWriter() { clear(); }

  void clear();
  /// Commands appended since clear().
  std::size_t command_count() const { return command_count_; }

  // the typed values below are preceded by their type byte, the raw ones are not
  void raw_byte(std::uint8_t value) { bytes_.push_back(value); }
  void raw_integer(std::int32_t value);
  void raw_double(double value);
  void raw_string(std::string_view value);
  void typed_byte(std::uint8_t value);
  void typed_integer(std::int32_t value);
  void typed_double(double value);
  void typed_string(std::string_view value);
  void typed_strings(const std::vector<std::string>& values);
  void compound(std::int32_t items);

  /// Starts a command whose body will be body_size bytes long: the short length form up to 255
  /// bytes, else the long one.
  void begin_command(std::uint8_t command, std::size_t body_size);
  /// Reads one variable of an object.
  void get(std::uint8_t domain, std::uint8_t variable, std::string_view id);
  /// The same with one typed integer argument.
  void get(std::uint8_t domain, std::uint8_t variable, std::string_view id, std::int32_t argument);
  /// The same with one typed string argument.
  void get(std::uint8_t domain, std::uint8_t variable, std::string_view id,
           std::string_view argument);
  void set_byte(std::uint8_t domain, std::uint8_t variable, std::string_view id,
                std::uint8_t value);
  void set_integer(std::uint8_t domain, std::uint8_t variable, std::string_view id,
                   std::int32_t value);
  void set_double(std::uint8_t domain, std::uint8_t variable, std::string_view id, double value);
  /// A compound of two numbers.
  void set_pair(std::uint8_t domain, std::uint8_t variable, std::string_view id, double first,
                double second);
  /// Reports variables of an object after each step from now on (from -infinity to +infinity).
  void subscribe(std::uint8_t domain, std::string_view id, std::span<const std::uint8_t> variables);
  void simulation_step();
  /// Appends another writer's commands.
  void append(const TraciWriter& commands);

  /// The whole message with its length in front, ready to be sent.
  std::span<const std::uint8_t> frame();

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t command_count_ = 0;
};

/// Outcome of one command.
struct TraciStatus {
  std::uint8_t command = 0;
  std::uint8_t result = 0;
  std::string text;
  bool ok() const { return result == traci::kOk; }
};

/// Reads a reply with strict bounds: a lie about a length, an unknown type or a missing byte throws
/// SumoError; nothing is allocated beyond the bytes that are really there.
class TraciReader {
 public:
  explicit TraciReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::size_t remaining() const { return bytes_.size() - position_; }

  std::uint8_t byte();
  std::int32_t integer();
  double real();
  std::string string();

  /// Typed values: the type byte is read and must be the one named.
  std::int32_t typed_integer();
  double typed_double();
  std::string typed_string();
  std::vector<std::string> typed_strings();
  /// Number of items of a compound.
  std::int32_t compound();
  /// x and y of a 2-D or 3-D position.
  std::pair<double, double> typed_position();
  /// Steps over one typed value of any known type.
  void skip_value(int depth = 0);

  /// Length field of a block (short or long form), checked against what is left; returns the number
  /// of bytes behind it. `slack`: SUMO has written lengths of subscription blocks that are 4 too
  /// large since 1.13 (issue 10108).
  std::size_t block_length(std::size_t slack = 0);
  TraciStatus status();
  /// The value in the reply to get(), to be read by itself; response byte and variable must be the
  /// ones asked for.
  TraciReader value(std::uint8_t domain, std::uint8_t variable);

 private:
  void need(std::size_t count) const;
  void expect_type(std::uint8_t type);
  std::size_t count(std::size_t smallest_item);

  std::span<const std::uint8_t> bytes_;
  std::size_t position_ = 0;
};

}  // namespace sumogamma
