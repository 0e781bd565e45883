#pragma once

#include <cstdint>

namespace sumogamma {

/// What a draw is for. Each purpose has its own stream, so a new one disturbs no other.
enum class Draw : std::uint32_t {
  Responsibility = 1,
  Attention,
  DesiredSpeed,
  Compliance,
  Intention,
  ProcessNoise,
  Demand,
  CriticalGap,
  Headway,
  Jaywalking,
  Yielding,
  MidBlock,
  Control,
  EgoStart,
  Futures,
  Scenario,
  StudyDesign,
  Bootstrap,
  RollingStop,
  Creeping,
};

/// 64 well-mixed bits: a pure function of its arguments (splitmix64 finaliser, applied a word at a
/// time), so results do not depend on the order of calls or on threads.
constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t agent, std::uint64_t tick,
                                    Draw purpose) {
  auto mix = [](std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31);
  };
  return mix(mix(mix(mix(seed) ^ agent) ^ tick) ^ static_cast<std::uint64_t>(purpose));
}

/// Uniform in [0, 1).
constexpr double random_uniform(std::uint64_t seed, std::uint64_t agent, std::uint64_t tick,
                                Draw purpose) {
  return static_cast<double>(random_bits(seed, agent, tick, purpose) >> 11) * 0x1.0p-53;
}

/// Uniform in [low, high).
constexpr double random_uniform(std::uint64_t seed, std::uint64_t agent, std::uint64_t tick,
                                Draw purpose, double low, double high) {
  return low + (high - low) * random_uniform(seed, agent, tick, purpose);
}

/// Approximately standard normal within +-6: Irwin-Hall sum of 12 uniforms. Additions alone, so the
/// same bits with every compiler and C library, unlike Box-Muller's log and cos.
constexpr double random_normal(std::uint64_t seed, std::uint64_t agent, std::uint64_t tick,
                               Draw purpose) {
  double sum = -6.0;
  const std::uint64_t key = random_bits(seed, agent, tick, purpose);
  for (std::uint64_t i = 0; i < 12; ++i) sum += random_uniform(key, i, 0, purpose);
  return sum;
}

}  // namespace sumogamma
