#include "app/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "base/print.h"

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
    print(stderr, "\r\033[K{} [{:#<{}}{:.<{}}] {:3.0f} %  {}", what_, "", filled, "",
          kWidth - filled, 100.0 * share, detail);
    line_open_ = true;
  } else {
    print(stderr, "{}: {:.0f} of {:.0f} {}, {}\n", what_, done, total_, unit_, detail);
  }
  std::fflush(stderr);
}

}  // namespace sumogamma
