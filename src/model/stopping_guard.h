#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geometry/half_plane.h"
#include "model/model.h"
#include "model/tick_geometry.h"
#include "model/tracking.h"

namespace sumogamma {

/// Keeps bodies apart that half-planes can't: those that turn, and those whose brakes need their
/// way.
///
/// Law: if everybody brakes now, nobody touches anybody. A velocity is admitted if this still holds
/// after one tick under it: at a few instants until both stand, the own braking outline keeps
/// `guard_margin` from the other's, and where both could take the same free ground within the tick
/// it keeps to its own half of it (the line midway between the two outlines as they would brake
/// now). So braking is always a way out, for all at once and without a word between them; as long
/// as the instants are dense enough, bodies that are apart stay apart. Agents that the model
/// doesn't drive go on as they do unless they go the same way. Bodies that overlap already are left
/// to the push-out of G.
class StoppingGuard {
 public:
  static constexpr std::size_t kInstants = 4;

  /// Where one body is at one instant.
  struct Pose {
    Vec2 position, forward;
  };

  /// A body that holds its wheels and brakes.
  struct Braking {
    Vec2 position, forward;
    Vec2 direction;           ///< of the motion, unit
    double speed = 0;         ///< [m/s]
    double deceleration = 1;  ///< [m/s^2]
    double curvature = 0;     ///< of the rear axle's way [1/m]
    double axle = 0;          ///< rear axle behind the position [m]

    double duration() const { return speed / deceleration; }  ///< until it stands [s]
  };

  /// Begins with a row. `near`: rows that it could touch before both stand; must outlive the use of
  /// this guard.
  void prepare(const Model& model, const Scene& scene, const TickGeometry& geometry,
               std::size_t row, std::span<const std::uint32_t> near);

  /// True where the body may be asked for `velocity` [m/s].
  bool admits(const Vec2& velocity);

  /// True where the row overlaps somebody.
  bool overlapping() const;

  /// The body after a tick under `velocity` if that is what was looked at last; null otherwise.
  const BodyState* body_after(const Vec2& velocity) const {
    return velocity == looked_at_ ? &next_.body : nullptr;
  }

 private:
  /// What the two leave between them at one instant if both brake now.
  struct Room {
    bool known = false;        ///< looked at already
    double gap = 0;            ///< [m]
    Vec2 axis = Vec2::Zero();  ///< from the row to the foe, along which that gap is measured
    double middle = 0;         ///< of the gap, along the axis [m]
  };

  /// A neighbour as it brakes.
  struct Foe {
    std::uint32_t row = 0;
    bool overlaps = false;  ///< already: left to the push-out of G
    double duration = 0;    ///< until both stand [s]
    double free_way =
        0;  ///< farther apart than this nothing that the foe does within a tick matters [m]
    std::array<Pose, kInstants> poses;  ///< of the foe
    std::array<Room, kInstants> room;   ///< filled where it is asked for
  };

  /// Does the row drive or walk on a road? There bodies that overlap never push through each other.
  bool on_road() const;
  bool in_lane() const;  ///< on a road, and on wheels
  Braking braking_after(const Vec2& velocity);
  Foe& foe_of(std::uint32_t other);
  Foe look_closely(std::uint32_t other) const;
  const Room& room_at(Foe& foe, std::size_t instant) const;
  bool clear_by_far(const OrientedBox& swept, std::uint32_t other) const;
  bool clear_at(Foe& foe, std::size_t instant, const Pose& pose) const;
  double gap_between(const Pose& own, const Pose& theirs, std::size_t other) const;

  const Model* model_ = nullptr;
  const Scene* scene_ = nullptr;
  const TickGeometry* geometry_ = nullptr;
  std::size_t row_ = 0;
  std::span<const std::uint32_t> near_;
  /// Velocity of the last look [m/s], NaN for none.
  Vec2 looked_at_ = Vec2::Constant(std::numeric_limits<double>::quiet_NaN());
  Advanced next_;          ///< after a tick under it
  std::vector<Foe> foes_;  ///< those that were looked at closely so far
};

/// An agent on a road that stands although nothing there has to be waited for is stuck between
/// bodies. It counts as wedged for some seconds more, until it has got out.
bool is_wedged(const Scene& scene, std::size_t row);
/// Keeps count of it once a tick.
void update_held(double dt, Scene& scene, std::size_t row);

/// v_new made safe: `velocity` if the guard admits it, or else the nearest of a few slower ones
/// along it that it admits, or null: braking with the wheels as they are. A body that is held up
/// (asked to stand although it prefers to go) creeps round what is in its way instead, as long as
/// the guard and the hard planes admit that: to the side that its wheels point to already, else to
/// the passing side first. Somebody on foot who has stood for seconds shuffles some way or other,
/// back as well, drawn anew every second from id and time alone: this opens crowds in which
/// everybody waits for everybody.
Vec2 guarded_velocity(StoppingGuard& guard, const Model& model, const Scene& scene,
                      const TickGeometry& geometry, std::size_t row, const Vec2& velocity,
                      const Vec2& preferred, std::span<const HalfPlane> hard);

}  // namespace sumogamma
