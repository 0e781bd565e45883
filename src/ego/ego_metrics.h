#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ego/ego_record.h"

namespace sumogamma {

/// How the ego moves at one time: differences over a tenth of a second.
struct Motion {
  double along = 0, across = 0;     ///< acceleration in body axes [m/s^2]
  double yaw_rate = 0;              ///< [rad/s]
  double yaw_acceleration = 0;      ///< [rad/s^2]
  double jerk_along = 0, jerk = 0;  ///< [m/s^3]
};

/// From samples `step` [s] apart; empty where there are fewer than four tenths of a second.
std::vector<Motion> motions_of(std::span<const EgoSample> samples, double step);

/// Figures of an episode beside its end.
struct EgoMetrics {
  double time = 0;               ///< from the begin to the end [s]
  double driven = 0;             ///< [m]
  double progress = 0;           ///< along the way [m]
  double mean_speed = 0;         ///< [m/s]
  double least_gap = 0;          ///< to the nearest body; infinite: nobody was near [m]
  double speed_change = 0;       ///< sum of |dv| over what was driven, which counts as 0.1 m at the
                                 ///< least [m/s a m]
  double acceleration = 0;       ///< mean of its amount along the heading [m/s^2]
  double jerk = 0;               ///< likewise [m/s^3]
  double braking_share = 0;      ///< of the periods in which the speed fell by more than 0.2 m/s
  double braking_of_others = 0;  ///< seconds in which others braked hard for it, summed over them
  double delay_of_others = 0;    ///< [s]
};

/// `period`: of the plans [s].
EgoMetrics metrics_of(std::span<const EgoSample> samples, double step, double period);

}  // namespace sumogamma
