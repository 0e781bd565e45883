#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "outputs/fcd_places.h"
#include "outputs/lane_passages.h"
#include "outputs/step_output.h"
#include "outputs/sumo_file.h"
#include "outputs/trip_figures.h"
#include "sumo/sumo_outputs.h"

namespace sumogamma {

/// What a run is asked to write in SUMO's place.
struct OutputRequest {
  std::vector<AskedOutput> asked;
  std::vector<std::filesystem::path> folders;  ///< in which SUMO writes
  OutputNames names;
  std::filesystem::path helper_tripinfo;  ///< where SUMO writes trips for statistics alone; may be
                                          ///< empty
  double begin = 0, step = 0;             ///< [s]
  int precision = 2;
};

/// Somebody at the end of a step.
struct SeenAgent {
  std::string name;  ///< SUMO's id
  bool is_person = false;
  bool driven = false;  ///< by GAMMA
  VehiclePlace place;   ///< its `vehicle` is filled by RunOutputs
};

/// One step of SUMO's, [begin, begin + step).
struct SeenStep {
  double begin = 0;  ///< [s]
  std::vector<SeenAgent> agents;
  std::vector<std::string> unseen;  ///< vehicles on the road of whom this step tells nothing
  std::vector<std::pair<std::string, bool>> waiting;  ///< off the map for room; is it a person
  std::int64_t waiting_vehicles = 0, riding = 0;
  bool is_last = false;  ///< who is missing hasn't left
};

/// Makes SUMO's outputs from where everybody is, whoever drives; what SUMO alone knows is taken
/// from its own files.
class RunOutputs {
 public:
  /// The network outlives it. Throws Error naming file or element for what can't be meant or
  /// written.
  RunOutputs(const RoadNetwork& network, OutputRequest request);
  ~RunOutputs();

  /// Must be known before it is seen.
  void add_vehicle(OutputVehicle vehicle, bool bicycle, double waited);
  bool knows(const std::string& name) const { return index_.contains(name); }
  /// Has arrived; to be told before the step that doesn't show it any more.
  void note_arrival(std::string_view name);
  /// Lane on which a vehicle was last; kNoLane where it hasn't been on any.
  LaneId last_lane(std::string_view name) const;
  void add(SeenStep& step);

  /// Completes all files, once SUMO has ended its own, and gives them their names. `time`: the
  /// run's end [s]. Throws Error naming the file.
  void finish(double time);

 private:
  std::shared_ptr<SumoFile> file_for(const AskedOutput& output);
  void add_detector(const AskedOutput& output);
  void move_vehicles(SeenStep& step);
  void end_missing(bool is_last);
  void note_trips(const SeenStep& step);
  void sum_up(const SeenStep& step);
  void keep_places(const SeenStep& step);
  void take_figures();
  void write_own();

  const RoadNetwork& network_;
  OutputRequest request_;
  LanePassages motion_;
  std::vector<OutputVehicle> vehicles_;
  std::unordered_map<std::string, std::uint32_t> index_;
  std::vector<bool> on_road_, seen_, arrived_;  ///< by vehicle
  std::vector<TripFigures*> figures_;           ///< by vehicle, of trips_
  Trips trips_;
  SummaryByTime summary_;
  double waited_ = 0, waited_arrived_ = 0;
  std::map<std::filesystem::path, std::shared_ptr<SumoFile>> files_;
  std::vector<std::unique_ptr<StepOutput>> outputs_;
  std::optional<FcdPlaces> fcd_;
  bool walked_ = false;  ///< GAMMA has moved people
  bool finished_ = false;
};

}  // namespace sumogamma
