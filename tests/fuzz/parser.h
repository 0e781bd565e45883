#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "base/error.h"

namespace sumogamma::fuzz {

/// The bytes as a file of which nothing reaches a disk.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : fd_(memfd_create("fuzz", 0)) {
    if (fd_ < 0 || write(fd_, data, size) != static_cast<ssize_t>(size)) std::abort();
  }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

/// Whatever comes in, a parser either reads it or says in one line what is wrong.
template <typename Parse>
int read_or_say_why(Parse&& parse) {
  try {
    parse();
  } catch (const Error& error) {
    const std::string what = error.what();
    if (what.empty() || what.find('\n') != std::string::npos) std::abort();
  }
  return 0;
}

}  // namespace sumogamma::fuzz
