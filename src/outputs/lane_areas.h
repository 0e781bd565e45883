#pragma once

#include <map>
#include <memory>
#include <set>
#include <vector>

#include "outputs/step_output.h"
#include "outputs/sumo_file.h"

namespace sumogamma {

/// SUMO's laneAreaDetector: who is on a stretch of one lane or of several in a row, and how long
/// queues are there (MSE2Collector).
class LaneArea final : public StepOutput {
 public:
  /// The network outlives it. Throws Error naming the element for what can't be meant.
  LaneArea(const RoadNetwork& network, const AskedOutput& output, std::shared_ptr<SumoFile> file,
           double run_begin, double step);
  void add(const OutputStep& step) override;
  void finish(double time) override;

 private:
  /// A vehicle in one step.
  struct Seen {
    std::uint32_t vehicle;
    double to_end;  ///< of its front to the detector's end [m]
    double length;  ///< of it on the detector [m]
    double speed;   ///< [m/s]
  };
  struct Piece {
    LaneId lane;
    double offset;  ///< of the lane's begin from the detector's [m]
  };
  struct Halt {
    double whole = 0, in_interval = 0;  ///< [s]
  };

  void set_pieces(const RoadNetwork& network, const AskedOutput& output);
  void append_links(const RoadNetwork& network, const AskedOutput& output, LaneId to,
                    double& offset);
  void see(const LanePassage& passage, double offset, const OutputVehicle& vehicle);
  bool is_jammed(const Seen& seen, std::map<std::uint32_t, Halt>& halts);
  void add_jams();
  void write(double time);
  void write_halts();

  std::shared_ptr<SumoFile> file_;
  std::string id_;
  std::vector<Piece> pieces_;
  double length_ = 0;                           ///< [m]
  double halting_speed_, halting_time_, step_;  ///< [m/s], [s], [s]
  TypeFilter types_;
  OutputIntervals intervals_;

  std::set<std::uint32_t> inside_;         ///< vehicles
  std::vector<Seen> seen_;                 ///< in this step
  std::map<std::uint32_t, Halt> halting_;  ///< who halts now
  std::vector<Halt> halts_over_;

  // of the interval
  double samples_ = 0, speed_sum_ = 0, time_loss_ = 0, occupancy_sum_ = 0, occupancy_most_ = 0;
  double jam_sum_ = 0, jam_mean_ = 0, jam_most_ = 0;  ///< [m]
  std::int64_t jam_vehicles_sum_ = 0, jam_vehicles_mean_ = 0, jam_vehicles_most_ = 0;
  std::int64_t entered_ = 0, left_ = 0, seen_number_ = 0, steps_ = 0, halts_begun_ = 0;
  std::int64_t vehicles_sum_ = 0, vehicles_most_ = 0;
};

}  // namespace sumogamma
