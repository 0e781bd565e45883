#pragma once

#include <map>
#include <memory>
#include <vector>

#include "outputs/step_output.h"
#include "outputs/sumo_file.h"

namespace sumogamma {

/// SUMO's e1Detector: counts, speeds and occupancy at a place of a lane, by interval
/// (MSInductLoop).
class InductionLoop final : public StepOutput {
 public:
  /// The network outlives it. Throws Error naming the element for what can't be meant.
  InductionLoop(const RoadNetwork& network, const AskedOutput& output,
                std::shared_ptr<SumoFile> file, double run_begin, double step);
  void add(const OutputStep& step) override;
  void finish(double time) override;

 private:
  struct Passed {
    double entered, left;  ///< [s]
    double length;         ///< [m]
    bool left_early;       ///< by changing lanes or ending upon it
  };
  void pass(const LanePassage& passage, const OutputVehicle& vehicle);
  void leave(const LanePassage& passage, const OutputVehicle& vehicle, double time, bool early);
  void write(double time);

  std::shared_ptr<SumoFile> file_;
  std::string id_;
  LaneId lane_;
  double place_, end_, step_;  ///< [m], [m], [s]
  TypeFilter types_;
  OutputIntervals intervals_;
  std::map<std::uint32_t, double> upon_;  ///< vehicle, since when [s]
  std::vector<Passed> passed_;            ///< in this interval
  std::int64_t entered_ = 0;
};

/// SUMO's instantInductionLoop: each vehicle's coming, staying and going (MSInstantInductLoop).
class InstantLoop final : public StepOutput {
 public:
  /// As InductionLoop's.
  InstantLoop(const RoadNetwork& network, const AskedOutput& output, std::shared_ptr<SumoFile> file,
              double step);
  void add(const OutputStep& step) override;
  void finish(double) override {}

 private:
  void pass(const LanePassage& passage, const OutputVehicle& vehicle);
  void write(const char* state, double time, double speed, const OutputVehicle& vehicle,
             const char* further = nullptr, double value = 0);

  std::shared_ptr<SumoFile> file_;
  std::string id_;
  LaneId lane_;
  double place_, step_;  ///< [m], [s]
  TypeFilter types_;
  std::map<std::uint32_t, double> upon_;  ///< vehicle, since when [s]
  double last_left_ = -1;                 ///< [s]; negative: nobody has
};

}  // namespace sumogamma
