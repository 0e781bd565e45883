#pragma once

#include <chrono>
#include <string>

namespace sumogamma {

/// Progress on stderr: a bar where it is a terminal, a line every few seconds where it isn't,
/// nothing when quiet.
class Progress {
 public:
  /// `what`: first word of every line. `total`: where `done` will end, in `unit`.
  Progress(std::string what, double total, std::string unit, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows how far it is, if it is time to: cheap to call every tick.
  void update(double done, const std::string& detail);
  /// True where update would print now: spares composing the detail.
  bool due() const;

 private:
  std::string what_, unit_;
  double total_;
  bool quiet_, terminal_;
  bool line_open_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace sumogamma
