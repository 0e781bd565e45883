#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace sumogamma {

/// One value an agent, in place: no copy. Valid until the next observe(), longer for who holds
/// Session::hold().
template <typename Value>
class Column {
 public:
  Column() = default;
  /// `stride`: bytes from one agent's value to the next one's.
  Column(Value* first, std::size_t stride, std::size_t size)
      : first_(first), stride_(stride), size_(size) {}

  Value& operator[](std::size_t row) const {
    return *reinterpret_cast<Value*>(reinterpret_cast<std::uintptr_t>(first_) + row * stride_);
  }
  Value* data() const { return first_; }
  std::size_t stride() const { return stride_; }
  std::size_t size() const { return size_; }

 private:
  Value* first_ = nullptr;
  std::size_t stride_ = 0, size_ = 0;
};

/// What one agent may choose from (Eq. 7), and what it chooses.
struct VelocitySpace {
  /// Feasible are velocities v with (v.x - x) * normal_x + (v.y - y) * normal_y >= 0 [m/s].
  struct HalfPlane {
    double x, y, normal_x, normal_y;
  };
  std::vector<HalfPlane> planes;   ///< hard ones (K and C) first, then G
  std::vector<std::string> kinds;  ///< of each: kinematic, neighbour, obstacle, lane_boundary,
                                   ///< direction or road_limit
  std::vector<std::int64_t>
      foes;  ///< of each: row of the other agent; of an obstacle, its number; -1: neither
  std::size_t hard = 0;      ///< how many of the planes hold whatever happens
  double preferred[2] = {};  ///< v_pref [m/s]
  double chosen[2] = {};     ///< v_new [m/s]
};

/// A run whose loop is the user's own:
///
///   sumogamma::Session session({"city", "--duration", "600"});
///   while (!session.finished()) {
///     session.observe();  // SUMO's world into the scene, and what the road asks of everybody
///     session.step();     // everybody whom GAMMA drives moves by one step
///     session.advance();  // the new poses to SUMO, which makes its step
///   }
///   session.close();
///
/// Between observe() and step() rules and wishes of one's own have their place: lower (or raise)
/// allowed_speed(), and prefer(). Types of one's own are settings: {"--set",
/// "types.tuk_tuk.base=motorcycle"}.
///
/// Everything throws Error where the caller is wrong and SumoError (an Error, too) where SUMO
/// failed; a session is used by one thread at a time.
class [[gnu::visibility("default")]] Session {
 public:
  /// `words`: SCENARIO and options as behind `sumo-gamma run`. Without -o nothing is written.
  explicit Session(const std::vector<std::string>& words);
  /// Joins a SUMO through `socket`, an open TraCI connection whose owner makes SUMO's steps:
  /// observe(), step() and advance() come between two of them, and no other use of it meanwhile.
  /// The socket stays the owner's.
  Session(const std::vector<std::string>& words, int socket);
  ~Session();
  Session(Session &&) noexcept;
  Session& operator=(Session&&) noexcept;

  void observe();
  void step();
  void advance();
  /// Is the scenario's end, or the one of --duration, reached? Never where another client makes the
  /// steps.
  bool finished() const;
  /// Ends SUMO (one's own) and completes the output files. Called by the destructor where nobody
  /// else did, which can't tell of failures.
  void close();

  double time() const;         ///< [s]
  double step_length() const;  ///< [s]
  /// Hash of the exact state of all agents at all steps so far: 16 hexadecimal digits, as in
  /// results.json.
  std::string state_hash() const;

  // Everybody in the scene, one row an agent in order of arrival. SI units, x to the east.
  std::size_t size() const;
  std::string_view id(std::size_t row) const;    ///< SUMO's
  std::string_view type(std::size_t row) const;  ///< "car", "pedestrian", ...
  bool driven(std::size_t row) const;            ///< by GAMMA; else SUMO's
  /// Row of SUMO's id, or size() where it isn't in the scene.
  std::size_t find(std::string_view sumo_id) const;
  Column<const double> x() const;  ///< of the outline's centre [m]
  Column<const double> y() const;
  Column<const double> heading() const;  ///< counter-clockwise from +x [rad]
  Column<const double> velocity_x() const;
  Column<const double> velocity_y() const;
  Column<const double> speed() const;   ///< along the heading [m/s]
  Column<const double> radius() const;  ///< of the outline's circumscribed circle [m]
  /// Most speed along its path that leader, signals and rules leave to it [m/s], infinite where
  /// nothing holds it. May be changed between observe() and step().
  Column<double> allowed_speed();
  /// Keeps the memory of columns taken up to the next observe() valid while it lives; they then go
  /// on showing what was there before that.
  std::shared_ptr<const void> hold() const;
  /// What holds it: none, signal, yield, crossing, blocked_junction, leader, stop, merge,
  /// gives_way, turning_room or lets_in.
  std::string_view reason(std::size_t row) const;

  /// In the coming step it would like to move so [m/s]; it still keeps clear of others, of walls
  /// and of what its body and the road forbid.
  void prefer(std::size_t row, double velocity_x, double velocity_y);
  /// Of an agent that GAMMA drives, between observe() and step().
  VelocitySpace velocity_space(std::size_t row) const;

  /// Hands a vehicle over to GAMMA, or back to SUMO, in motion, as soon as either may take it. For
  /// sessions with `--control called` and those that share a connection. People on foot stay who
  /// they are.
  void take(const std::string& sumo_id);
  void release(const std::string& sumo_id);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace sumogamma
