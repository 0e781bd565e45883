#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/spawn.h"

namespace sumogamma {

/// A program that runs beside this one and is talked to through pipes. Not started by a shell; what
/// it prints goes to a file. It ends with this object at the latest.
class PipedProcess {
 public:
  struct Request {
    std::vector<std::string> arguments;  ///< [0] is the program, looked up in PATH
    int input = 0;                       ///< its descriptor that reads what we write
    int output = -1;                     ///< its descriptor whose bytes we read, -1: none
    std::filesystem::path log;           ///< of both its streams, begun anew
    double patience = 60;                ///< with a program that neither reads nor writes [s]
  };

  /// Throws Error naming the program where it can't be started.
  explicit PipedProcess(Request request);
  ~PipedProcess();
  PipedProcess(const PipedProcess&) = delete;
  PipedProcess& operator=(const PipedProcess&) = delete;

  /// Throws Error naming the program, with the end of its log, where it doesn't take all of them.
  void write(std::string_view bytes);
  /// The bytes up to the next `end`, which is left out. Throws Error as write does.
  std::string read_until(char end);
  /// Tells it that nothing more will come and waits for its end. Returns its exit code, -1 where a
  /// signal ended it. Throws Error where it goes on.
  int finish();

 private:
  [[noreturn]] void fail(const std::string& what) const;
  bool wait_for_end(double seconds);
  void close_pipes();

  Request request_;
  pid_t pid_ = -1;
  Pipe to_, from_;
  int status_ = 0;
  bool ended_ = false;
  std::string unread_;
};

}  // namespace sumogamma
