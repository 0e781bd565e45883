#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "sumo/sumo_options.h"

namespace sumogamma {

/// Attributes of an element by name.
using XmlAttributes = std::map<std::string, std::string, std::less<>>;

/// An output of SUMO's that a scenario asks for and that sumo-gamma writes.
struct AskedOutput {
  std::string what;          ///< option ("tripinfo-output") or element ("e1Detector")
  XmlAttributes attributes;  ///< of an element
  std::vector<std::pair<std::string, XmlAttributes>> parts;  ///< <detEntry> and <detExit> of one
  std::filesystem::path file;  ///< as SUMO names it, without any output-prefix
  std::string source;          ///< the file that asks for it, or "--sumo-options"
};

/// The value of an attribute, `otherwise` where there is none.
std::string_view attribute_or(const XmlAttributes& attributes, std::string_view name,
                              std::string_view otherwise = {});

/// Is an output among these?
bool asks_for(const std::vector<AskedOutput>& outputs, std::string_view what);

/// Does a name of an output lead nowhere (NUL, /dev/null, nothing)?
bool is_null_output(std::string_view name);

/// Is it no file but a stream or a socket (stdout, stderr, -, HOST:PORT)?
bool is_stream_output(std::string_view name);

/// The file that SUMO means by a name in another file (FileHelpers::checkForRelativity).
std::filesystem::path output_file(std::string_view name, const std::filesystem::path& source);

/// While GAMMA drives, SUMO's own files go to hidden names beside the ones that were asked for, so
/// that a file of such a name is whole and right, or isn't there. SUMO's option output-prefix does
/// it.
struct OutputNames {
  std::string marker;  ///< before the names of SUMO's own files, ".sumo-gamma-4711-"
  std::string prefix;  ///< what the user gives as output-prefix, TIME replaced by the present time

  /// What SUMO is told.
  std::string sumo_prefix() const { return marker + prefix; }
  /// Where SUMO writes a file, and what it is to be called.
  std::filesystem::path hidden(const std::filesystem::path& file) const;
  std::filesystem::path shown(const std::filesystem::path& file) const;
};

/// Names of this process for the run of these options.
OutputNames output_names(const SumoOptions& options);

/// Gives all files of `names` in `folders` the names that they were meant to have, but for those in
/// `written`, which are deleted: they have been written anew. Throws Error naming the file.
void show_outputs(const OutputNames& names, const std::vector<std::filesystem::path>& folders,
                  const std::vector<std::filesystem::path>& written);

/// Deletes the hidden files of `names` in `folders`: the run has come to nothing.
void drop_outputs(const OutputNames& names, const std::vector<std::filesystem::path>& folders);

}  // namespace sumogamma
