#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/subprocess.h"

namespace sumogamma::testing {

/// Chromium that prints a page's document as it has it after its scripts ran; `options` and the
/// page's address come behind. `profile`: a folder of its own.
inline std::vector<std::string> headless_chromium(const std::filesystem::path& profile,
                                                  const std::vector<std::string>& options) {
  std::vector<std::string> words = {find_program("chromium").string(),
                                    "--headless",
                                    "--no-sandbox",
                                    "--disable-gpu",
                                    "--no-first-run",
                                    "--disable-background-networking",
                                    "--disable-component-update",
                                    "--disable-sync",
                                    "--user-data-dir=" + profile.string(),
                                    "--enable-logging=stderr",
                                    "--dump-dom"};
  words.insert(words.end(), options.begin(), options.end());
  return words;
}

}  // namespace sumogamma::testing
