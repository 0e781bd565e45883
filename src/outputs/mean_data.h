#pragma once

#include <memory>
#include <vector>

#include "outputs/step_output.h"
#include "outputs/sumo_file.h"

namespace sumogamma {

/// What SUMO calls mean data, of one lane and interval (MSMeanData_Net).
struct LaneSums {
  double sampled = 0;      ///< time of vehicles on the lane, their tails included [s]
  double travelled = 0;    ///< by these [m]
  double front_time = 0;   ///< time of fronts on the lane [s]
  double front_way = 0;    ///< by these [m]
  double length_time = 0;  ///< vehicles' lengths by their time [m s]
  double occupied = 0;     ///< lengths on the lane by their time [m s]
  double waiting = 0;      ///< [s]
  double time_loss = 0;    ///< [s]
  double shortest = 0;     ///< vehicle, its gap included [m]; 0: none came
  std::int64_t departed = 0, arrived = 0, entered = 0, left = 0, changed_from = 0, changed_to = 0;

  bool is_empty() const;
  LaneSums& operator+=(const LaneSums& other);
};

/// SUMO's edgeData, laneData, edgedata-output and lanedata-output of type traffic.
class MeanData final : public StepOutput {
 public:
  /// `output`: what asks for it. The network outlives it, `file` may be shared. Throws Error naming
  /// the element for what can't be meant.
  MeanData(const RoadNetwork& network, const AskedOutput& output, std::shared_ptr<SumoFile> file,
           double run_begin, double step);
  void add(const OutputStep& step) override;
  void finish(double time) override;

 private:
  void count(const LanePassage& passage, const OutputVehicle& vehicle, LaneSums& sums) const;
  void write(double time);
  void write_edge(const Edge& edge, double period);
  void write_sums(const LaneSums& sums, const Lane& lane, double lanes, double period);
  void write_flow(const LaneSums& sums, const Lane& lane, double lanes, double period);
  void write_counts(const LaneSums& sums);
  void number(std::string_view name, double value);
  void count(std::string_view name, std::int64_t value);

  const RoadNetwork& network_;
  std::shared_ptr<SumoFile> file_;
  std::string id_;
  bool by_lane_ = false, with_empty_ = true, with_defaults_ = false;
  double least_samples_ = 0, longest_travel_time_ = 0, halting_speed_ = 0;
  double begin_ = 0, end_ = 0, step_ = 0;  ///< [s]
  TypeFilter types_;
  std::set<std::string, std::less<>> attributes_;  ///< that are written; empty: all
  OutputIntervals intervals_;
  std::vector<EdgeId> edges_;
  std::vector<bool> counted_;   ///< by EdgeId
  std::vector<LaneSums> sums_;  ///< by LaneId
};

}  // namespace sumogamma
