#pragma once

#include <map>
#include <memory>
#include <vector>

#include "outputs/step_output.h"
#include "outputs/sumo_file.h"

namespace sumogamma {

/// SUMO's entryExitDetector: travel times, speeds and halts between places where vehicles come in
/// and such where they go out (MSE3Collector).
class EntryExit final : public StepOutput {
 public:
  /// The network outlives it. Throws Error naming the element for what can't be meant.
  EntryExit(const RoadNetwork& network, const AskedOutput& output, std::shared_ptr<SumoFile> file,
            double run_begin, double step);
  void add(const OutputStep& step) override;
  void finish(double time) override;

 private:
  struct Place {
    LaneId lane;
    double along;  ///< [m]
  };
  struct Within {
    double entered = 0, front_left = 0;      ///< [s]
    double way = 0, way_in_interval = 0;     ///< speeds summed up over time [m]
    double loss_before = 0, loss_noted = 0;  ///< its time loss when it came; at the interval's
                                             ///< begin [s]
    double halts_since = -1;                 ///< negative: it moves [s]
    std::int64_t halts = 0, halts_in_interval = 0;
  };
  struct Left {
    double travel_time, overlap_time, speed, time_loss;
    std::int64_t halts;
  };

  void enter(const Place& entry, const LanePassage& passage, const OutputStep& step);
  void leave(const Place& exit, const LanePassage& passage, const OutputStep& step);
  void go_on(const OutputStep& step);
  void write(double time);
  void write_left();
  void write_within(double time);

  std::shared_ptr<SumoFile> file_;
  std::string id_;
  std::vector<Place> entries_, exits_;
  double halting_speed_, halting_time_, step_;  ///< [m/s], [s], [s]
  TypeFilter types_;
  OutputIntervals intervals_;
  std::map<std::uint32_t, Within> within_;
  std::map<std::uint32_t, double> losses_;  ///< of these now [s]
  std::vector<Left> left_;
};

}  // namespace sumogamma
