#include <gtest/gtest.h>

#include "base/error.h"
#include "prediction/methods.h"

namespace sumogamma {
namespace {

/// Six walkers who sway; `odd` moves all they did outside the frames [13, 20].
TrackSet swaying(const Vec2& odd) {
  TrackSet set;
  set.name = "made";
  set.last_frame = 39;
  for (std::uint32_t id = 0; id < 6; ++id) {
    Track track{id, {}, 0, {}, {}};
    for (int k = 0; k < 40; ++k) {
      Vec2 position(0.45 * k + 0.1 * id, 1.5 * id + 0.05 * ((k * (2 + static_cast<int>(id))) % 5));
      if (k < 13 || k > 20) position += (k % 3) * odd;
      track.position.push_back(position);
      track.heading.push_back(0);
    }
    set.tracks.push_back(track);
  }
  return set;
}

std::vector<Vec2> predicted_at(const TrackSet& set, const std::string& name, Memory memory,
                               int frame) {
  MethodSettings settings{default_predictor_parameters(), 4, 1};
  std::vector<Vec2> all;
  evaluate(make_method(name, settings, set), set, set, protocol_from_letter("C"), memory,
           [&](const ScoredForecast& told) {
             if (told.frame == frame)
               all.insert(all.end(), told.predicted.begin(), told.predicted.end());
           });
  return all;
}

/// Strict: neither what was before a window nor what comes after it moves a bit, samples included.
TEST(Memory, StrictKnowsTheWindowAlone) {
  const TrackSet one = swaying({0, 0}), other = swaying({0.7, -0.4});
  for (const std::string name : {"gamma", "kalman", "cv+flow", "mean"}) {
    SCOPED_TRACE(name);
    const std::vector<Vec2> a = predicted_at(one, name, Memory::Strict, 20);
    const std::vector<Vec2> b = predicted_at(other, name, Memory::Strict, 20);
    ASSERT_GE(a.size(), 6u * 12u);
    EXPECT_EQ(a, b);
  }
  // online learns from what was before
  EXPECT_NE(predicted_at(one, "gamma", Memory::Online, 20),
            predicted_at(other, "gamma", Memory::Online, 20));
  EXPECT_NE(predicted_at(one, "cv+flow", Memory::Online, 20),
            predicted_at(other, "cv+flow", Memory::Online, 20));
}

TEST(Memory, HasTwoNames) {
  EXPECT_EQ(memory_from_name("strict"), Memory::Strict);
  EXPECT_EQ(memory_from_name("online"), Memory::Online);
  EXPECT_THROW(memory_from_name("both"), Error);
}

}  // namespace
}  // namespace sumogamma
