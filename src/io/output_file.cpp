#include "io/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>
#include <system_error>

#include "base/error.h"

namespace sumogamma {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* what, int error) {
  throw Error(file.string(), std::string(what) + " (" + std::strerror(error) + ")");
}

void write_through(const std::filesystem::path& shown, const std::filesystem::path& file,
                   std::string_view content) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) fail(shown, "can't be written", errno);
  while (!content.empty()) {
    const ssize_t written = write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error = errno;
      close(descriptor);
      fail(shown, "can't be written to its end", error);
    }
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  if (close(descriptor) != 0) fail(shown, "can't be written to its end", errno);
}

}  // namespace

void write_file(const std::filesystem::path& file, std::string_view content) {
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored)) {
    write_through(file, file, content);
    return;
  }
  std::filesystem::path temporary = file;
  temporary += ".part";
  try {
    write_through(file, temporary, content);
  } catch (const Error&) {
    std::filesystem::remove(temporary, ignored);
    throw;
  }
  if (std::rename(temporary.c_str(), file.c_str()) != 0) {
    const int error = errno;
    std::filesystem::remove(temporary, ignored);
    fail(file, "can't be replaced", error);
  }
}

std::string read_file(const std::filesystem::path& file) {
  std::FILE* stream = std::fopen(file.c_str(), "rb");
  if (!stream) fail(file, "can't be read", errno);
  std::string content;
  char chunk[1 << 16];
  std::size_t count = 0;
  while ((count = std::fread(chunk, 1, sizeof chunk, stream)) > 0) content.append(chunk, count);
  const bool failed = std::ferror(stream) != 0;
  const int error = errno;
  std::fclose(stream);
  if (failed) fail(file, "can't be read", error);
  return content;
}

void make_output_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw Error(folder.string(),
                "can't be made (" + error.message() + "), choose another output folder");
  if (!std::filesystem::is_directory(folder))
    throw Error(folder.string(), "isn't a folder, choose another output");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(folder.string(), "isn't writable (" + std::string(std::strerror(errno)) +
                                     "), choose another folder");
}

}  // namespace sumogamma
