#include "app/run_observers.h"

#include <algorithm>

#include "app/sumo_files.h"
#include "app/window_colors.h"
#include "base/hash.h"
#include "io/output_file.h"
#include "io/replay_marks.h"
#include "io/replay_page.h"
#include "io/results.h"
#include "io/traffic_csv.h"
#include "io/trajectories.h"
#include "io/trajectory_tables.h"
#include "prediction/live_predictor.h"

namespace sumogamma {

namespace {

class Collisions final : public RunObserver {
 public:
  explicit Collisions(const WatchedRun& run)
      : RunObserver(run), monitor_(run.sim.dt, &run.sim.model.road) {}
  void add(std::vector<ReplayEvent>& events) override {
    monitor_.add(run_.sim.scene, run_.sim.model.types);
    for (; marked_ < monitor_.pairs().size(); ++marked_)
      events.push_back(mark_of(monitor_.pairs()[marked_], false));
  }
  void add_last(std::vector<ReplayEvent>& events) override {
    for (const CollisionPair& pair : monitor_.pairs()) events.push_back(mark_of(pair, true));
  }
  void fill(RunResults& results) const override { results.collisions = monitor_.result(); }
  void close() override {
    write_file(run_.plan.options.output / "collisions.csv",
               collisions_csv(monitor_.pairs(), run_.sim.model.types,
                              [&](AgentId id) { return run_.name_of(id); }));
  }

 private:
  CollisionMonitor monitor_;
  std::size_t marked_ = 0;
};

class Conflicts final : public RunObserver {
 public:
  explicit Conflicts(const WatchedRun& run)
      : RunObserver(run), monitor_(run.sim.dt, &run.sim.model.road) {}
  void add(std::vector<ReplayEvent>& events) override {
    monitor_.add(run_.sim.scene, run_.sim.model.types);
    for (; marked_ < monitor_.over().size(); ++marked_)
      events.push_back(mark_of(monitor_.over()[marked_]));
  }
  void add_last(std::vector<ReplayEvent>& events) override {
    // those that aren't over yet, by their measures so far
    const double now = run_.sim.scene.time;
    for (const Conflict& conflict : monitor_.conflicts())
      if (now - conflict.until <= ConflictMonitor::kOver) events.push_back(mark_of(conflict));
  }
  void fill(RunResults& results) const override {
    results.safety = monitor_.result(run_.sim.model.types);
  }
  void close() override {
    write_file(run_.plan.options.output / "conflicts.csv",
               conflicts_csv(monitor_.conflicts(), run_.sim.model.types,
                             [&](AgentId id) { return run_.name_of(id); }));
  }

 private:
  ConflictMonitor monitor_;
  std::size_t marked_ = 0;
};

class Rules final : public RunObserver {
 public:
  explicit Rules(const WatchedRun& run)
      : RunObserver(run),
        monitor_(run.sim.dt, run.sim.model.road, run.locator, run.sim.traffic.code) {}
  void add(std::vector<ReplayEvent>& events) override {
    monitor_.add(run_.sim.scene, run_.sim.model.types, run_.sim.road, *run_.sim.workers);
    for (; marked_ < monitor_.offences().size(); ++marked_)
      events.push_back(mark_of(monitor_.offences()[marked_], false));
  }
  void add_last(std::vector<ReplayEvent>& events) override {
    for (const OffenceSpan& offence : monitor_.offences())
      if (offence.kind != Offence::RedLight) events.push_back(mark_of(offence, true));
  }
  void fill(RunResults& results) const override {
    results.rules = monitor_.result(run_.sim.model.types);
  }
  void close() override {
    write_file(run_.plan.options.output / "offences.csv",
               offences_csv(monitor_.offences(), run_.sim.model.types,
                            [&](AgentId id) { return run_.name_of(id); }));
  }

 private:
  RuleMonitor monitor_;
  std::size_t marked_ = 0;
};

class Flow final : public RunObserver {
 public:
  explicit Flow(const WatchedRun& run)
      : RunObserver(run), monitor_(run.sim.dt, run.sim.model.road) {}
  void add(std::vector<ReplayEvent>& events) override {
    monitor_.add(run_.sim.scene, run_.sim.model.types, run_.sim.road, run_.sim.traffic.waits);
    const AgentName name_of = [&](AgentId id) { return run_.name_of(id); };
    for (; marked_ < monitor_.stuck().size(); ++marked_)
      events.push_back(mark_of(monitor_.stuck()[marked_], run_.sim.scene.time, name_of));
  }
  void fill(RunResults& results) const override {
    results.flow = monitor_.result(run_.sim.model.types);
  }
  void close() override {
    write("stuck.csv", monitor_.stuck());
    write("held.csv", monitor_.held());
  }

 private:
  void write(const char* file, const std::vector<StuckAgent>& stays) const {
    write_file(run_.plan.options.output / file,
               stuck_csv(stays, run_.sim.model.types, run_.sim.model.road,
                         [&](AgentId id) { return run_.name_of(id); }));
  }

  FlowMonitor monitor_;
  std::size_t marked_ = 0;
};

class Traffic final : public RunObserver {
 public:
  explicit Traffic(const WatchedRun& run)
      : RunObserver(run), monitor_(run.sim.dt, run.sim.model.road, run.plan.options.interval) {}
  void add(std::vector<ReplayEvent>&) override {
    monitor_.add(run_.sim.scene, run_.sim.model.types);
  }
  void fill(RunResults& results) const override {
    results.traffic = monitor_.result(run_.sim.model.types);
  }
  void close() override {
    const std::filesystem::path& output = run_.plan.options.output;
    const AgentTypeTable& types = run_.sim.model.types;
    write_file(output / "lanes.csv", lanes_csv(monitor_.lanes(), run_.sim.model.road, types));
    write_file(output / "traffic.csv", traffic_csv(monitor_.types(), types));
    write_file(output / "journeys.csv", journeys_csv(monitor_.journeys(), types,
                                                     [&](AgentId id) { return run_.name_of(id); }));
  }

 private:
  TrafficMonitor monitor_;
};

class Smoothness final : public RunObserver {
 public:
  explicit Smoothness(const WatchedRun& run) : RunObserver(run), monitor_(run.sim.dt) {}
  void add(std::vector<ReplayEvent>&) override {
    monitor_.add(run_.sim.scene, run_.sim.model.types);
  }
  void fill(RunResults& results) const override {
    results.smoothness = monitor_.result(run_.sim.model.types);
  }

 private:
  SmoothnessMonitor monitor_;
};

class Trajectories final : public RunObserver {
 public:
  explicit Trajectories(const WatchedRun& run)
      : RunObserver(run),
        writer_(run.plan.options.trajectory_period, run.sim.dt, run.sim.model.road, &run.locator) {
    const RunOptions& options = run.plan.options;
    const std::vector<std::string> columns =
        options.trajectory_columns.empty() ? trajectory_columns() : options.trajectory_columns;
    std::vector<std::unique_ptr<TrajectorySink>> sinks;
    if (asked_for("fcd"))
      sinks.push_back(std::make_unique<FcdSink>(options.output / "trajectories.fcd.xml.gz"));
    if (asked_for("csv")) sinks.push_back(make_csv_tables(options.output, columns));
    if (asked_for("parquet")) sinks.push_back(make_parquet_tables(options.output, columns));
    writer_.add_sink(make_threaded(std::move(sinks)));
  }
  static bool is_wanted(const RunOptions& options) {
    return options.trajectories != std::vector<std::string>{"none"};
  }
  void add(std::vector<ReplayEvent>&) override {
    writer_.add(run_.sim.scene, run_.sim.model.types, [&](AgentId id) { return run_.name_of(id); });
  }
  void close() override { writer_.close(); }

 private:
  bool asked_for(std::string_view format) const {
    const std::vector<std::string>& formats = run_.plan.options.trajectories;
    return std::find(formats.begin(), formats.end(), format) != formats.end();
  }

  TrajectoryWriter writer_;
};

class Prediction final : public RunObserver {
 public:
  explicit Prediction(const WatchedRun& run)
      : RunObserver(run),
        predictor_(run.sim.model.types, live_predictor_parameters(), &run.sim.model.road) {}
  static bool is_wanted(const RunOptions& options) { return options.predict; }
  void add(std::vector<ReplayEvent>&) override {
    predictor_.observe(run_.sim.scene, &run_.sim.model.types);
  }
  void fill(RunResults& results) const override {
    results.prediction = {true, predictor_.score(), predictor_.scores()};
  }

 private:
  LivePredictor predictor_;
};

ReplayStep step_of(const WatchedRun& run, const AgentName& name_of) {
  return {run.sim.scene, name_of, &run.sim.road, &run.sim.model.types, run.sim.work.bindings};
}

class Replay final : public RunObserver {
 public:
  explicit Replay(const WatchedRun& run)
      : RunObserver(run),
        recorder_(run.plan.options.output / "replay.bin", run.plan.input.name, run.sim.model.road,
                  run.sim.model.types, run.plan.options.replay_period) {}
  static bool is_wanted(const RunOptions& options) { return options.replay; }
  void add(std::vector<ReplayEvent>& events) override {
    recorder_.add(step_of(run_, name_of_));
    add_last(events);
  }
  void look(Inspector& inspector) override {
    if (recorder_.is_at(run_.sim.scene.time)) recorder_.add_spaces(inspector.spaces());
  }
  void add_last(std::vector<ReplayEvent>& events) override {
    for (const ReplayEvent& event : events) recorder_.add_event(event);
  }
  void close() override {
    recorder_.close();
    const std::filesystem::path& output = run_.plan.options.output;
    write_replay_page(output / "replay.html", output / "replay.bin");
  }

 private:
  AgentName name_of_ = [this](AgentId id) { return run_.name_of(id); };
  ReplayRecorder recorder_;
};

/// The same records for who looks on.
class Live final : public RunObserver {
 public:
  explicit Live(const WatchedRun& run) : RunObserver(run), steps_(run.plan.options.replay_period) {
    run.page->begin(replay_header(run.plan.input.name, run.sim.model.road, run.sim.model.types));
  }
  static bool is_wanted(const RunPlan& plan) { return plan.options.serve.has_value(); }
  void add(std::vector<ReplayEvent>& events) override {
    add_last(events);
    // nobody looks: nothing is made, and who comes first gets a beginning
    if (!run_.page->has_viewers()) {
      stretch_ends_ = -1.0;
      return;
    }
    const double time = run_.sim.scene.time;
    const bool fresh = time >= stretch_ends_ || stretch_ends_ < 0.0;
    if (fresh) {
      steps_.begin_again();
      stretch_ends_ = time + kStretch;
    }
    steps_.add_step(step_of(run_, name_of_));
    run_.page->publish(steps_.take(), fresh);
  }
  void look(Inspector& inspector) override {
    if (!run_.page->has_viewers() || !steps_.is_at(run_.sim.scene.time)) return;
    steps_.add_spaces(inspector.spaces());
    run_.page->publish(steps_.take(), false);
  }
  void add_last(std::vector<ReplayEvent>& events) override {
    for (const ReplayEvent& event : events) marks_.add_event(event);
    run_.page->publish_marks(marks_.take());
  }

 private:
  static constexpr double kStretch = 10.0;  ///< that can be read by itself [s]
  AgentName name_of_ = [this](AgentId id) { return run_.name_of(id); };
  ReplayEncoder steps_, marks_;
  double stretch_ends_ = -1.0;  ///< [s]
};

/// SUMO's window, painted by what binds whom.
class Window final : public RunObserver {
 public:
  explicit Window(const WatchedRun& run)
      : RunObserver(run), colors_(run.sim, run.world, run.backend) {}
  static bool is_wanted(const RunOptions& options) { return options.gui; }
  void add(std::vector<ReplayEvent>&) override { colors_.note(); }
  void look(Inspector&) override { colors_.paint(); }

 private:
  WindowColors colors_;
};

/// Who came, went and was driven by us; the bits of everybody's state.
class Agents final : public RunObserver {
 public:
  using RunObserver::RunObserver;
  void add(std::vector<ReplayEvent>&) override {
    const Scene& scene = run_.sim.scene;
    hash_ = hash_state(scene, hash_);
    driven_ = static_cast<std::uint64_t>(
        std::count_if(scene.control.begin(), scene.control.end(), is_ours));
    driven_sum_ += driven_;
    driven_most_ = std::max(driven_most_, driven_);
    ++ticks_;
  }
  void fill(RunResults& results) const override {
    AgentCounts& agents = results.agents;
    const LifeCycle& life = run_.world.life_cycle();
    results.state_hash = hash_;
    agents.controlled_now = driven_;
    agents.controlled_peak = driven_most_;
    agents.controlled_mean =
        ticks_ > 0 ? static_cast<double>(driven_sum_) / static_cast<double>(ticks_) : 0.0;
    agents.detours = run_.sim.traffic.detours;
    agents.stops_served = static_cast<std::uint64_t>(life.stops_served);
    agents.rides = static_cast<std::uint64_t>(life.rides);
    agents.taken_over = static_cast<std::uint64_t>(life.taken_over);
    agents.handed_back = static_cast<std::uint64_t>(life.handed_back);
    agents.kept_on_foot = static_cast<std::uint64_t>(life.kept_on_foot);
    agents.insertions_delayed = static_cast<std::uint64_t>(life.insertions_delayed);
    for (const auto& [reason, count] : life.removed)
      agents.removed[reason] = static_cast<std::uint64_t>(count);
    for (const auto& [reason, count] : life.left_to_sumo)
      agents.left_to_sumo[reason] = static_cast<std::uint64_t>(count);
    fill_trips(life, agents);
  }
  void close() override {
    write_file(run_.plan.options.output / "trips.csv",
               trips_csv(run_.world.life_cycle().trips, run_.sim.model.types,
                         [&](AgentId id) { return run_.name_of(id); }));
  }

 private:
  void fill_trips(const LifeCycle& life, AgentCounts& agents) const {
    for (const auto& [type, count] : life.by_type) {
      AgentCounts::ByType& counts = agents.by_type[type];
      counts.inserted = static_cast<std::uint64_t>(count.inserted);
      counts.arrived = static_cast<std::uint64_t>(count.arrived);
      agents.inserted += counts.inserted;
      agents.arrived += counts.arrived;
    }
    for (const FinishedTrip& trip : life.trips) {
      const double time = trip.arrived - trip.departed;
      AgentCounts::ByType& counts = agents.by_type[type_of(run_.sim.model.types, trip.type).name];
      counts.mean_travel_time += time / static_cast<double>(counts.arrived);
      agents.mean_travel_time += time / static_cast<double>(agents.arrived);
    }
  }

  std::uint64_t hash_ = kFnvBasis, driven_ = 0, driven_sum_ = 0, driven_most_ = 0, ticks_ = 0;
};

Quantiles quantiles_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.5), at(0.95), values.back()};
}

HandBackResult summary_of(const std::vector<HandBack>& backs) {
  const auto spread = [&](double HandBack::*figure) {
    std::vector<double> values(backs.size());
    std::transform(backs.begin(), backs.end(), values.begin(),
                   [&](const HandBack& back) { return back.*figure; });
    return quantiles_of(std::move(values));
  };
  return {backs.size(), spread(&HandBack::position), spread(&HandBack::heading),
          spread(&HandBack::speed), spread(&HandBack::acceleration)};
}

/// What SUMO made of what was written.
class Coupling final : public RunObserver {
 public:
  explicit Coupling(const WatchedRun& run) : RunObserver(run) {
    run.world.coupling().compare = [this](const Vec2& written, const Vec2& reported) {
      monitor_.add(written, reported);
    };
  }
  ~Coupling() override { run_.world.coupling().compare = nullptr; }
  void add(std::vector<ReplayEvent>&) override {}
  void fill(RunResults& results) const override {
    const CouplingCheck& seen = run_.world.coupling();
    results.coupling = monitor_.result();
    results.hand_back = summary_of(seen.hand_backs);
    results.teleports = static_cast<std::uint64_t>(seen.teleports);
    results.emergency_stops = static_cast<std::uint64_t>(seen.emergency_stops);
  }

 private:
  CouplingMonitor monitor_;
};

using Make = std::unique_ptr<RunObserver> (*)(const WatchedRun&);

/// Null where an output wasn't asked for.
template <typename Observer>
std::unique_ptr<RunObserver> make(const WatchedRun& run) {
  if constexpr (requires { Observer::is_wanted(run.plan.options); })
    if (!Observer::is_wanted(run.plan.options)) return nullptr;
  if constexpr (requires { Observer::is_wanted(run.plan); })
    if (!Observer::is_wanted(run.plan)) return nullptr;
  return std::make_unique<Observer>(run);
}

/// All there are. The replay comes behind those whose events it marks.
constexpr Make kObservers[] = {
    make<Agents>, make<Coupling>, make<Collisions>, make<Conflicts>,  make<Rules>,
    make<Flow>,   make<Traffic>,  make<Smoothness>, make<Prediction>, make<Trajectories>,
    make<Replay>, make<Live>,     make<Window>,     make<SumoFiles>};

}  // namespace

RunObservers::RunObservers(const RunPlan& plan, const Simulation& sim, SumoWorld& world,
                           SumoBackend& backend, LivePage* page)
    : run_{plan, sim, world, world.locator(), backend, page}, inspector_(plan, sim, world) {
  for (const Make maker : kObservers)
    if (auto observer = maker(run_)) list_.push_back(std::move(observer));
}

void RunObservers::add() {
  events_.clear();
  for (const auto& observer : list_) observer->add(events_);
}

void RunObservers::look() {
  for (const auto& observer : list_) observer->look(inspector_);
}

void RunObservers::fill(RunResults& results) const {
  for (const auto& observer : list_) observer->fill(results);
}

void RunObservers::close() {
  events_.clear();
  for (const auto& observer : list_) observer->add_last(events_);
  inspector_.close();
  for (const auto& observer : list_) observer->close();
}

}  // namespace sumogamma
