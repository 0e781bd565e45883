#pragma once

#include <cstdint>
#include <vector>

#include "model/model.h"
#include "model/tick_geometry.h"

namespace sumogamma {

/// Scratch of guarded_velocity, kept between calls so that it does not allocate.
struct GuardScratch {
  std::vector<std::uint32_t> near;
};

/// The velocity itself, or the nearest of a few slower ones, with which this body can still stop in
/// time: after one tick under it and braking from then on, its turned outline stays clear of
/// everybody else's if they brake now. As long as everybody keeps to this, braking is a way out for
/// all at once, so that bodies that are apart stay apart (but for two that take the same free
/// ground within one tick). Half-planes can't say this: they know neither the turning of a body nor
/// the way that its brakes need. Bodies that overlap already are left to G's push-out.
Vec2 guarded_velocity(const Model& model, const Scene& scene, const TickGeometry& geometry,
                      std::size_t row, const Vec2& velocity, GuardScratch& scratch);

}  // namespace sumogamma
