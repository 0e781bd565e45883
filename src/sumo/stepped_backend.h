#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sumo/backend.h"
#include "sumo/ghost.h"
#include "sumo/watch_list.h"

namespace sumogamma {

/// What the back ends have in common: the order of a step, the start-up self-test in it, and who is
/// watched. How to talk to SUMO is left to them.
class SteppedBackend : public SumoBackend {
 public:
  explicit SteppedBackend(const SumoStart& start);
  const std::vector<std::string>& signal_ids() const final { return signal_ids_; }
  const std::vector<Detector>& detectors() const final { return detectors_; }
  double time() const final { return time_; }
  double next_switch(std::size_t signal) final;
  void send(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons) final;
  void receive(SumoStep& result) final;
  void watch(const std::string& id, bool is_person) final {
    if (watched_.add(id, is_person)) watch_changed_ = true;
  }
  void unwatch(const std::string& id, bool is_person) final {
    if (watched_.drop(id, is_person)) watch_changed_ = true;
  }

 protected:
  /// Runs `talk` where SUMO is there to talk to; failures come out as SumoError, or Error for what
  /// the user gave.
  virtual void talk_to_sumo(const std::function<void()>& talk) = 0;
  /// Moves the ghosts before another client makes the step; nothing where we make it. Whom SUMO
  /// refuses is added to `lost`.
  virtual void move_ahead(std::span<const SumoPose>, std::span<const SumoPose>,
                          std::vector<std::string>&) {}
  /// Moves the ghosts as mode() says, makes the step and reads what happened into `result`, whose
  /// lists are empty. Whom SUMO refuses is in result.lost.
  virtual void move_and_step(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons,
                             SumoStep& result) = 0;
  virtual std::vector<std::string> route_of(const std::string& vehicle) = 0;
  /// Infinite where SUMO can't tell [s].
  virtual double ask_next_switch(std::size_t signal) = 0;
  /// Nothing where it has left.
  virtual std::optional<GhostObservation> observe(const std::string& id, bool is_person) = 0;
  /// Reads the entries of the watch list into `agents`, in order; those whom SUMO doesn't know any
  /// more into `gone` instead.
  virtual void read_watched(const std::vector<WatchList::Entry>& entries,
                            std::vector<SumoAgent>& agents,
                            std::vector<WatchList::Entry>& gone) = 0;

  /// Does the step that comes ask for a signal? SUMO runs the events of its programs that are due
  /// when a step begins.
  bool is_due(std::size_t signal) const {
    return !by_schedule_ || next_switch_[signal] <= time_ + 1e-6;
  }

  GhostMode mode(bool is_person) const { return (is_person ? person_test_ : vehicle_test_).mode(); }

  bool started_ = false;  ///< a step was made: what fails from now on isn't the user's input
  double time_ = 0;       ///< [s]
  std::vector<std::string> signal_ids_;
  bool by_schedule_;                 ///< see SumoStart
  std::vector<double> next_switch_;  ///< of each signal where so, as last told [s]
  std::vector<Detector> detectors_;
  std::vector<std::string> warnings_;  ///< of our own
  bool watch_changed_ = false;         ///< since the back end last put it back to false

 private:
  void finish_test(GhostSelfTest& test, bool is_person, std::span<const SumoPose> poses,
                   const SumoStep& result, const std::vector<std::string>& route);

  WatchList watched_;
  std::span<const SumoPose> sent_vehicles_, sent_persons_;  ///< of the last send()
  std::vector<std::string> sent_route_;  ///< of its first vehicle, while that is tested
  std::vector<std::string> lost_ahead_;
  GhostSelfTest vehicle_test_{false}, person_test_{true};
};

}  // namespace sumogamma
