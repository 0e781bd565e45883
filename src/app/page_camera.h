#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/piped_process.h"
#include "base/scratch_folder.h"

namespace sumogamma {

/// Looks at a replay page through a headless Chromium, which is talked to by a pipe: nothing
/// listens at a port.
class PageCamera {
 public:
  struct Shot {
    int width = 1280, height = 720;  ///< [px]
    std::string view;                ///< the page's link to a view, "follow=car.3&theme=dark"
  };

  /// Opens the page and waits until it has read its recording. Throws Error naming Debian's package
  /// where there is no Chromium, and the page where that holds nothing to show.
  PageCamera(const std::filesystem::path& page, const Shot& shot);

  double begin() const { return begin_; }  ///< of the recording [s]
  double end() const { return end_; }
  /// The page at an instant [s], as "png" or "jpeg".
  std::string picture(double time, const std::string& format);

 private:
  nlohmann::json ask(const std::string& method, const nlohmann::json& parameters);
  nlohmann::json evaluate(const std::string& expression);
  void open(const std::filesystem::path& page, const Shot& shot);

  ScratchFolder scratch_;
  std::unique_ptr<PipedProcess> browser_;
  std::string session_;
  int asked_ = 0;
  double begin_ = 0, end_ = 0;
};

/// Full path of a program that makes pictures or videos. Throws Error naming Debian's `package`
/// where none of these names is found.
std::filesystem::path require_program(std::initializer_list<const char*> names,
                                      const std::string& package, const std::string& purpose);

}  // namespace sumogamma
