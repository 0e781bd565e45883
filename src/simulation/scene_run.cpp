#include "simulation/scene_run.h"

#include <algorithm>
#include <chrono>
#include <vector>

#include "base/cpu_time.h"
#include "geometry/rotation.h"
#include "model/gamma_velocity.h"
#include "model/stopping_guard.h"
#include "simulation/overlap.h"

namespace sumogamma {

namespace {

constexpr double kStuckSpeed = 0.2, kStuckTime = 5.0;  // [m/s], [s]
constexpr double kArrived = 2.0;                       // [m]
constexpr double kViolated = 0.01;                     // [m/s]
constexpr double kHardViolated = 1e-6;                 // [m/s]
constexpr double kDeep = 0.1;                          // [m]

/// Counts that every worker keeps for itself; sums of integers, so the order of adding doesn't
/// matter.
struct Counts {
  std::int64_t wheeled_steps = 0, infeasible = 0, reversals = 0, outside_kinematics = 0,
               hard_violations = 0;
  std::int64_t neighbours = 0, half_planes = 0;

  void add(const Counts& other) {
    wheeled_steps += other.wheeled_steps;
    infeasible += other.infeasible;
    reversals += other.reversals;
    outside_kinematics += other.outside_kinematics;
    hard_violations += other.hard_violations;
    neighbours += other.neighbours;
    half_planes += other.half_planes;
  }
};

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Judges one request against what was asked of it.
void count_request(const Model& model, const Scene& scene, std::size_t row, const Vec2& velocity,
                   const Workspace& work, double dt, Counts& counts) {
  const AgentType& type = type_of(model.types, scene.type[row]);
  counts.neighbours += static_cast<std::int64_t>(work.neighbours.attended.size());
  counts.half_planes += static_cast<std::int64_t>(work.constraints.planes.size());
  double worst_hard = 0, worst = 0;
  bool outside = false;
  for (std::size_t k = 0; k < work.constraints.planes.size(); ++k) {
    const double violation = -slack(work.constraints.planes[k], velocity);
    worst = std::max(worst, violation);
    if (k >= work.constraints.hard_count) continue;
    worst_hard = std::max(worst_hard, violation);
    outside |=
        work.constraints.sources[k].kind == ConstraintKind::Kinematic && violation > kHardViolated;
  }
  counts.infeasible += worst > kViolated;
  counts.hard_violations += worst_hard > kHardViolated;
  if (type.kinematics == Kinematics::Holonomic) return;
  ++counts.wheeled_steps;
  if (velocity.squaredNorm() < 1e-12) return;
  const Vec2 forward = rotation(scene.heading[row]);
  const double along = forward.dot(velocity), aside = std::abs(cross(forward, velocity));
  counts.reversals += along < 0;
  // the slip of the centre at full lock, and the turn within the step
  const double lock = tangent(type.max_steering) / type.wheelbase;
  const Vec2 widest =
      from_body(rotation(scene.speed[row] * dt * lock), Vec2(1.0, type.rear_axle_to_center * lock));
  counts.outside_kinematics += outside || cross(widest, Vec2(along, aside)) > kHardViolated;
}

void move_rows(const std::vector<BodyState>& commands, double dt, Scene& scene, Workers& workers) {
  workers.for_each_range(scene.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const BodyState& body = commands[row];
      scene.acceleration[row] = (body.velocity - scene.velocity[row]) / dt;
      scene.position[row] = body.position;
      scene.heading[row] = body.heading;
      scene.velocity[row] = body.velocity;
      scene.speed[row] = body.speed;
      scene.steering[row] = body.steering;
    }
  });
  scene.tick += 1;
  scene.time = static_cast<double>(scene.tick) * dt;
}

/// Who stood still for how long.
struct Standstill {
  std::vector<double> time;
  std::vector<char> stuck;

  explicit Standstill(std::size_t rows) : time(rows, 0.0), stuck(rows, 0) {}

  /// Share of those that want to move at all: a parked agent isn't stuck.
  double share_of_movers(const Scene& scene) const {
    std::size_t movers = 0, held = 0;
    for (std::size_t row = 0; row < scene.size(); ++row) {
      if (scene.preferred_speed[row] < kStuckSpeed) continue;
      ++movers;
      held += stuck[row] != 0;
    }
    return movers > 0 ? static_cast<double>(held) / static_cast<double>(movers) : 0.0;
  }

  void update(const Scene& scene, double dt) {
    for (std::size_t row = 0; row < scene.size(); ++row) {
      const double way = (scene.behavior[row].intention.goal - scene.position[row]).norm();
      const bool held = scene.velocity[row].norm() < kStuckSpeed && way > kArrived;
      time[row] = held ? time[row] + dt : 0.0;
      if (time[row] >= kStuckTime - 0.5 * dt) stuck[row] = 1;
    }
  }
};

double share(double count, double total) { return total > 0 ? count / total : 0.0; }

double mean_progress(const SceneFile& start, const Scene& end, double duration) {
  double sum = 0, counted = 0;
  for (std::size_t row = 0; row < end.size(); ++row) {
    const double way = end.preferred_speed[row] * duration;
    if (way <= 0) continue;
    const Vec2& goal = start.goals[row];
    sum += ((goal - start.scene.position[row]).norm() - (goal - end.position[row]).norm()) / way;
    counted += 1;
  }
  return share(sum, counted);
}

}  // namespace

SceneReport run_scene(const SceneFile& file, const ModelOptions& options, std::size_t steps,
                      double dt, Workers& workers, const SceneObserver& observer) {
  Model model;
  model.types = file.types;
  model.kinematics = build_kinematic_tables(file.types, workers);
  model.options = options;
  model.options.step = dt;
  Scene scene = file.scene;
  const std::size_t rows = scene.size();

  TickGeometry geometry;
  std::vector<Workspace> workspaces(workers.count());
  std::vector<Counts> counts(workers.count());
  std::vector<BodyState> commands(rows);
  OverlapRecord overlaps(rows);
  Standstill standstill(rows);
  SceneReport report;
  report.state_hash = hash_state(scene);
  double cpu = 0, wall = 0;
  if (observer) observer(scene);

  for (std::size_t step = 0; step <= steps; ++step) {
    const double cpu_begin = process_cpu_seconds(), wall_begin = wall_seconds();
    prepare_tick(model, scene, workers, geometry);
    cpu += process_cpu_seconds() - cpu_begin;
    wall += wall_seconds() - wall_begin;
    if (step > 0) overlaps.update(scene, geometry, workers);
    if (step == steps) break;
    const double cpu_model = process_cpu_seconds(), wall_model = wall_seconds();
    workers.for_each_range(rows, [&](std::size_t worker, std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        Workspace& work = workspaces[worker];
        const Vec2 velocity =
            gamma_velocity(model, scene, geometry, row, scene.behavior[row], work);
        commands[row] = next_body(model, scene, row, velocity, dt, work);
        count_request(model, scene, row, velocity, work, dt, counts[worker]);
      }
    });
    cpu += process_cpu_seconds() - cpu_model;
    wall += wall_seconds() - wall_model;
    move_rows(commands, dt, scene, workers);
    for (std::size_t row = 0; row < rows; ++row) update_held(dt, scene, row);
    standstill.update(scene, dt);
    report.state_hash = hash_state(scene, report.state_hash);
    if (observer) observer(scene);
  }

  Counts total;
  for (const Counts& part : counts) total.add(part);
  const double agents = static_cast<double>(rows),
               agent_steps = agents * static_cast<double>(steps);
  const double wheeled = static_cast<double>(total.wheeled_steps);
  report.agents = rows;
  report.steps = steps;
  report.dt = dt;
  report.agents_overlapped_share =
      share(static_cast<double>(overlaps.agents_deeper_than(0)), agents);
  report.deep_agents_share = share(static_cast<double>(overlaps.agents_deeper_than(kDeep)), agents);
  report.pairs_per_agent = share(static_cast<double>(overlaps.pairs()), agents);
  report.overlap_share_of_agent_steps =
      share(static_cast<double>(overlaps.agent_steps()), agent_steps);
  report.progress_mean = mean_progress(file, scene, dt * static_cast<double>(steps));
  report.stuck_share = standstill.share_of_movers(scene);
  report.infeasible_share = share(static_cast<double>(total.infeasible), agent_steps);
  report.reversal_share = share(static_cast<double>(total.reversals), wheeled);
  report.kinematics_violation_share = share(static_cast<double>(total.outside_kinematics), wheeled);
  report.hard_violation_share = share(static_cast<double>(total.hard_violations), agent_steps);
  report.neighbours_mean = share(static_cast<double>(total.neighbours), agent_steps);
  report.half_planes_mean = share(static_cast<double>(total.half_planes), agent_steps);
  report.model_cpu_us_per_agent_step = share(1e6 * cpu, agent_steps);
  report.model_wall_us_per_agent_step = share(1e6 * wall, agent_steps);
  return report;
}

}  // namespace sumogamma
