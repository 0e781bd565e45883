#pragma once

#include "traffic/junction/arbitration.h"

namespace sumogamma {

enum class SignalDuty {
  None,
  Stop,
  GoAtRed,  ///< a red light is a stop sign to this traveller, and everybody else comes first
};

/// What a link's signal asks of a traveller. Red stops always, amber where braking at ease still
/// does it, for a front that would come to rest at `halt`, where the line is drawn at `drawn` [m
/// along its path]. Once past the line, clear the junction.
SignalDuty signal_duty(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                       double halt, double drawn);

}  // namespace sumogamma
