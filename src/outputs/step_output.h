#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>

#include "outputs/lane_passages.h"
#include "sumo/sumo_outputs.h"

namespace sumogamma {

/// One step of SUMO's as outputs see it.
struct OutputStep {
  double begin = 0, end = 0;  ///< [s]
  std::span<const OutputVehicle> vehicles;
  const LanePassages& motion;

  std::span<const LanePassage> passages() const { return motion.passages(); }
  std::span<const LanePassage> passages_on(LaneId lane) const { return motion.passages_on(lane); }
  const OutputVehicle& vehicle(const LanePassage& passage) const {
    return vehicles[passage.vehicle];
  }
};

/// An output that is made from steps, in order.
class StepOutput {
 public:
  StepOutput() = default;
  virtual ~StepOutput() = default;
  StepOutput(const StepOutput&) = delete;
  StepOutput& operator=(const StepOutput&) = delete;

  virtual void add(const OutputStep& step) = 0;
  /// Writes the interval that is open at the run's end [s], as SUMO does.
  virtual void finish(double time) = 0;
};

/// The intervals in which SUMO sums up.
class OutputIntervals {
 public:
  /// `period` [s], not positive for a single one over the whole run; `begin`: of the first one,
  /// maybe after the run's or, off the period's raster, before it.
  OutputIntervals(double period, double begin, double run_begin);
  /// Is an interval over at this time, or at the run's `end`?
  bool is_over(double time, bool end) const;
  double begin() const { return last_; }
  void next(double time) { last_ = time; }

 private:
  double period_, last_;  ///< [s]
};

/// Which vTypes an output counts: SUMO's attribute vTypes.
class TypeFilter {
 public:
  explicit TypeFilter(std::string_view types);
  bool counts(const OutputVehicle& vehicle) const {
    return types_.empty() || types_.contains(vehicle.type);
  }

 private:
  std::set<std::string, std::less<>> types_;
};

/// A number in an attribute. Throws Error naming element and source where it is none.
double number_of(const AskedOutput& output, const XmlAttributes& attributes, std::string_view name,
                 double otherwise);
/// Likewise a time [s], seconds or h:m:s; of the first of these names that is there.
double time_of(const AskedOutput& output, std::initializer_list<std::string_view> names,
               double otherwise);
/// The lane that an attribute names. Throws Error where the network has none of that name.
LaneId lane_of(const RoadNetwork& network, const AskedOutput& output,
               const XmlAttributes& attributes, std::string_view name);
/// A place on a lane: a negative one counts from the lane's end, one beyond it is the end [m].
double place_on(const Lane& lane, double place);

}  // namespace sumogamma
