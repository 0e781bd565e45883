#pragma once

// The small problems that belief tree searches are measured by, as their literature defines them
// (docs/planning.md, "Problems"), each with its exact belief.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

#include "planning/belief_tree.h"
#include "planning/comb_sampling.h"

namespace sumogamma::testing {

inline constexpr double kDiscount = 0.95;

/// Value of a reward of -1 in each of so many steps.
inline double cost_of(int steps) { return -(1 - std::pow(kDiscount, steps)) / (1 - kDiscount); }

/// Behind one of two doors is a tiger. Listening tells the right one with 0.85.
struct Tiger {
  using State = int;  ///< the tiger's door: 0 left, 1 right
  enum Action { Listen, OpenLeft, OpenRight };
  static constexpr std::array<int, 3> kActions = {Listen, OpenLeft, OpenRight};
  static constexpr double kRight = 0.85;

  StepOutcome step(State& tiger, int action, double draw) const {
    if (action == Listen)
      return {-1, static_cast<std::uint64_t>(draw < kRight ? tiger : 1 - tiger), false};
    const double reward = (action == OpenLeft) == (tiger == 0) ? -100 : 10;
    tiger = draw < 0.5 ? 0 : 1;
    return {reward, draw * 2 - std::floor(draw * 2) < 0.5 ? 0U : 1U, false};
  }
  std::span<const int> actions(const ScenarioGroup<State>&) const { return kActions; }
  int default_action(const ScenarioGroup<State>&) const { return Listen; }
  double value_at_end(const State&) const { return -1 / (1 - kDiscount); }
  double default_value(const State& tiger) const { return value_at_end(tiger); }
  double upper_bound(const State&, int) const { return 10 / (1 - kDiscount); }
};

/// A bridge of ten cells, and no idea where on it one is: only who doesn't lose heart gets over.
struct Bridge {
  using State = int;  ///< cell
  enum Action { Left, Right, Help };
  static constexpr std::array<int, 3> kActions = {Left, Right, Help};
  static constexpr int kLast = 9;

  StepOutcome step(State& cell, int action, double) const {
    if (action == Help) return {-20.0 - cell, 0, true};
    if (action == Right && cell == kLast) return {0, 0, true};
    cell = action == Left ? std::max(cell - 1, 0) : cell + 1;
    return {-1, 0, false};
  }
  std::span<const int> actions(const ScenarioGroup<State>&) const { return kActions; }
  int default_action(const ScenarioGroup<State>&) const { return Help; }
  double value_at_end(const State& cell) const { return -20.0 - cell; }
  double upper_bound(const State& cell, int) const { return cost_of(kLast - cell); }
};

/// Rocks on a grid, good or bad; a sensor that sees worse from afar; the exit is in the east.
class RockSample {
 public:
  struct State {
    std::int16_t x = 0, y = 0;
    std::uint32_t good = 0;  ///< a bit a rock
  };
  enum Action { North, East, South, West, Sample, Check };  ///< Check + i: rock i

  static RockSample of_size(int size) {
    if (size == 4) return {4, {{3, 1}, {2, 1}, {1, 3}, {1, 0}}};
    if (size == 7) return {7, {{2, 0}, {0, 1}, {3, 1}, {6, 3}, {2, 4}, {3, 4}, {5, 5}, {1, 6}}};
    return {
        11,
        {{0, 3}, {0, 7}, {1, 8}, {2, 4}, {3, 3}, {3, 8}, {4, 3}, {5, 8}, {6, 1}, {9, 3}, {9, 9}}};
  }
  RockSample(int size, std::vector<std::array<int, 2>> rocks);

  int rocks() const { return static_cast<int>(rocks_.size()); }
  State start() const { return {0, static_cast<std::int16_t>(size_ / 2), 0}; }
  int rock_at(const State& at) const { return rock_at_[cell(at.x, at.y)]; }  ///< -1: none
  /// That a check of the rock from the cell is right.
  double certainty(const State& at, int rock) const {
    return certainty_[cell(at.x, at.y) * rocks_.size() + static_cast<std::size_t>(rock)];
  }

  StepOutcome step(State& state, int action, double draw) const;
  std::span<const int> actions(const ScenarioGroup<State>&) const { return actions_; }
  int default_action(const ScenarioGroup<State>&) const { return East; }
  double value_at_end(const State& state) const {
    return exit_value_[static_cast<std::size_t>(state.x)];
  }
  double default_value(const State& state) const { return value_at_end(state); }
  double upper_bound(const State& state, int) const {
    return known_[(cell(state.x, state.y) << rocks_.size()) + state.good];
  }

 private:
  std::size_t cell(int x, int y) const { return static_cast<std::size_t>(y * size_ + x); }

  int size_;
  std::vector<std::array<int, 2>> rocks_;
  std::vector<int> actions_;
  std::vector<int> rock_at_;        ///< by cell, -1: none
  std::vector<double> certainty_;   ///< by cell, then rock
  std::vector<double> exit_value_;  ///< of going east from column x
  std::vector<double> known_;       ///< value where the good rocks are known: by cell, then mask
};

inline RockSample::RockSample(int size, std::vector<std::array<int, 2>> rocks)
    : size_(size), rocks_(std::move(rocks)) {
  const std::size_t cells = static_cast<std::size_t>(size * size), count = rocks_.size();
  for (int action = 0; action < Check + this->rocks(); ++action) actions_.push_back(action);
  for (int x = 0; x < size; ++x) exit_value_.push_back(10 * std::pow(kDiscount, size - x - 1));
  rock_at_.assign(cells, -1);
  certainty_.resize(cells * count);
  std::vector<int> distance(cells * count);
  for (std::size_t rock = 0; rock < count; ++rock) {
    const auto [rx, ry] = rocks_[rock];
    rock_at_[cell(rx, ry)] = static_cast<int>(rock);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        certainty_[cell(x, y) * count + rock] =
            0.5 * (1 + std::pow(2.0, -std::hypot(x - rx, y - ry) / 20));
        distance[cell(x, y) * count + rock] = std::abs(x - rx) + std::abs(y - ry);
      }
  }
  // checks are worth nothing then, and bad rocks are left alone: so it is the best order of rocks
  known_.resize(cells << count);
  for (std::uint32_t mask = 0; mask < 1u << count; ++mask)
    for (std::size_t c = 0; c < cells; ++c) {
      double best = exit_value_[c % static_cast<std::size_t>(size)];
      for (std::uint32_t left = mask; left != 0; left &= left - 1) {
        const std::size_t rock = static_cast<std::size_t>(std::countr_zero(left));
        const std::size_t there = cell(rocks_[rock][0], rocks_[rock][1]);
        const double after = known_[(there << count) + (mask & ~(1u << rock))];
        best = std::max(best,
                        std::pow(kDiscount, distance[c * count + rock]) * (10 + kDiscount * after));
      }
      known_[(c << count) + mask] = best;
    }
}

inline StepOutcome RockSample::step(State& state, int action, double draw) const {
  if (action >= Check) {
    const int rock = action - Check;
    const bool good = (state.good >> rock & 1) != 0;
    return {0, (draw < certainty(state, rock)) == good ? 2U : 1U, false};
  }
  if (action == Sample) {
    const int rock = rock_at(state);
    if (rock < 0) return {-100, 0, true};
    const bool good = (state.good >> rock & 1) != 0;
    state.good &= ~(1u << rock);
    return {good ? 10.0 : -10.0, 0, false};
  }
  const int x = state.x + (action == East) - (action == West);
  const int y = state.y + (action == North) - (action == South);
  if (x >= size_) return {10, 0, true};
  if (x < 0 || y < 0 || y >= size_) return {-100, 0, true};
  state.x = static_cast<std::int16_t>(x);
  state.y = static_cast<std::int16_t>(y);
  return {0, 0, false};
}

/// A robot hunts somebody in a hall whom it sees only where they meet.
class Tag {
 public:
  struct State {
    std::int8_t robot = 0, target = 0;  ///< cells
  };
  enum Action { North, East, South, West, Catch };
  static constexpr std::array<int, 5> kActions = {North, East, South, West, Catch};
  static constexpr int kCells = 29;
  static constexpr std::uint64_t kSame = kCells;

  Tag();

  StepOutcome step(State& state, int action, double draw) const;
  /// Where the target may be after a step, with probabilities: the robot was at `robot` before it.
  std::array<std::pair<int, double>, 5> flights(int robot, int target) const;
  int neighbour(int cell, int direction) const {
    return neighbour_[static_cast<std::size_t>(cell)][static_cast<std::size_t>(direction)];
  }
  std::span<const int> actions(const ScenarioGroup<State>&) const { return kActions; }
  int default_action(const ScenarioGroup<State>& group);
  double value_at_end(const State&) const { return -1 / (1 - kDiscount); }
  double upper_bound(const State& state, int) const { return shortest_[index(state)]; }
  static std::size_t index(const State& state) {
    return static_cast<std::size_t>(state.robot * kCells + state.target);
  }
  static std::uint64_t observation(const State& state) {
    return state.robot == state.target ? kSame : static_cast<std::uint64_t>(state.robot);
  }

 private:
  static std::array<int, 2> place(int cell) {
    return cell < 20 ? std::array{cell % 10, 3 + cell / 10}
                     : std::array{5 + (cell - 20) % 3, (cell - 20) / 3};
  }
  static int cell_at(int x, int y) {
    if (y >= 3 && y <= 4 && x >= 0 && x < 10) return (y - 3) * 10 + x;
    if (y >= 0 && y < 3 && x >= 5 && x <= 7) return 20 + y * 3 + x - 5;
    return -1;
  }
  void solve_known();
  void measure_ways();

  std::array<std::array<int, 4>, kCells> neighbour_{};
  std::vector<std::array<std::pair<int, double>, 5>> flights_;
  std::vector<int> best_;         ///< action where the target is seen, by state
  std::vector<double> shortest_;  ///< of going to where the target is, by state
  std::vector<double> share_ = std::vector<double>(kCells * kCells);  ///< scratch
};

inline Tag::Tag() {
  for (int cell = 0; cell < kCells; ++cell) {
    const auto [x, y] = place(cell);
    const int ways[] = {cell_at(x, y + 1), cell_at(x + 1, y), cell_at(x, y - 1), cell_at(x - 1, y)};
    for (std::size_t d = 0; d < 4; ++d)
      neighbour_[static_cast<std::size_t>(cell)][d] = ways[d] < 0 ? cell : ways[d];
  }
  for (int robot = 0; robot < kCells; ++robot)
    for (int target = 0; target < kCells; ++target) {
      const auto [rx, ry] = place(robot);
      const auto [tx, ty] = place(target);
      const auto go = [&](int direction) { return neighbour(target, direction); };
      flights_.push_back({{{go(East), tx > rx    ? 0.4
                                      : tx == rx ? 0.2
                                                 : 0.0},
                           {go(West), tx < rx    ? 0.4
                                      : tx == rx ? 0.2
                                                 : 0.0},
                           {go(North), ty > ry    ? 0.4
                                       : ty == ry ? 0.2
                                                  : 0.0},
                           {go(South), ty < ry    ? 0.4
                                       : ty == ry ? 0.2
                                                  : 0.0},
                           {target, 0.2}}});
    }
  solve_known();
  measure_ways();
}

inline std::array<std::pair<int, double>, 5> Tag::flights(int robot, int target) const {
  return flights_[static_cast<std::size_t>(robot * kCells + target)];
}

inline StepOutcome Tag::step(State& state, int action, double draw) const {
  double reward = -1;
  if (action == Catch) {
    if (state.robot == state.target) return {10, kSame, true};
    reward = -10;
  }
  for (const auto& [cell, probability] : flights_[index(state)]) {
    if (draw < probability) {
      state.target = static_cast<std::int8_t>(cell);
      break;
    }
    draw -= probability;
  }
  if (action != Catch) state.robot = static_cast<std::int8_t>(neighbour(state.robot, action));
  return {reward, observation(state), false};
}

/// Value iteration over states that are seen.
inline void Tag::solve_known() {
  std::vector<double> value(kCells * kCells, 0.0), next = value;
  best_.assign(value.size(), Catch);
  for (int sweep = 0; sweep < 400; ++sweep) {
    for (int robot = 0; robot < kCells; ++robot)
      for (int target = 0; target < kCells; ++target) {
        const std::size_t here = static_cast<std::size_t>(robot * kCells + target);
        double most = robot == target ? 10 : -1e9;
        int best = Catch;
        for (int direction = 0; direction < 4; ++direction) {
          double mean = 0;
          for (const auto& [cell, probability] : flights_[here])
            mean += probability *
                    value[static_cast<std::size_t>(neighbour(robot, direction) * kCells + cell)];
          if (-1 + kDiscount * mean > most) most = -1 + kDiscount * mean, best = direction;
        }
        next[here] = most;
        best_[here] = best;
      }
    value.swap(next);
  }
}

inline void Tag::measure_ways() {
  shortest_.assign(kCells * kCells, 0.0);
  for (int robot = 0; robot < kCells; ++robot) {
    std::array<int, kCells> distance;
    distance.fill(-1);
    std::vector<int> front = {robot};
    distance[static_cast<std::size_t>(robot)] = 0;
    for (std::size_t i = 0; i < front.size(); ++i)
      for (int direction = 0; direction < 4; ++direction) {
        int& there = distance[static_cast<std::size_t>(neighbour(front[i], direction))];
        if (there >= 0) continue;
        there = distance[static_cast<std::size_t>(front[i])] + 1;
        front.push_back(neighbour(front[i], direction));
      }
    for (int target = 0; target < kCells; ++target) {
      const int steps = distance[static_cast<std::size_t>(target)];
      shortest_[static_cast<std::size_t>(robot * kCells + target)] =
          cost_of(steps) + 10 * std::pow(kDiscount, steps);
    }
  }
}

/// As if the likeliest state were known.
inline int Tag::default_action(const ScenarioGroup<State>& group) {
  std::size_t mode = index(group.state(0));
  for (std::size_t i = 0; i < group.size(); ++i) share_[index(group.state(i))] = 0;
  for (std::size_t i = 0; i < group.size(); ++i) {
    const std::size_t here = index(group.state(i));
    share_[here] += group.weight(i);
    if (share_[here] > share_[mode]) mode = here;
  }
  return best_[mode];
}

}  // namespace sumogamma::testing
