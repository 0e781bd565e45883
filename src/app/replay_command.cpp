#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/command.h"
#include "base/error.h"
#include "base/print.h"
#include "io/output_folder.h"
#include "io/replay.h"

namespace sumogamma {

CommandRunner add_replay_command(CLI::App& parent) {
  CLI::App* command =
      parent.add_subcommand("replay", "make the replay page of a run again from what it recorded");
  struct Options {
    std::vector<std::string> folders;
    std::string output;
  };
  auto options = std::make_shared<Options>();
  command->add_option("DIR", options->folders, "output folder of `run --replay`")->required();
  command->add_option("-o,--output", options->output,
                      "where to write the page (one DIR alone; default DIR/replay.html)");
  return [options](const CommonOptions& common) {
    if (!options->output.empty() && options->folders.size() > 1)
      throw Error("--output", "one page for several folders, leave it out or name one folder");
    for (const std::filesystem::path folder : options->folders) {
      const std::filesystem::path page =
          options->output.empty() ? folder / "replay.html" : std::filesystem::path(options->output);
      if (!std::filesystem::exists(folder / "replay.bin"))
        throw Error(folder.string(),
                    "holds no replay.bin, expected the output folder of `sumo-gamma run --replay`");
      require_page_name(page);
      write_replay_page(page, folder / "replay.bin");
      if (!common.quiet) print(stdout, "{}\n", page.string());
    }
    return kExitDone;
  };
}

}  // namespace sumogamma
