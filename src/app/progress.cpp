#include "app/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace sumogamma {

using Clock = std::chrono::steady_clock;

Progress::Progress(std::string what, double total, std::string unit, bool quiet)
    : what_(std::move(what)),
      unit_(std::move(unit)),
      total_(total),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      next_(Clock::now()) {}

Progress::~Progress() {
  if (line_open_) std::fputc('\n', stderr);
}

bool Progress::due() const { return !quiet_ && Clock::now() >= next_; }

void Progress::update(double done, const std::string& detail) {
  if (!due()) return;
  next_ =
      Clock::now() + (terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(5000));
  const double share = total_ > 0.0 ? std::clamp(done / total_, 0.0, 1.0) : 0.0;
  if (terminal_) {
    constexpr int kWidth = 24;
    const int filled = static_cast<int>(share * kWidth);
    std::fprintf(stderr, "\r\033[K%s [%s%s] %3.0f %%  %s", what_.c_str(),
                 std::string(static_cast<std::size_t>(filled), '#').c_str(),
                 std::string(static_cast<std::size_t>(kWidth - filled), '.').c_str(), 100.0 * share,
                 detail.c_str());
    line_open_ = true;
  } else {
    std::fprintf(stderr, "%s: %.0f of %.0f %s, %s\n", what_.c_str(), done, total_, unit_.c_str(),
                 detail.c_str());
  }
  std::fflush(stderr);
}

}  // namespace sumogamma
