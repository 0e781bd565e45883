#include "sumo_gamma/program.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "app/program.h"

namespace sumogamma {

namespace {

/// A stream into memory.
class Captured {
 public:
  Captured() : stream_(open_memstream(&text_, &size_)) {
    if (stream_ == nullptr) throw Error("output", "no memory for it");
  }
  ~Captured() {
    if (stream_ != nullptr) std::fclose(stream_);
    std::free(text_);  // NOLINT(cppcoreguidelines-no-malloc): open_memstream's
  }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;

  std::FILE* stream() { return stream_; }
  std::string text() {
    std::fflush(stream_);
    return {text_, size_};
  }

 private:
  char* text_ = nullptr;
  std::size_t size_ = 0;
  std::FILE* stream_;
};

}  // namespace

CommandResult run_command(const std::vector<std::string>& words) {
  static std::atomic_flag running = ATOMIC_FLAG_INIT;
  if (running.test_and_set())
    throw Error("run_command", "another command runs in this process, wait for it");
  const std::unique_ptr<std::atomic_flag, void (*)(std::atomic_flag*)> done(
      &running, [](std::atomic_flag* flag) { flag->clear(); });
  set_interrupted(false);
  Captured captured;
  CommandResult result;
  try {
    result.exit_code = run_program(words, captured.stream());
  } catch (const UsageError& error) {
    throw Error("sumo-gamma", error.what());
  }
  result.output = captured.text();
  return result;
}

void interrupt_command() { set_interrupted(true); }

std::string version() { return SUMOGAMMA_VERSION; }

}  // namespace sumogamma
