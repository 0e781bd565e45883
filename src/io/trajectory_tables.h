#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/trajectory_rows.h"

namespace sumogamma {

/// Columns that a table of trajectories may have, all of them in their order: time, id, type, x, y,
/// angle, speed, place (a vehicle's lane, a person's edge), pos, slope.
std::vector<std::string> trajectory_columns();

/// Vehicles and persons as tables of their own, in chosen columns: FOLDER/vehicles.csv.gz and
/// persons.csv.gz, with the decimals of SUMO's FCD output. A row an agent and step, in order of
/// steps. Whole also where a run was interrupted, and readable up to its last seconds where it was
/// killed. Throws Error naming a file that can't be written.
std::unique_ptr<TrajectorySink> make_csv_tables(const std::filesystem::path& folder,
                                                std::vector<std::string> columns);

/// Likewise FOLDER/vehicles.parquet and persons.parquet: numbers as they are, time as double, the
/// rest as float, texts as UTF-8, groups of 50,000 rows. There once they are whole.
std::unique_ptr<TrajectorySink> make_parquet_tables(const std::filesystem::path& folder,
                                                    std::vector<std::string> columns);

/// Hands steps to other sinks from a thread of its own. No more than `most` steps wait; then add()
/// does. What a sink throws is thrown by the next add() or by close().
std::unique_ptr<TrajectorySink> make_threaded(std::vector<std::unique_ptr<TrajectorySink>> sinks,
                                              std::size_t most = 64);

}  // namespace sumogamma
