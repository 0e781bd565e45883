#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "ego/paired_tests.h"

namespace sumogamma {

/// A figure of drives side by side.
struct DriveFigure {
  std::string key, unit, what;
  std::vector<IntervalEstimate> of;  ///< by drive
  std::vector<IntervalEstimate>
      difference;         ///< of each drive but the first from that, over paired seeds
  std::vector<double> p;  ///< likewise, adjusted after Holm over the three main figures
};

/// Drives side by side, on the seeds that all have done and on which none was locked up.
struct DriveReport {
  std::vector<std::string> names;
  std::size_t seeds = 0, left_out = 0;
  std::vector<DriveFigure> figures;  ///< the first three: contacts, time to the goal, acceleration
};

/// Is a folder that of a drive?
bool is_drive(const std::filesystem::path& folder);

/// Throws Error naming the folder where it is none, or where no seed is common to all.
DriveReport compare_drives(std::span<const std::filesystem::path> folders);

std::string drive_report_markdown(const DriveReport& report);
/// One page that needs no other file: the three panels with intervals, and the table.
std::string drive_report_html(const DriveReport& report);

}  // namespace sumogamma
