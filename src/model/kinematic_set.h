#pragma once

#include <array>
#include <vector>

#include "base/parallel.h"
#include "model/constraints.h"
#include "scene/agent_type.h"
#include "scene/scene.h"

namespace sumogamma {

struct Model;

/// K at one state, in axes whose x points along the heading (wheeled) or the motion (on foot):
/// every v in K has normal_k . v <= support_k. The null velocity is always inside.
struct KinematicSet {
  static constexpr std::size_t kCapacity = 8;
  std::array<double, kCapacity> support{};  ///< [m/s] along the table's normals
  Vec2 left = Vec2(1, 0),
       right = Vec2(1, 0);  ///< directions of the wedge's sides: the largest trackable deviations
};

/// K of Eqs. 1-2 for one type, over current speed and steering angle, between whose nodes it is
/// interpolated.
class KinematicTable {
 public:
  KinematicTable() = default;

  /// False before build_kinematic_tables.
  bool is_built() const { return !nodes_.empty(); }
  /// K at a state: bilinear in speed [m/s] and steering [rad], clamped to the table's range.
  KinematicSet at(double speed, double steering) const;
  /// Unit normals of the front faces, in the set's axes.
  const std::vector<Vec2>& normals() const { return normals_; }
  /// True where the set is a wedge with its apex at the null velocity (wheels); false: all
  /// directions (on foot).
  bool has_sides() const { return has_sides_; }

  /// True where no plane can ever bind: everything within the top speed is trackable from every
  /// state.
  bool is_everything() const { return is_everything_; }

  const std::vector<double>& speeds() const { return speeds_; }
  const std::vector<double>& steerings() const { return steerings_; }
  const KinematicSet& node(std::size_t speed, std::size_t steering) const {
    return nodes_[speed * steerings_.size() + steering];
  }

 private:
  friend std::vector<KinematicTable> build_kinematic_tables(const AgentTypeTable&, Workers&);
  std::vector<Vec2> normals_;
  std::vector<double> speeds_, steerings_;
  std::vector<KinematicSet> nodes_;  ///< [speeds x steerings]
  bool has_sides_ = false;
  bool is_everything_ = false;
};

/// Greatest tracking error of Eq. 1 [m] of a body of this type in the given state that is asked for
/// `velocity` (in body axes, x forward) over [0, horizon]; stops early once it exceeds the type's
/// limit.
double tracking_error(const AgentType& type, double speed, double steering, const Vec2& velocity,
                      double horizon);

/// K of every type: the low-level controller is simulated over the type's horizon for a grid of
/// speeds and deviation angles from each state, the largest speed within the tracking error is kept
/// for each angle (Eq. 1), and the hull of these with the null velocity (Eq. 2) is stored. Same
/// result for any number of workers.
std::vector<KinematicTable> build_kinematic_tables(const AgentTypeTable& types, Workers& workers);

/// Appends K of a row as hard planes; `forward` is its unit heading. Every plane admits the null
/// velocity. Planes that the speed limit implies are left out.
void append_kinematic_constraints(const Model& model, const Scene& scene, std::size_t row,
                                  const Vec2& forward, ConstraintSet& constraints);

}  // namespace sumogamma
