#pragma once

#include "traffic/perception.h"

namespace sumogamma {

/// Where beside its path somebody on foot should be [m, positive left]: among the places that its
/// way has room for, the one where the most speed can be hoped for, less a little for every step
/// aside and away from where it likes to be. So who walks behind somebody slow passes, and who
/// meets others follows those who walk its own way: opposite streams part into lanes. Where a
/// vehicle stands in the way the place is beside it, after some seconds off the way where it shuts
/// that. Takes those who are left to avoidance out of `around`.
double walking_place(const TrafficView& view, const Path& path, Surroundings& around,
                     std::size_t row);

/// Room beyond the sides of its way that somebody on foot needs to be at a place [m], a bit
/// beyond the place; 0 on its way. See TrafficState::overtaking_room.
double room_off_the_way(const TrafficParameters& parameters, const Path& path,
                        const Surroundings& around, double place);

}  // namespace sumogamma
